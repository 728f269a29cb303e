// What a vacuum grip can carry, at full vacuum (limits scale with p(t) / p_inf).
#pragma once

namespace binpick {

struct HoldLimits {
  double pull = 0;     ///< N, along +z_G (away from the part): dp * A_eff
  double shear = 0;    ///< N, in the lip plane at zero external pull: mu * dp * A_eff
  double moment = 0;   ///< N m, about an axis in the lip plane: peel, dp * A_eff * r
  double torsion = 0;  ///< N m, about z_G: mu * dp * A_eff * r
};

/// At a share of the full vacuum.
inline HoldLimits scaled(const HoldLimits& full, double share) {
  return {full.pull * share, full.shear * share, full.moment * share, full.torsion * share};
}

}  // namespace binpick

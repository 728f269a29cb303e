// The cups of a tool in the physics world, and what holds a part to them.
//
// Frame U of a cup: lip centre, +z leaves the tool (CupSpec). A free lip is a small dynamic body on a spring plunger:
// it slides along z_U between 0 (fully out) and -stroke, pressed out by preload + stiffness x compression, and touches
// parts like any other body. Where a surface seals is not decided here but by Gripper::judge. A sealed cup couples tool
// and part at the pose they have at that moment (no snapping): along z_U the plunger with its spring and stops (of
// four cups or more, whose shares of the load statics leaves open, the stops give as the lips do), in the lip plane and
// in rotation the stiffness of the lip. The lip then rides on the
// part. The reaction of the coupling is read every step about the lip centre and held against the limits of
// physical_models B1, scaled by p(t) / p_inf = 1 - exp(-t / tau). With V = pull limit x share, W = pull, N = V - W the
// force that keeps the lip on the part:
//     W <= V,   shear <= mu N,   moment <= r N (peel),   torsion <= mu r N
// mu, r and mu r being the ratios of the HoldLimits to their pull. A violation that lasts `break_time` breaks the cup;
// below `grip_share` of the vacuum only W <= V counts.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/cup.hpp"
#include "sim/world.hpp"

namespace binpick {

enum class HoldLimit { kPull, kShear, kMoment, kTorsion };

struct HoldConfig {
  /// Share of the vacuum below which a lip may still shift and tilt into place: until then only a pull-off breaks it.
  double grip_share = 0.5;
  double break_time = 0.010;       ///< s a limit must be exceeded
  double lip_mass = 0.03;          ///< kg, the moving part of the plunger; weightless, as it hangs on the tool
  double lateral_stiffness = 2e3;  ///< N/m, of a sealed lip in its plane: rubber, softer than its rim is stiff
  double damping_ratio = 0.7;      ///< of the lip's springs
};

/// What a cup does, after the last step.
struct CupState {
  std::optional<BodyId> part;          ///< what it holds
  double vacuum_share = 0;             ///< p(t) / p_inf
  double compression = 0;              ///< m, plunger travel from fully out
  double press = 0;                    ///< N, a free lip's contact force
  double pull = 0;                     ///< N, along -z_U; negative while the plunger presses
  double shear = 0;                    ///< N
  double moment = 0;                   ///< N m, about an axis in the lip plane, at the lip centre
  double torsion = 0;                  ///< N m
  double use = 0;                      ///< largest of load / limit at the present vacuum; above 1 the hold is breaking
  std::optional<HoldLimit> broken_by;  ///< why the last hold of this cup ended; empty while it holds or was released
};

class CupHold {
 public:
  /// `tool` is a moved body whose frame is G.
  CupHold(World& world, BodyId tool, std::span<const CupSpec> cups, const HoldConfig& config);
  ~CupHold();
  CupHold(CupHold&&) noexcept;

  const std::vector<BodyId>& lips() const;
  const std::vector<CupState>& cups() const;
  Pose X_WU(std::size_t cup) const;  ///< where the lip is now

  /// Couples the cup to the part at their present poses; its vacuum starts to build up, to `vacuum` of the full one (a
  /// leaking lip).
  void attach(std::size_t cup, BodyId part, double vacuum = 1);
  void release_all();
  /// The lips go to where the tool is, fully out (after the tool was teleported).
  void reset_lips();
  bool holds_any() const;
  void set_config(const HoldConfig& config);  ///< for holds that begin later; the lips' mass stays

  /// One step of the world with the cups at work.
  void step(double dt);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace binpick

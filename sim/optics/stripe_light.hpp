// The light of phase-shifted stripes in one camera. A stripe image is linear in a few basis images: with the beam's
// radiance L and the phase p_f of frequency f at each pixel, the shift s gives
//   I = ambient + L (1 + m cos(p_f + s)) / 2,  and  L cos(p_f + s) = (L cos p_f) cos s - (L sin p_f) sin s.
// So the scene is shaded once for all shifts, and blur and interreflection act on the basis.
#pragma once

#include <array>

#include "core/image.hpp"
#include "sim/optics/phase_shift.hpp"
#include "sim/optics/projector_light.hpp"

namespace binpick {

struct StripeBasis {
  static constexpr int kChannels = 1 + 2 * PhaseShift::kFrequencies;

  Image<float> ambient;                          ///< per unit of ambient irradiance
  std::array<Image<float>, kChannels> channels;  ///< L, then L cos p_f and L sin p_f of every frequency

  double beam(std::size_t pixel) const { return channels[0][pixel]; }
  /// L cos(p_f + shift)
  double wave(int frequency, const PhaseShift::Shift& shift, std::size_t pixel) const {
    const auto c = static_cast<std::size_t>(1 + 2 * frequency);
    return channels[c][pixel] * shift.cosine - channels[c + 1][pixel] * shift.sine;
  }
};

/// `device` is the projector as ProjectorLight knows it.
StripeBasis shade_stripes(const ImagerView& imager, const ProjectorLight& light, const PinholeCamera& device,
                          const PhaseShift& stripes, int threads);

/// Adds light that reaches a pixel by way of one other surface. A coarse gather: patches of 16 x 16 pixels that the
/// camera sees send out their mean light evenly into their half space; nothing blocks it on its way, lobes are left
/// out, and surfaces that the camera does not see send nothing. Fine stripes average out over a patch, coarse ones do
/// not: concave corners keep their fine phase and lose modulation, or fall into a wrong period.
void add_interreflection(const ImagerView& imager, int threads, StripeBasis& basis);

}  // namespace binpick

// The stripe images of one pixel, shot and decoded: photon noise, read noise, speckle of the light, saturation and
// digitising of every shot; then the phases, and from them the position on the pattern.
#pragma once

#include <vector>

#include "core/random.hpp"
#include "sim/optics/phase_shift.hpp"
#include "sim/optics/stripe_light.hpp"

namespace binpick {

struct StripeShots {
  static constexpr double kExposureRatio = 4;

  double contrast = 0.9;     ///< modulation of the projected cosines
  double ambient = 0.1;      ///< irradiance; white light of the projector has 1 at 1 m
  int exposures = 3;         ///< tried one after the other, each shorter by kExposureRatio, while the pixel saturates
  double full_well = 52000;  ///< electrons
  double read_noise = 10;    ///< electrons
  int bits = 12;             ///< of the digitiser
  double speckle = 0;        ///< share of the light, new in every shot
  double modulation = 0.01;  ///< least amplitude, share of the well

  double variance(double electrons) const;  ///< of one shot
  double digitised(double electrons) const;
};

class StripeDecoder {
 public:
  /// `gain`: electrons per unit of radiance in the longest exposure. `basis` must outlive the decoder.
  StripeDecoder(const StripeBasis& basis, const PhaseShift& stripes, const StripeShots& shots, double gain)
      : basis_(basis), stripes_(stripes), shifts_(stripes.shifts()), shots_(shots), gain_(gain) {}
  /// Tangent of the column's angle in D; NaN where every exposure saturates, or where the light hardly varies.
  double position(std::size_t pixel, Rng noise) const;

 private:
  struct Decoded;
  Decoded shoot(std::size_t pixel, double gain, Rng& noise) const;

  const StripeBasis& basis_;
  PhaseShift stripes_;
  std::vector<PhaseShift::Shift> shifts_;
  StripeShots shots_;
  double gain_;
};

}  // namespace binpick

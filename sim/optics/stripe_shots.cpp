#include "sim/optics/stripe_shots.hpp"

#include <algorithm>
#include <cmath>

namespace binpick {

double StripeShots::variance(double electrons) const {
  const double e = std::max(electrons, 0.0);
  return e + read_noise * read_noise + speckle * speckle * e * e;
}

double StripeShots::digitised(double electrons) const {
  const double step = full_well / (1 << bits);
  return std::max(std::round(electrons / step), 0.0) * step;
}

struct StripeDecoder::Decoded {
  bool saturated = false;
  double x = std::nan("");
};

StripeDecoder::Decoded StripeDecoder::shoot(std::size_t pixel, double gain, Rng& noise) const {
  const double beam = gain * basis_.beam(pixel), least = shots_.modulation * shots_.full_well;
  if (beam * shots_.contrast < least) return {};
  const double steady = gain * shots_.ambient * basis_.ambient[pixel] + 0.5 * beam;
  std::array<double, PhaseShift::kFrequencies> wrapped;
  for (int f = 0; f < PhaseShift::kFrequencies; ++f) {
    PhaseSums sums;
    for (const PhaseShift::Shift& shift : shifts_) {
      const double e = steady + 0.5 * shots_.contrast * gain * basis_.wave(f, shift, pixel);
      const double seen = e + std::sqrt(shots_.variance(e)) * noise.normal();
      if (seen >= shots_.full_well) return {true};
      sums.add(shots_.digitised(seen), shift);
    }
    if (sums.amplitude(stripes_.steps) < least) return {};
    wrapped[static_cast<std::size_t>(f)] = sums.phase();
  }
  return {false, stripes_.position(wrapped)};
}

double StripeDecoder::position(std::size_t pixel, Rng noise) const {
  double gain = gain_;
  for (int k = 0; k < shots_.exposures; ++k, gain /= StripeShots::kExposureRatio) {
    const Decoded decoded = shoot(pixel, gain, noise);
    if (!decoded.saturated) return decoded.x;
  }
  return std::nan("");
}

}  // namespace binpick

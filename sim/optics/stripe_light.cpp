#include "sim/optics/stripe_light.hpp"

#include <cmath>

#include "core/parallel.hpp"

namespace binpick {

StripeBasis shade_stripes(const ImagerView& imager, const ProjectorLight& light, const PinholeCamera& device,
                          const PhaseShift& stripes, int threads) {
  const int width = imager.camera.width, height = imager.camera.height;
  StripeBasis basis;
  basis.ambient = Image<float>(width, height);
  for (Image<float>& channel : basis.channels) channel = Image<float>(width, height);
  parallel_for(static_cast<std::size_t>(height), threads, [&](std::size_t row) {
    const int v = static_cast<int>(row);
    for (int u = 0; u < width; ++u) {
      const PixelLight seen = light.at(imager, u, v);
      basis.ambient(u, v) = static_cast<float>(seen.ambient);
      if (!(seen.beam > 0)) continue;
      const double x = (seen.pixel_D.x() - device.cx) / device.fx;
      if (std::abs(x) > stripes.half) continue;
      basis.channels[0](u, v) = static_cast<float>(seen.beam);
      for (int f = 0; f < PhaseShift::kFrequencies; ++f) {
        const double phase = stripes.phase(f, x);
        const auto c = static_cast<std::size_t>(1 + 2 * f);
        basis.channels[c](u, v) = static_cast<float>(seen.beam * std::cos(phase));
        basis.channels[c + 1](u, v) = static_cast<float>(seen.beam * std::sin(phase));
      }
    }
  });
  return basis;
}

}  // namespace binpick

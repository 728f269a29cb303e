#include "sim/noise/dropout.hpp"

#include <cmath>
#include <limits>

namespace binpick {
namespace {

void drop(DisparityImage& image, std::size_t i) {
  image.disparity[i] = std::numeric_limits<float>::quiet_NaN();
  image.source[i] = -1;
}

}  // namespace

void drop_returns(const StereoView& view, const Dropout& dropout, const Rng& rng, DisparityImage& image) {
  for (std::size_t i = 0; i < image.source.size(); ++i) {
    if (image.source[i] < 0) continue;
    const auto source = static_cast<std::size_t>(image.source[i]);
    const double cosine = view.cos_incidence(source);
    const double z = view.exact.depth[source];
    double light = view.exact.materials[view.exact.ids[source]].albedo * cosine / (z * z);
    if (dropout.lobe > 0) light += dropout.lobe * std::pow(cosine, dropout.lobe_exponent);
    const double beyond = (std::acos(cosine) - dropout.grazing_angle) / dropout.grazing_width;
    const bool certain = light < dropout.return_low || light > dropout.return_high;
    // Far from the critical angle the outcome needs no draw (the probability is below 1e-9).
    if (certain || beyond > 21 || (beyond > -21 && rng.at(i).uniform() < 1 / (1 + std::exp(-beyond)))) drop(image, i);
  }
}

void drop_speckles(double probability, const Rng& rng, DisparityImage& image) {
  if (!(probability > 0)) return;
  for (std::size_t i = 0; i < image.source.size(); ++i)
    if (image.source[i] >= 0 && rng.at(i).uniform() < probability) drop(image, i);
}

}  // namespace binpick

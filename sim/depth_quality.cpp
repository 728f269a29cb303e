#include "sim/depth_quality.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/check.hpp"

namespace binpick {
namespace {

constexpr std::size_t kFewest = 10;  // pixels
const double kNone = std::numeric_limits<double>::quiet_NaN();

// Calls use(u, v, z) for every valid pixel of the region.
template <class Use>
void for_valid(const Image<float>& depth, const ImageRegion& region, const Use& use) {
  BP_CHECK(region.u0 >= 0 && region.v0 >= 0 && region.u1 <= depth.width() && region.v1 <= depth.height());
  for (int v = region.v0; v < region.v1; ++v)
    for (int u = region.u0; u < region.u1; ++u)
      if (!std::isnan(depth(u, v))) use(u, v, static_cast<double>(depth(u, v)));
}

// The mean of two middle values when their number is even. Reorders.
double median_of(std::vector<double>& values) {
  if (values.empty()) return kNone;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

struct Mean {
  double sum = 0;
  std::size_t count = 0;
  void add(double x) { sum += x, ++count; }
  double value(std::size_t fewest = kFewest) const {
    return count >= fewest ? sum / static_cast<double>(count) : kNone;
  }
};

}  // namespace

ImageRegion centre_region(const PinholeCamera& camera, int width, int height) {
  const int w = std::min(width, camera.width), h = std::min(height, camera.height);
  const int u0 = (camera.width - w) / 2, v0 = (camera.height - h) / 2;
  return {u0, v0, u0 + w, v0 + h};
}

ImageRegion centre_region(const PinholeCamera& camera, double share) {
  return centre_region(camera, static_cast<int>(std::lround(share * camera.width)),
                       static_cast<int>(std::lround(share * camera.height)));
}

std::optional<WallPlane> fit_wall(const Image<float>& depth, const PinholeCamera& camera, const ImageRegion& region) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  std::size_t count = 0;
  for_valid(depth, region, [&](int u, int v, double z) { sum += camera.unproject(u, v, z), ++count; });
  if (count < kFewest) return std::nullopt;
  const Eigen::Vector3d centre = sum / static_cast<double>(count);
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for_valid(depth, region, [&](int u, int v, double z) {
    const Eigen::Vector3d r = camera.unproject(u, v, z) - centre;
    scatter += r * r.transpose();
  });
  const Eigen::Vector3d n = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors().col(0);
  const double sign = n.dot(centre) < 0 ? -1 : 1;
  return WallPlane{sign * n, sign * n.dot(centre)};
}

double plane_fit_rms(const Image<float>& depth, const PinholeCamera& camera, const ImageRegion& region) {
  const auto plane = fit_wall(depth, camera, region);
  if (!plane) return kNone;
  Mean squares;
  for_valid(depth, region, [&](int u, int v, double z) {
    const double distance = plane->normal_C.dot(camera.unproject(u, v, z)) - plane->offset;
    squares.add(distance * distance);
  });
  return std::sqrt(squares.value());
}

double subpixel_rms(const Image<float>& depth, const PinholeCamera& camera, const ImageRegion& region,
                    double baseline) {
  const auto plane = fit_wall(depth, camera, region);
  if (!plane) return kNone;
  const double fB = camera.fx * baseline;
  Mean squares;
  for_valid(depth, region, [&](int u, int v, double z) {
    const double difference = fB / z - fB / plane->depth_at(camera, u, v);
    squares.add(difference * difference);
  });
  return std::sqrt(squares.value());
}

double z_accuracy(const Image<float>& depth, const Image<float>& truth, const ImageRegion& region) {
  std::vector<double> errors;
  for_valid(depth, region, [&](int u, int v, double z) { errors.push_back((z - truth(u, v)) / truth(u, v)); });
  return errors.size() < kFewest ? kNone : median_of(errors);
}

double mean_error(const Image<float>& depth, const Image<float>& truth, const ImageRegion& region) {
  Mean errors;
  for_valid(depth, region, [&](int u, int v, double z) { errors.add(z - truth(u, v)); });
  return errors.value();
}

double rms_error(const Image<float>& depth, const Image<float>& truth, const ImageRegion& region) {
  Mean squares;
  for_valid(depth, region, [&](int u, int v, double z) { squares.add((z - truth(u, v)) * (z - truth(u, v))); });
  return std::sqrt(squares.value());
}

double fill_rate(const Image<float>& depth, const ImageRegion& region) {
  std::size_t valid = 0;
  for_valid(depth, region, [&](int, int, double) { ++valid; });
  return region.pixels() > 0 ? static_cast<double>(valid) / region.pixels() : kNone;
}

double temporal_noise(const std::vector<Image<float>>& frames, const ImageRegion& region) {
  std::vector<double> relative;
  for (int v = region.v0; v < region.v1; ++v)
    for (int u = region.u0; u < region.u1; ++u) {
      std::vector<double> depths;
      for (const Image<float>& frame : frames)
        if (!std::isnan(frame(u, v))) depths.push_back(frame(u, v));
      if (depths.size() < 2 || 2 * depths.size() < frames.size()) continue;
      double mean = 0, squares = 0;
      for (const double z : depths) mean += z / static_cast<double>(depths.size());
      for (const double z : depths) squares += (z - mean) * (z - mean);
      relative.push_back(std::sqrt(squares / static_cast<double>(depths.size() - 1)) / median_of(depths));
    }
  return relative.size() < kFewest ? kNone : median_of(relative);
}

Image<float> frame_mean(const std::vector<Image<float>>& frames) {
  BP_CHECK(!frames.empty());
  Image<float> mean(frames.front().width(), frames.front().height());
  for (std::size_t i = 0; i < mean.size(); ++i) {
    Mean pixel;
    for (const Image<float>& frame : frames)
      if (!std::isnan(frame[i])) pixel.add(frame[i]);
    mean[i] = static_cast<float>(pixel.value(1));
  }
  return mean;
}

double error_correlation(const Image<float>& depth, const Image<float>& truth, const ImageRegion& region, int lag) {
  BP_CHECK(lag >= 0);
  const double mean = mean_error(depth, truth, region);
  Mean variance, product;
  const ImageRegion left{region.u0, region.v0, region.u1 - lag, region.v1};
  for_valid(depth, region, [&](int u, int v, double z) { variance.add(std::pow(z - truth(u, v) - mean, 2)); });
  for_valid(depth, left, [&](int u, int v, double z) {
    const double other = depth(u + lag, v) - static_cast<double>(truth(u + lag, v)) - mean;
    if (!std::isnan(other)) product.add((z - truth(u, v) - mean) * other);
  });
  return product.value() / variance.value();
}

}  // namespace binpick

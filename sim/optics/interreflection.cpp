#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/parallel.hpp"
#include "sim/optics/stripe_light.hpp"

namespace binpick {
namespace {

constexpr int kPatch = 16;             // px
constexpr double kSameSurface = 0.05;  // of the depth: patches further away lend a pixel nothing
constexpr int kChannels = StripeBasis::kChannels;

using Channels = Eigen::Matrix<double, kChannels, 1>;

struct Patch {
  bool seen = false;
  Eigen::Vector3d p_C, n_C;
  double area = 0;                       // m^2, of the surface itself
  Channels radiance = Channels::Zero();  // mean over the patch
  Eigen::Matrix<double, 3, kChannels> arriving = Eigen::Matrix<double, 3, kChannels>::Zero();  // irradiance as a vector
};

class PatchGrid {
 public:
  PatchGrid(const ImagerView& imager, const StripeBasis& basis)
      : columns_((imager.camera.width + kPatch - 1) / kPatch),
        rows_((imager.camera.height + kPatch - 1) / kPatch),
        patches_(static_cast<std::size_t>(columns_) * rows_) {
    for (int row = 0; row < rows_; ++row)
      for (int column = 0; column < columns_; ++column) fill(imager, basis, column, row);
  }

  void exchange(int threads) {
    parallel_for(patches_.size(), threads, [&](std::size_t i) {
      Patch& to = patches_[i];
      if (!to.seen) return;
      for (std::size_t j = 0; j < patches_.size(); ++j) {
        const Patch& from = patches_[j];
        if (!from.seen || j == i) continue;
        const Eigen::Vector3d way = from.p_C - to.p_C;
        const double r2 = std::max(way.squaredNorm(), from.area / std::numbers::pi);
        const Eigen::Vector3d direction = way / std::sqrt(r2);
        const double leaving = -from.n_C.dot(direction);
        if (leaving <= 0 || to.n_C.dot(direction) <= 0) continue;
        to.arriving += direction * (leaving * from.area / r2 * from.radiance).transpose();
      }
    });
  }

  /// Irradiance of a surface of depth z and normal n at pixel (u, v), between the patches around it.
  Channels irradiance(double u, double v, double z, const Eigen::Vector3d& n_C) const {
    const double x = (u + 0.5) / kPatch - 0.5, y = (v + 0.5) / kPatch - 0.5;
    const int i0 = static_cast<int>(std::floor(x)), j0 = static_cast<int>(std::floor(y));
    Channels sum = Channels::Zero();
    double weights = 0;
    for (int j = j0; j <= j0 + 1; ++j)
      for (int i = i0; i <= i0 + 1; ++i) {
        if (i < 0 || j < 0 || i >= columns_ || j >= rows_) continue;
        const Patch& patch = patches_[static_cast<std::size_t>(j) * columns_ + i];
        if (!patch.seen || std::abs(patch.p_C.z() - z) > kSameSurface * z) continue;
        const double weight = (1 - std::abs(x - i)) * (1 - std::abs(y - j));
        sum += weight * (patch.arriving.transpose() * n_C);
        weights += weight;
      }
    return weights > 0 && sum[0] > 0 ? Channels(sum / weights) : Channels(Channels::Zero());
  }

 private:
  void fill(const ImagerView& imager, const StripeBasis& basis, int column, int row) {
    const PinholeCamera& camera = imager.camera;
    Patch& patch = patches_[static_cast<std::size_t>(row) * columns_ + column];
    const int u1 = std::min((column + 1) * kPatch, camera.width), v1 = std::min((row + 1) * kPatch, camera.height);
    const int um = (column * kPatch + u1) / 2, vm = (row * kPatch + v1) / 2;
    const double z = imager.frame.depth(um, vm);
    if (!(z > 0)) return;
    patch.seen = true;
    patch.p_C = camera.unproject(um, vm, z);
    patch.n_C = imager.frame.normals_C(um, vm).cast<double>();
    const double cosine = std::max(-patch.n_C.dot(camera.ray(um, vm).normalized()), 0.05);
    int seen = 0;
    for (int v = row * kPatch; v < v1; ++v)
      for (int u = column * kPatch; u < u1; ++u) {
        const double depth = imager.frame.depth(u, v);
        if (!(std::abs(depth - z) < kSameSurface * z)) continue;
        ++seen;
        for (int c = 0; c < kChannels; ++c) patch.radiance[c] += basis.channels[static_cast<std::size_t>(c)](u, v);
      }
    patch.radiance /= seen;
    patch.area = seen * z * z / (camera.fx * camera.fy * cosine);
  }

  int columns_, rows_;
  std::vector<Patch> patches_;
};

}  // namespace

void add_interreflection(const ImagerView& imager, int threads, StripeBasis& basis) {
  PatchGrid grid(imager, basis);
  grid.exchange(threads);
  parallel_for(static_cast<std::size_t>(imager.camera.height), threads, [&](std::size_t row) {
    const int v = static_cast<int>(row);
    for (int u = 0; u < imager.camera.width; ++u) {
      const double z = imager.frame.depth(u, v);
      if (!(z > 0)) continue;
      const double albedo = imager.frame.materials[imager.frame.ids(u, v)].albedo;
      const Channels E = grid.irradiance(u, v, z, imager.frame.normals_C(u, v).cast<double>());
      for (int c = 0; c < kChannels; ++c)
        basis.channels[static_cast<std::size_t>(c)](u, v) += static_cast<float>(albedo / std::numbers::pi * E[c]);
    }
  });
}

}  // namespace binpick

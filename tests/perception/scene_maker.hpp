// Heaps for the tests of perception, without the simulator: parts lowered one after another onto a height field
// (nothing interpenetrates, nothing is settled), drawn with core's z-buffer, and a stereo-like noise in the disparity
// domain.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/mesh_properties.hpp"
#include "core/part.hpp"
#include "core/pose_estimate.hpp"
#include "core/primitive.hpp"
#include "core/random.hpp"
#include "core/sample_surface.hpp"
#include "core/zbuffer.hpp"
#include "tests/perception/example_parts.hpp"

namespace binpick::testing_scene {

// ---------------------------------------------------------------- heaps

struct Instance {
  std::size_t part = 0;
  Pose X_WP = Pose::Identity();
  double visible_fraction = 0;
  int visible_pixels = 0;
};

struct HeapScene {
  std::vector<Instance> instances;
  DepthFrame frame;  ///< noise-free or noisy
  SceneView view;    ///< what the estimator is given
  Pose X_WC = Pose::Identity();
};

struct HeapOptions {
  int count = 10;
  Eigen::Vector3d bin_size = {0.4, 0.3, 0.2};
  double draft = 0;                ///< rad
  std::vector<double> dividers_x;  ///< m
  double camera_height = 0.6;
  double upright_share = 0.35;  ///< of parts with any orientation; the others lie within some 15 degrees of flat
  bool noise = true;
  double bias_px = 0.03;  ///< standard deviation of the frame's disparity offset
  double sigma_px = 0.08;
};

inline Pose camera_above(double height) {
  Pose X_WC = Pose::Identity();
  X_WC.linear() << 1, 0, 0, 0, -1, 0, 0, 0, -1;  // looking down, image x along world x
  X_WC.translation() = Eigen::Vector3d(0, 0, height);
  return X_WC;
}

/// Height field of the heap, 2 mm cells.
class HeightField {
 public:
  explicit HeightField(const Eigen::Vector3d& bin) : half_(bin / 2) {
    nx_ = static_cast<int>(bin.x() / kCell) + 1;
    ny_ = static_cast<int>(bin.y() / kCell) + 1;
    height_.assign(static_cast<std::size_t>(nx_ * ny_), 0.0);
  }
  bool fits(const std::vector<Eigen::Vector3d>& points) const {
    return std::all_of(points.begin(), points.end(), [&](const Eigen::Vector3d& p) {
      return std::abs(p.x()) < half_.x() - 0.001 && std::abs(p.y()) < half_.y() - 0.001;
    });
  }
  /// Lowest z shift at which no point is below the heap.
  double rest(const std::vector<Eigen::Vector3d>& points) const {
    double z = -1e9;
    for (const Eigen::Vector3d& p : points) z = std::max(z, height_[cell(p)] - p.z());
    return z;
  }
  void add(const std::vector<Eigen::Vector3d>& points, double shift) {
    for (const Eigen::Vector3d& p : points) height_[cell(p)] = std::max(height_[cell(p)], p.z() + shift);
  }

 private:
  static constexpr double kCell = 0.002;
  std::size_t cell(const Eigen::Vector3d& p) const {
    const int x = std::clamp(static_cast<int>((p.x() + half_.x()) / kCell), 0, nx_ - 1);
    const int y = std::clamp(static_cast<int>((p.y() + half_.y()) / kCell), 0, ny_ - 1);
    return static_cast<std::size_t>(y * nx_ + x);
  }
  Eigen::Vector3d half_;
  int nx_, ny_;
  std::vector<double> height_;
};

inline Eigen::Matrix3d random_orientation(Rng& rng, double upright_share) {
  if (rng.uniform() < upright_share) return rng.rotation().toRotationMatrix();
  const double tilt = 0.2 * rng.normal(), heading = rng.uniform(0, 2 * std::numbers::pi);
  Eigen::Matrix3d R = exp_so3(Eigen::Vector3d(std::cos(heading), std::sin(heading), 0) * tilt) *
                      exp_so3(Eigen::Vector3d::UnitZ() * rng.uniform(0, 2 * std::numbers::pi));
  if (rng.uniform() < 0.5) R = R * exp_so3(Eigen::Vector3d::UnitX() * std::numbers::pi);
  return R;
}

inline std::vector<Instance> make_heap(const Part& part, const HeapOptions& options, Seed seed) {
  Rng rng = seed.child("heap").rng();
  HeightField field(options.bin_size);
  const PointCloud surface = sample_surface(part.mesh_P, 0.0015, Seed{7});
  std::vector<Instance> heap;
  for (int k = 0; k < options.count; ++k) {
    // The lowest of several places: parts roll down, they do not stack up.
    std::vector<Eigen::Vector3d> best_points;
    Instance best;
    double lowest = 1e9;
    for (int attempt = 0, tried = 0; attempt < 80 && tried < 6; ++attempt) {
      const Eigen::Matrix3d R = random_orientation(rng, options.upright_share);
      const Eigen::Vector3d t(rng.uniform(-0.5, 0.5) * options.bin_size.x(),
                              rng.uniform(-0.5, 0.5) * options.bin_size.y(), 0);
      std::vector<Eigen::Vector3d> points;
      for (const Eigen::Vector3d& p : surface.points) points.push_back(R * (p - part.box_center_P) + t);
      if (!field.fits(points)) continue;
      ++tried;
      const double z = field.rest(points);
      if (z >= lowest) continue;
      lowest = z;
      best.X_WP = pose_from(R, t + Eigen::Vector3d(0, 0, z) - R * part.box_center_P);
      best_points = std::move(points);
    }
    if (best_points.empty()) continue;
    field.add(best_points, lowest);
    heap.push_back(best);
  }
  return heap;
}

// ---------------------------------------------------------------- camera

/// Draws floor, walls and instances; fills the visible fractions.
inline DepthIds draw_heap(const Part& part, std::vector<Instance>& heap, const PinholeCamera& camera, const Pose& X_CW,
                          const BinSpec& bin) {
  ZBuffer buffer(camera);
  for (const Primitive& box : bin_boxes(bin, bin.wall)) buffer.draw(mesh_of(box), X_CW, 100000);
  buffer.draw(mesh_of(Primitive::box({2, 2, 0.02}, pose_from(Eigen::Matrix3d::Identity(), {0, 0, -0.03}))), X_CW,
              100001);
  for (std::size_t i = 0; i < heap.size(); ++i)
    buffer.draw(part.mesh_P, X_CW * heap[i].X_WP, static_cast<std::int32_t>(i));
  for (std::size_t i = 0; i < heap.size(); ++i) {
    ZBuffer alone(camera);
    alone.draw(part.mesh_P, X_CW * heap[i].X_WP, 0);
    int whole = 0, seen = 0;
    for (std::size_t k = 0; k < buffer.result().ids.size(); ++k) {
      whole += alone.result().ids[k] == 0;
      seen += buffer.result().ids[k] == static_cast<std::int32_t>(i);
    }
    heap[i].visible_pixels = seen;
    heap[i].visible_fraction = whole > 0 ? static_cast<double>(seen) / whole : 0;
  }
  return buffer.result();
}

/// White noise filtered by a Gaussian of `length` px, variance one.
inline Image<float> correlated_field(int width, int height, double length, Rng rng) {
  Image<float> white(width, height), rows(width, height), out(width, height);
  for (float& x : white) x = static_cast<float>(rng.normal());
  const int half = static_cast<int>(3 * length);
  std::vector<float> kernel;
  double power = 0;
  for (int k = -half; k <= half; ++k) kernel.push_back(static_cast<float>(std::exp(-k * k / (2 * length * length))));
  for (const float k : kernel) power += k * k;
  for (float& k : kernel) k /= static_cast<float>(std::sqrt(power));
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      for (int k = -half; k <= half; ++k) rows(u, v) += kernel[k + half] * white(std::clamp(u + k, 0, width - 1), v);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      for (int k = -half; k <= half; ++k) out(u, v) += kernel[k + half] * rows(u, std::clamp(v + k, 0, height - 1));
  return out;
}

/// Foreground grows by one pixel where the depth jumps.
inline Image<float> fattened(const Image<float>& depth) {
  Image<float> out = depth;
  for (int v = 0; v < depth.height(); ++v)
    for (int u = 0; u < depth.width(); ++u)
      for (int b = -1; b <= 1; ++b)
        for (int a = -1; a <= 1; ++a)
          if (depth.contains(u + a, v + b) && depth(u + a, v + b) < out(u, v) - 0.008f) out(u, v) = depth(u + a, v + b);
  return out;
}

/// Pixels that the second camera of a stereo pair cannot see.
inline Image<std::uint8_t> shadow(const Image<float>& depth, double focal_baseline) {
  Image<std::uint8_t> out(depth.width(), depth.height(), 0);
  for (int v = 0; v < depth.height(); ++v) {
    double covered = -1e9;  // the second camera stands to the right: pixels move left by their disparity
    for (int u = depth.width() - 1; u >= 0; --u) {
      const double x = u - focal_baseline / depth(u, v);
      if (u < depth.width() - 1 && x > covered + 0.5 && covered > -1e8) out(u, v) = 1;
      covered = covered < -1e8 ? x : std::min(covered, x);
    }
  }
  return out;
}

inline Image<float> stereo_noise(const Image<float>& exact, const PinholeCamera& camera, const HeapOptions& options,
                                 Seed seed) {
  const double focal_baseline = camera.fx * 0.05;
  const Image<float> depth = fattened(exact);
  const Image<std::uint8_t> hidden = shadow(depth, focal_baseline);
  const Image<float> field = correlated_field(depth.width(), depth.height(), 2.5, seed.child("field").rng());
  Rng rng = seed.child("pixels").rng();
  const double bias = options.bias_px * seed.child("bias").rng().normal();
  Image<float> out(depth.width(), depth.height(), std::numeric_limits<float>::quiet_NaN());
  for (int v = 1; v + 1 < depth.height(); ++v)
    for (int u = 1; u + 1 < depth.width(); ++u) {
      const double hole = rng.uniform();
      if (!std::isfinite(depth(u, v)) || hidden(u, v) || hole < 0.005) continue;
      const Eigen::Vector3d dx =
          camera.unproject(u + 1, v, depth(u + 1, v)) - camera.unproject(u - 1, v, depth(u - 1, v));
      const Eigen::Vector3d dy =
          camera.unproject(u, v + 1, depth(u, v + 1)) - camera.unproject(u, v - 1, depth(u, v - 1));
      const double cosine = std::abs(dx.cross(dy).normalized().dot(camera.ray(u, v).normalized()));
      const double angle = std::acos(std::min(1.0, cosine));
      const bool smooth = dx.norm() < 0.05 && dy.norm() < 0.05;
      if (smooth && hole < 1 / (1 + std::exp((75 - angle * 180 / std::numbers::pi) / 3))) continue;
      const double grazing = 1 + 0.1 * std::min(20.0, 1 / (cosine * cosine) - 1);
      double d = focal_baseline / depth(u, v) + bias + options.sigma_px * (smooth ? grazing : 1) * field(u, v);
      d = std::round(d * 32) / 32;
      out(u, v) = static_cast<float>(std::round(focal_baseline / d * 1e4) / 1e4);
    }
  return out;
}

/// A frame of a given heap.
inline HeapScene photograph(const Part& part, std::vector<Instance> heap, const HeapOptions& options, Seed seed,
                            const Pose& X_WC) {
  HeapScene scene;
  scene.X_WC = X_WC;
  scene.instances = std::move(heap);
  BinSpec bin;
  bin.inner_size = options.bin_size;
  bin.draft = options.draft;
  bin.dividers_x = options.dividers_x;
  const DepthIds drawn = draw_heap(part, scene.instances, scene.frame.camera, X_WC.inverse(), bin);
  scene.frame.depth = drawn.depth;
  scene.frame.X_WC = X_WC;
  if (options.noise) {
    scene.frame.depth = stereo_noise(drawn.depth, scene.frame.camera, options, seed.child("noise"));
    scene.frame.noise.quadratic = options.sigma_px / (scene.frame.camera.fx * 0.05);
    scene.frame.noise.fattening_px = 1;
  }
  for (float& z : scene.frame.depth)
    if (!std::isfinite(z)) z = std::numeric_limits<float>::quiet_NaN();
  scene.view.seen = scene.frame;
  scene.view.bin = bin;
  scene.view.X_CB = X_WC.inverse();
  return scene;
}

inline HeapScene make_scene(const Part& part, const HeapOptions& options, Seed seed, const Pose& X_WC) {
  return photograph(part, make_heap(part, options, seed), options, seed, X_WC);
}

// ---------------------------------------------------------------- right or wrong

/// Largest distance of a vertex from its place, modulo the symmetry.
inline double mssd(const Part& part, const Pose& X_1, const Pose& X_2, const std::vector<Eigen::Vector3d>& vertices) {
  double least = 1e9;
  for (const Pose& S : sampled_group(part.symmetry, 90)) {
    double worst = 0;
    for (const Eigen::Vector3d& v : vertices) worst = std::max(worst, (X_1 * v - X_2 * (S * v)).norm());
    least = std::min(least, worst);
  }
  return least;
}

}  // namespace binpick::testing_scene

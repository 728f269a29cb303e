#include "perception/view_ambiguity.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/mesh_properties.hpp"
#include "core/zbuffer.hpp"

namespace binpick {
namespace {

constexpr double kNear = 0.01;     // m
constexpr int kRim = 3;            // px about the projection of the box
constexpr int kBlur = 1;           // px, an outline that lies off by less is the same
constexpr int kFewestPixels = 30;  // visible, to say anything

/// Crop of the camera that holds the part; its image's (0, 0) is pixel (u0, v0).
struct Crop {
  PinholeCamera camera;
  int u0 = 0, v0 = 0;
};

Crop crop_of(const PinholeCamera& camera, const Eigen::AlignedBox3d& box, const Pose& X_CP) {
  Crop crop{camera, 0, 0};
  const double radius = box.diagonal().norm() / 2;
  const Eigen::Vector3d center = X_CP * box.center();
  if (!(center.z() > radius + kNear)) return crop;
  // The part and its turned twin share their middle only about, so that twice the radius is looked at.
  const Eigen::Vector2d c = camera.project(center);
  const double du = 2 * radius * camera.fx / (center.z() - radius), dv = 2 * radius * camera.fy / (center.z() - radius);
  const auto clip = [](double x, int most) { return static_cast<int>(std::clamp(x, 0.0, static_cast<double>(most))); };
  crop.u0 = clip(c.x() - du - kRim, camera.width - 1);
  crop.v0 = clip(c.y() - dv - kRim, camera.height - 1);
  crop.camera.width = clip(c.x() + du + kRim, camera.width - 1) - crop.u0 + 1;
  crop.camera.height = clip(c.y() + dv + kRim, camera.height - 1) - crop.v0 + 1;
  crop.camera.cx -= crop.u0;
  crop.camera.cy -= crop.v0;
  return crop;
}

struct Comparison {
  const StatedNoise& noise;
  const AmbiguityConfig& config;
  float tolerance(float z) const {
    return static_cast<float>(std::max(config.tolerance, config.tolerance_sigmas * noise.sigma(z)));
  }
};

/// Does `other` have this depth at the pixel or within the blur of it?
bool has_depth(const Image<float>& other, int u, int v, float z, const Comparison& by) {
  const float near = by.tolerance(z);
  for (int b = -kBlur; b <= kBlur; ++b)
    for (int a = -kBlur; a <= kBlur; ++a)
      if (other.contains(u + a, v + b) && std::abs(other(u + a, v + b) - z) <= near) return true;
  return false;
}

/// The scene's depth at a pixel of the crop; infinite where it has none or there is no scene.
float seen_at(const Image<float>* exact, const Crop& crop, int u, int v) {
  if (!exact || !exact->contains(u + crop.u0, v + crop.v0)) return std::numeric_limits<float>::infinity();
  const float z = (*exact)(u + crop.u0, v + crop.v0);
  return z > 0 ? z : std::numeric_limits<float>::infinity();
}

/// Pixels of the part as it is seen: those that nothing nearer covers.
Image<float> visible_part(Image<float> drawn, const Image<float>* exact, const Crop& crop) {
  for (int v = 0; v < drawn.height(); ++v)
    for (int u = 0; u < drawn.width(); ++u)
      if (seen_at(exact, crop, u, v) < drawn(u, v) - 0.001f) drawn(u, v) = std::numeric_limits<float>::infinity();
  return drawn;
}

/// Pixels that would look different: the part's that the twin does not explain, and the twin's that the scene shows to
/// be empty.
int different(const Image<float>& part, const Image<float>& twin, const Image<float>* exact, const Crop& crop,
              const Comparison& by) {
  int count = 0;
  for (int v = 0; v < part.height(); ++v)
    for (int u = 0; u < part.width(); ++u) {
      const float z = part(u, v), t = twin(u, v);
      if (std::isfinite(z)) count += !has_depth(twin, u, v, z, by);
      if (!std::isfinite(t)) continue;
      const float seen = exact ? seen_at(exact, crop, u, v) : z;
      if (seen > t + by.tolerance(t) && !std::isfinite(z)) count += !has_depth(part, u, v, t, by);
    }
  return count;
}

}  // namespace

void AmbiguityConfig::visit(ConfigVisitor& v) {
  v.field("tolerance", tolerance, Unit::kLength, "depth difference that tells two poses apart, at least");
  v.field("tolerance_sigmas", tolerance_sigmas, Unit::kNone, "the same in standard deviations of the sensor");
  v.field("least_difference", least_difference, Unit::kNone,
          "share of the visible pixels that must differ to tell two poses apart");
}

void AmbiguityConfig::validate() const {
  if (!(tolerance > 0 && tolerance < 0.1)) throw SpecError("ambiguity.tolerance: must lie between 0 and 100 mm");
  if (!(tolerance_sigmas >= 0 && tolerance_sigmas <= 20))
    throw SpecError("ambiguity.tolerance_sigmas: must lie between 0 and 20");
  if (!(least_difference >= 0 && least_difference <= 1))
    throw SpecError("ambiguity.least_difference: must lie between 0 and 1");
}

AmbiguousViews::AmbiguousViews(const Part& part)
    : mesh_P_(part.mesh_P),
      box_P_(bounding_box(part.mesh_P)),
      overlaps_(self_overlaps(part.mesh_P, part.symmetry, part.diameter)) {}

AmbiguousViews::Rival AmbiguousViews::nearest_rival(const Pose& X_CP, const PinholeCamera& camera,
                                                    const StatedNoise& noise, const Image<float>* exact,
                                                    const AmbiguityConfig& config) const {
  Rival best;
  if (overlaps_.empty()) return best;
  const Crop crop = crop_of(camera, box_P_, X_CP);
  ZBuffer buffer(crop.camera, kNear);
  buffer.draw(mesh_P_, X_CP, 0);
  const Image<float> part = visible_part(buffer.result().depth, exact, crop);
  const auto pixels = std::count_if(part.begin(), part.end(), [](float z) { return std::isfinite(z); });
  if (pixels < kFewestPixels) return best;
  const Comparison by{noise, config};
  for (const SelfOverlap& overlap : overlaps_) {
    const Pose twin_pose = X_CP * overlap.T;
    buffer.clear();
    buffer.draw(mesh_P_, twin_pose, 0);
    const double share =
        static_cast<double>(different(part, buffer.result().depth, exact, crop, by)) / static_cast<double>(pixels);
    if (share < best.difference) best = {share, twin_pose};
  }
  return best;
}

bool AmbiguousViews::ambiguous(const Pose& X_CP, const PinholeCamera& camera, const StatedNoise& noise,
                               const Image<float>* exact, const AmbiguityConfig& config) const {
  return nearest_rival(X_CP, camera, noise, exact, config).difference < config.least_difference;
}

}  // namespace binpick

#include "sim/grey_image.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "core/error.hpp"
#include "sim/depth_range.hpp"
#include "sim/optics/projector_light.hpp"
#include "sim/optics/reflectance.hpp"

namespace binpick {
namespace {

const Eigen::Vector3d kToLamp_W = Eigen::Vector3d(0.28, -0.24, 1.0).normalized();
constexpr double kLampDistance = 3;  // radii of what it lights
constexpr int kShadowSide = 2048;    // px of the lamp's shadow map
constexpr double kOnPlane = 5e-4;    // m: a hit this near to a texture's plane lies on it
constexpr int kLargestFrame = 8192;  // px a side of the fine pinhole frame behind a lens

/// A lamp over the scene and what it reaches.
class Lamp {
 public:
  Lamp(DepthRenderer& renderer, const RenderScene& scene, const Pose& X_WC) {
    Eigen::AlignedBox3d box;  // of everything but the table, whose far corners need no shadow
    for (const RenderItem& item : scene.items)
      if (item.id != kIdTable)
        for (const Eigen::Vector3d& p_O : item.mesh_O->vertices) box.extend(item.X_WO * p_O);
    const double radius = box.isEmpty() ? 1.0 : std::max(0.5 * box.diagonal().norm(), 0.01);
    Pose X_WL = Pose::Identity();
    X_WL.linear() = rotation_with_z(-kToLamp_W);
    X_WL.translation() =
        (box.isEmpty() ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : box.center()) + kLampDistance * radius * kToLamp_W;
    device_.width = device_.height = kShadowSide;
    device_.fx = device_.fy = 0.5 * kShadowSide / std::tan(std::asin(1 / kLampDistance));
    device_.cx = device_.cy = 0.5 * (kShadowSide - 1);
    const Pose X_CL = X_WC.inverse() * X_WL;
    const auto [near, far] = depth_range(scene, X_WL);
    light_.emplace(renderer.render(scene, device_, X_WL, near, far), device_, X_CL);
    X_LC_ = X_CL.inverse();
    p_CL_ = X_CL.translation();
  }

  double light_from(const Material& material, const Eigen::Vector3d& p_C, const Eigen::Vector3d& n_C) const {
    const double f = reflectance(material, n_C, (p_CL_ - p_C).normalized(), -p_C.normalized());
    return f > 0 ? std::numbers::pi * f * light_->visible(X_LC_ * p_C) : 0;
  }

 private:
  PinholeCamera device_;
  Pose X_LC_ = Pose::Identity();
  Eigen::Vector3d p_CL_ = Eigen::Vector3d::Zero();
  std::optional<ProjectorLight> light_;
};

/// A textured item as the camera meets it.
struct Print {
  const SurfaceTexture* texture;
  Pose X_OC;

  /// Where a ray of C meets the plane of the print.
  Eigen::Vector2d hit(const Eigen::Vector3d& ray_C) const {
    const Eigen::Vector3d o = X_OC.translation(), d = X_OC.linear() * ray_C;
    return (o - d * (o.z() / d.z())).head<2>();
  }
  bool on_its_plane(const Eigen::Vector3d& p_C) const {
    return X_OC.translation().z() > 0 && std::abs((X_OC * p_C).z()) < kOnPlane;
  }
};

/// The same view with `n` samples a side: pixel centres stay at integers.
PinholeCamera oversampled(const PinholeCamera& camera, int n) {
  return {camera.width * n, camera.height * n,           camera.fx * n,
          camera.fy * n,    n * (camera.cx + 0.5) - 0.5, n * (camera.cy + 0.5) - 0.5};
}

/// A pinhole view, as fine, that holds every direction of the distorted image.
PinholeCamera wide_enough(const PinholeCamera& fine, const LensDistortion& lens) {
  if (lens.none()) return fine;
  Eigen::Array2d low = Eigen::Array2d::Constant(1e9), high = -low;
  const auto add = [&](double u, double v) {
    const Eigen::Array2d at = ray(fine, lens, u, v).head<2>();
    low = low.min(at);
    high = high.max(at);
  };
  for (int u = 0; u < fine.width; ++u) add(u, 0), add(u, fine.height - 1);
  for (int v = 0; v < fine.height; ++v) add(0, v), add(fine.width - 1, v);
  PinholeCamera wide = fine;
  const double shrink =
      std::min(1.0, (kLargestFrame - 4) / ((high - low) * Eigen::Array2d(fine.fx, fine.fy)).maxCoeff());
  wide.fx *= shrink;
  wide.fy *= shrink;
  wide.cx = 1 - low.x() * wide.fx;
  wide.cy = 1 - low.y() * wide.fy;
  wide.width = static_cast<int>((high.x() - low.x()) * wide.fx) + 4;
  wide.height = static_cast<int>((high.y() - low.y()) * wide.fy) + 4;
  return wide;
}

/// Steps 1 and 2 for one sample after another.
class Shader {
 public:
  Shader(DepthRenderer& renderer, const RenderScene& scene, const GreyCamera& camera, const GreyConfig& config)
      : fine_(oversampled(camera.intrinsics, config.supersampling)),
        lens_(camera.lens),
        wide_(wide_enough(fine_, camera.lens)),
        ambient_(config.ambient),
        lamp_(renderer, scene, camera.X_WC) {
    const auto [near, far] = depth_range(scene, camera.X_WC);
    frame_ = renderer.render(scene, wide_, camera.X_WC, near, far);
    for (const RenderItem& item : scene.items)
      if (item.texture) prints_[item.id] = {item.texture.get(), item.X_WO.inverse() * camera.X_WC};
  }

  const PinholeCamera& fine() const { return fine_; }

  float at(int u, int v) const {
    const Eigen::Vector3d ray_C = ray(fine_, lens_, u, v);
    const Eigen::Vector2d place = wide_.project(ray_C);
    const int a = static_cast<int>(std::lround(place.x())), b = static_cast<int>(std::lround(place.y()));
    if (!frame_.ids.contains(a, b) || frame_.ids(a, b) == kIdNothing) return 0;
    const std::int32_t id = frame_.ids(a, b);
    const Eigen::Vector3d n_C = frame_.normals_C(a, b).cast<double>();
    const Eigen::Vector3d p_C = ray_C * static_cast<double>(frame_.depth(a, b));
    Material material = frame_.materials[id];
    if (const auto print = prints_.find(id); print != prints_.end() && print->second.on_its_plane(p_C))
      material.albedo = printed(print->second, ray_C, u, v).value_or(material.albedo);
    return static_cast<float>((1 - ambient_) * lamp_.light_from(material, p_C, n_C) +
                              ambient_ * std::numbers::pi * ambient_reflectance(material));
  }

 private:
  /// Reflectance averaged over the sample's own area; nothing beside the print.
  std::optional<double> printed(const Print& print, const Eigen::Vector3d& ray_C, int u, int v) const {
    const Eigen::Vector2d p = print.hit(ray_C);
    const Eigen::Vector2d along_u = print.hit(ray(fine_, lens_, u + 1, v)) - p;
    const Eigen::Vector2d along_v = print.hit(ray(fine_, lens_, u, v + 1)) - p;
    const Eigen::Vector2d half = 0.5 * (along_u.cwiseAbs() + along_v.cwiseAbs());
    // The exact frame's pixels are about as large: a sample of the item's rim may lie that much beside it.
    if (!print.texture->covers(p, 2 * half)) return std::nullopt;
    return print.texture->mean(p, half);
  }

  PinholeCamera fine_;
  LensDistortion lens_;
  PinholeCamera wide_;
  double ambient_;
  Lamp lamp_;
  ExactFrame frame_;
  std::map<std::int32_t, Print> prints_;
};

/// Gaussian over the samples, cut at four standard deviations; the border is continued.
void blur_samples(Image<float>& image, double sigma) {
  if (!(sigma > 0)) return;
  const int reach = static_cast<int>(std::ceil(4 * sigma));
  std::vector<float> weights(static_cast<std::size_t>(reach) + 1);
  float sum = 0;
  for (int k = 0; k <= reach; ++k) {
    weights[static_cast<std::size_t>(k)] = static_cast<float>(std::exp(-0.5 * k * k / (sigma * sigma)));
    sum += (k == 0 ? 1.0f : 2.0f) * weights[static_cast<std::size_t>(k)];
  }
  for (float& w : weights) w /= sum;
  const auto pass = [&](const Image<float>& from, Image<float>& to, int du, int dv) {
    for (int v = 0; v < from.height(); ++v)
      for (int u = 0; u < from.width(); ++u) {
        float mean = weights[0] * from(u, v);
        for (int k = 1; k <= reach; ++k) {
          const int a = std::max(u - k * du, 0), b = std::max(v - k * dv, 0);
          const int c = std::min(u + k * du, from.width() - 1), d = std::min(v + k * dv, from.height() - 1);
          mean += weights[static_cast<std::size_t>(k)] * (from(a, b) + from(c, d));
        }
        to(u, v) = mean;
      }
  };
  Image<float> other(image.width(), image.height());
  pass(image, other, 1, 0);
  pass(other, image, 0, 1);
}

Image<float> averaged(const Image<float>& samples, int n) {
  Image<float> image(samples.width() / n, samples.height() / n);
  for (int v = 0; v < image.height(); ++v)
    for (int u = 0; u < image.width(); ++u) {
      float sum = 0;
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) sum += samples(u * n + i, v * n + j);
      image(u, v) = sum / static_cast<float>(n * n);
    }
  return image;
}

}  // namespace

void GreyConfig::visit(ConfigVisitor& v) {
  v.field("supersampling", supersampling, "samples a side of one pixel");
  v.field("blur", blur, Unit::kNone, "of the lens: standard deviation in pixels");
  v.field("ambient", ambient, Unit::kNone, "share of the light that comes from all around");
  v.field("white", white, Unit::kNone, "grey level of a white matt surface that faces the lamp");
  v.field("full_well", full_well, Unit::kNone, "electrons at grey level 255");
  v.field("read_noise", read_noise, Unit::kNone, "electrons, standard deviation");
}

void GreyConfig::validate() const {
  if (supersampling < 1 || supersampling > 8) throw SpecError("grey: supersampling must lie between 1 and 8");
  if (!(blur >= 0 && blur <= 10)) throw SpecError("grey: blur must lie between 0 and 10 pixels");
  if (!(ambient >= 0 && ambient <= 1)) throw SpecError("grey: ambient must lie between 0 and 1");
  if (!(white > 0 && white <= 10000)) throw SpecError("grey: white must lie between 0 and 10000 grey levels");
  if (!(full_well >= 100 && full_well <= 1e7))
    throw SpecError("grey: full_well must lie between 100 and 1e7 electrons");
  if (!(read_noise >= 0 && read_noise <= 1000))
    throw SpecError("grey: read_noise must lie between 0 and 1000 electrons");
}

Image<float> grey_light(DepthRenderer& renderer, const RenderScene& scene, const GreyCamera& camera,
                        const GreyConfig& config) {
  const Shader shader(renderer, scene, camera, config);
  Image<float> samples(shader.fine().width, shader.fine().height, 0.0f);
  for (int v = 0; v < samples.height(); ++v)
    for (int u = 0; u < samples.width(); ++u) samples(u, v) = shader.at(u, v);
  blur_samples(samples, config.blur * config.supersampling);
  return averaged(samples, config.supersampling);
}

Image<std::uint8_t> expose_grey(const Image<float>& light, const GreyConfig& config, Seed frame_seed) {
  const Rng rng = frame_seed.child("grey").rng();
  const double electrons_per_level = config.full_well / 255;
  Image<std::uint8_t> image(light.width(), light.height());
  for (std::size_t i = 0; i < light.size(); ++i) {
    const double electrons = light[i] * config.white * electrons_per_level;
    const double sigma = std::sqrt(electrons + config.read_noise * config.read_noise);
    const double level = (electrons + sigma * rng.at(i).normal()) / electrons_per_level;
    image[i] = static_cast<std::uint8_t>(std::lround(std::clamp(level, 0.0, 255.0)));
  }
  return image;
}

Image<std::uint8_t> capture_grey(DepthRenderer& renderer, const RenderScene& scene, const GreyCamera& camera,
                                 const GreyConfig& config, Seed frame_seed) {
  return expose_grey(grey_light(renderer, scene, camera, config), config, frame_seed);
}

}  // namespace binpick

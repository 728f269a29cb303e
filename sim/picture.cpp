#include "sim/picture.hpp"

#include <algorithm>
#include <cmath>

#include "sim/depth_range.hpp"

namespace binpick {
namespace {

using Colour = Eigen::Vector3f;  // linear light, 0 .. 1

constexpr int kOversampling = 2;        // samples a side of one pixel
constexpr int kShadowSide = 1536;       // px, of the shadow map
constexpr double kShadowBias = 2e-3;    // m
constexpr double kCornerReach = 0.025;  // m: how far corners darken
const Eigen::Vector3d kKeyLight_W = Eigen::Vector3d(0.28, -0.24, 1.0).normalized();
const Eigen::Vector3d kFillLight_W = Eigen::Vector3d(-0.7, 0.6, 0.5).normalized();

// A colour as a designer writes it (sRGB, 0 .. 255) in linear light.
Colour from_srgb(int r, int g, int b) {
  const auto linear = [](int c) {
    const double x = c / 255.0;
    return static_cast<float>(x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4));
  };
  return {linear(r), linear(g), linear(b)};
}

std::uint8_t to_srgb(float linear) {
  const float x = std::clamp(linear, 0.0f, 1.0f);
  const float y = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
  return static_cast<std::uint8_t>(std::lround(y * 255));
}

Colour colour_of(std::int32_t id) {
  static const Colour parts[] = {from_srgb(92, 136, 178),  from_srgb(214, 158, 84),  from_srgb(110, 164, 126),
                                 from_srgb(196, 110, 100), from_srgb(146, 126, 178), from_srgb(92, 166, 170),
                                 from_srgb(206, 182, 104), from_srgb(176, 130, 104), from_srgb(128, 148, 96),
                                 from_srgb(190, 134, 166), from_srgb(116, 128, 140), from_srgb(220, 140, 116)};
  switch (id) {
    case kIdBin:
      return from_srgb(208, 210, 212);
    case kIdTable:
      return from_srgb(150, 146, 140);
    case kIdTray:
      return from_srgb(176, 192, 204);
    case kIdArm:
      return from_srgb(228, 134, 52);
    case kIdTool:
      return from_srgb(66, 68, 74);
    default:
      return parts[static_cast<std::size_t>(id < 0 ? 0 : id) % std::size(parts)];
  }
}

bool is_part(std::int32_t id) { return id >= 0 && id < kIdBin; }

// What the key light sees: points farther from it than the map says are in shadow.
class ShadowMap {
 public:
  ShadowMap(DepthRenderer& renderer, const RenderScene& scene) {
    Eigen::AlignedBox3d box;  // of everything but the table, whose far corners need no shadow
    for (const RenderItem& item : scene.items)
      if (item.id != kIdTable)
        for (const Eigen::Vector3d& p_O : item.mesh_O->vertices) box.extend(item.X_WO * p_O);
    if (box.isEmpty()) return;
    const double radius = 0.5 * box.diagonal().norm();
    const double distance = 20 * radius;  // far away: rays almost parallel
    X_WL_.linear() = rotation_with_z(-kKeyLight_W);
    X_WL_.translation() = box.center() + distance * kKeyLight_W;
    camera_.width = camera_.height = kShadowSide;
    camera_.fx = camera_.fy = 0.5 * kShadowSide / std::tan(std::asin(radius / distance));
    camera_.cx = camera_.cy = 0.5 * (kShadowSide - 1);
    depth_ = renderer.render(scene, camera_, X_WL_, distance - 1.5 * radius, distance + 20 * radius).depth;
    X_LW_ = X_WL_.inverse();
  }

  /// 0 in shadow .. 1 in light, averaged over 5 x 5 places of the map: soft borders.
  float light_at(const Eigen::Vector3d& p_W, const Eigen::Vector3d& n_W) const {
    if (depth_.empty()) return 1;
    const Eigen::Vector3d p_L = X_LW_ * (p_W + kShadowBias * n_W);
    const Eigen::Vector2d at = camera_.project(p_L);
    const int u = static_cast<int>(std::lround(at.x())), v = static_cast<int>(std::lround(at.y()));
    int lit = 0;
    for (int dv = -4; dv <= 4; dv += 2)
      for (int du = -4; du <= 4; du += 2)
        lit += !depth_.contains(u + du, v + dv) || !(depth_(u + du, v + dv) < p_L.z() - kShadowBias);
    return static_cast<float>(lit) / 25;
  }

 private:
  PinholeCamera camera_;
  Pose X_WL_ = Pose::Identity(), X_LW_ = Pose::Identity();
  Image<float> depth_;
};

// How open the surroundings of every second sample are, 0 .. 1: the share of nearby points that do not rise above the
// tangent plane.
class Openness {
 public:
  Openness(const ExactFrame& frame, const PinholeCamera& camera) : frame_(frame), camera_(camera) {
    open_ = Image<float>(camera.width / kOversampling, camera.height / kOversampling, 1.0f);
    for (int v = 0; v < open_.height(); ++v)
      for (int u = 0; u < open_.width(); ++u) open_(u, v) = look_around(u * kOversampling, v * kOversampling);
  }
  float at(int u, int v) const {
    float sum = 0;  // 4 x 4 box: hides the pattern of the directions
    for (int dv = -2; dv < 2; ++dv)
      for (int du = -2; du < 2; ++du)
        sum += open_(std::clamp(u / kOversampling + du, 0, open_.width() - 1),
                     std::clamp(v / kOversampling + dv, 0, open_.height() - 1));
    return sum / 16;
  }

 private:
  float look_around(int u, int v) const {
    if (frame_.ids(u, v) == kIdNothing) return 1;
    const Eigen::Vector3f p = point(u, v), n = frame_.normals_C(u, v);
    const double reach = std::min(kCornerReach * camera_.fx / p.z(), 80.0);
    constexpr int kDirections = 8, kSteps = 4;
    const double turn = 0.7 * (u / kOversampling % 2) + 1.3 * (v / kOversampling % 2);
    float closed = 0;
    for (int i = 0; i < kDirections; ++i) {
      const double angle = 2 * M_PI * (i + turn) / kDirections;
      for (int k = 1; k <= kSteps; ++k) {
        const int us = u + static_cast<int>(std::lround(reach * k / kSteps * std::cos(angle)));
        const int vs = v + static_cast<int>(std::lround(reach * k / kSteps * std::sin(angle)));
        if (!frame_.ids.contains(us, vs) || frame_.ids(us, vs) == kIdNothing) continue;
        const Eigen::Vector3f to = point(us, vs) - p;
        const float distance = to.norm();
        const float rise = n.dot(to) / std::max(distance, 1e-6f);
        if (rise > 0.1f) closed += rise * std::max(0.0f, 1 - distance / static_cast<float>(2 * kCornerReach));
      }
    }
    return std::clamp(1 - 1.6f * closed / (kDirections * kSteps), 0.0f, 1.0f);
  }
  Eigen::Vector3f point(int u, int v) const { return camera_.unproject(u, v, frame_.depth(u, v)).cast<float>(); }

  const ExactFrame& frame_;
  const PinholeCamera& camera_;
  Image<float> open_;
};

// Light that leaves a surface towards the camera.
Colour shade(std::int32_t id, const Eigen::Vector3d& n_W, const Eigen::Vector3d& to_eye_W, float lit, float open) {
  const Colour base = colour_of(id);
  const float key = static_cast<float>(std::max(0.0, n_W.dot(kKeyLight_W))) * lit;
  const float fill = static_cast<float>(std::max(0.0, n_W.dot(kFillLight_W)));
  const float sky = 0.5f + 0.5f * static_cast<float>(n_W.z());
  Colour out = base * (0.58f * key + (0.16f * fill + 0.20f + 0.26f * sky) * open);
  if (is_part(id) || id == kIdTool || id == kIdArm) {
    const double half = std::max(0.0, n_W.dot((kKeyLight_W + to_eye_W).normalized()));
    out += Colour::Constant(0.22f * lit * static_cast<float>(std::pow(half, 40)));
  }
  return out;
}

// A sample beside another object that is nearer, or beside a depth step of its own: outlines are drawn darker.
bool on_outline(const ExactFrame& frame, int u, int v) {
  constexpr int kNeighbours[][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  const float z = frame.depth(u, v);
  for (const auto& d : kNeighbours) {
    if (!frame.ids.contains(u + d[0], v + d[1])) continue;
    const std::int32_t other = frame.ids(u + d[0], v + d[1]);
    if (other == frame.ids(u, v) || other == kIdNothing) continue;
    if (frame.depth(u + d[0], v + d[1]) > z || !is_part(other)) return true;
  }
  return false;
}

Image<Rgb> averaged_down(const Image<Colour>& samples) {
  Image<Rgb> image(samples.width() / kOversampling, samples.height() / kOversampling);
  for (int v = 0; v < image.height(); ++v)
    for (int u = 0; u < image.width(); ++u) {
      Colour sum = Colour::Zero();
      for (int j = 0; j < kOversampling; ++j)
        for (int i = 0; i < kOversampling; ++i) sum += samples(u * kOversampling + i, v * kOversampling + j);
      sum /= kOversampling * kOversampling;
      image(u, v) = {to_srgb(sum.x()), to_srgb(sum.y()), to_srgb(sum.z())};
    }
  return image;
}

// The same view with kOversampling samples a side: pixel centres stay at integers.
PinholeCamera oversampled(const PinholeCamera& camera) {
  PinholeCamera fine = camera;
  fine.width *= kOversampling;
  fine.height *= kOversampling;
  fine.fx *= kOversampling;
  fine.fy *= kOversampling;
  fine.cx = kOversampling * (camera.cx + 0.5) - 0.5;
  fine.cy = kOversampling * (camera.cy + 0.5) - 0.5;
  return fine;
}

}  // namespace

Image<Rgb> shaded_picture(DepthRenderer& renderer, const RenderScene& scene, const PinholeCamera& camera,
                          const Pose& X_WC) {
  const PinholeCamera fine = oversampled(camera);
  const auto [near, far] = depth_range(scene, X_WC);
  const ExactFrame frame = renderer.render(scene, fine, X_WC, near, far);
  const ShadowMap shadow(renderer, scene);
  const Openness open(frame, fine);
  Image<Colour> samples(fine.width, fine.height, Colour::Zero());
  for (int v = 0; v < fine.height; ++v)
    for (int u = 0; u < fine.width; ++u) {
      const std::int32_t id = frame.ids(u, v);
      if (id == kIdNothing) {
        samples(u, v) = Colour::Constant(0.86f - 0.14f * static_cast<float>(v) / static_cast<float>(fine.height));
        continue;
      }
      const Eigen::Vector3d p_W = X_WC * fine.unproject(u, v, frame.depth(u, v));
      const Eigen::Vector3d n_W = X_WC.linear() * frame.normals_C(u, v).cast<double>();
      const Eigen::Vector3d to_eye_W = (X_WC.translation() - p_W).normalized();
      samples(u, v) = shade(id, n_W, to_eye_W, shadow.light_at(p_W, n_W), open.at(u, v));
      if (on_outline(frame, u, v)) samples(u, v) *= 0.45f;
    }
  return averaged_down(samples);
}

}  // namespace binpick

#include "perception/pose_evidence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "perception/part_view.hpp"

namespace binpick {
namespace {

constexpr int kBeyond = 5, kBeyondInHole = 3;  // px outside the outline: past fattening and mixed pixels
constexpr int kInside = 3;                     // px inside it, where the surface is taken from
constexpr float kLeastFacing = 0.2f;           // cosine, of a surface that is carried on
constexpr float kLeastAlike = 0.9f;            // cosine between the normals on either side
constexpr float kHigh = 0.012f;                // m, that an occluder commonly stands off
constexpr float kSteepest = 0.01f;             // m per px, slope that is carried on outside the outline
constexpr int kSides = 8;
constexpr double kFewOfSide = 4;  // judged outline pixels that a side's share is damped by
constexpr int kReach = 2;         // px to either side of a border, over which a step is looked for
constexpr int kPatch = 6;         // px
constexpr int kFewOfPatch = 12;
constexpr double kLeastSigma = 0.0005;  // m, below which residuals say nothing more
constexpr double kBiasSigmas = 0.1;     // of the noise that no averaging within a patch removes

enum class Seen : std::uint8_t { kNothing, kExplained, kCovered, kOther };

struct Sums {
  int smooth = 0, steps = 0, thin = 0;
  double patches = 0, square = 0, turned = 0, normals = 0;
};

class Evidence {
 public:
  Evidence(const Scene& scene, const PartView& view, const CheckConfig& config)
      : scene_(scene), view_(view), config_(config), seen_(view.depth.width(), view.depth.height(), Seen::kNothing) {
    for (int y = 1; y < view.depth.height() - 1; ++y)
      for (int x = 1; x < view.depth.width() - 1; ++x)
        if (std::isfinite(view.depth(x, y))) seen_(x, y) = judge(x, y);
  }

  void add_borders(Sums& sums) const {
    for (int y = kReach + 1; y < seen_.height() - kReach - 2; ++y)
      for (int x = kReach + 1; x < seen_.width() - kReach - 2; ++x) {
        add_border(x, y, 1, 0, sums);
        add_border(x, y, 0, 1, sums);
      }
  }

  /// What covers the part, but lies just above it.
  void add_thin_cover(Sums& sums) const {
    for (int y = 0; y < seen_.height(); ++y)
      for (int x = 0; x < seen_.width(); ++x) sums.thin += seen_(x, y) == Seen::kCovered && residual(x, y) > -kHigh;
  }

  void add_patches(Sums& sums) const {
    for (int y = 0; y < seen_.height(); y += kPatch)
      for (int x = 0; x < seen_.width(); x += kPatch) add_patch(x, y, sums);
  }

 private:
  float residual(int x, int y) const { return scene_.depth(view_.u0 + x, view_.v0 + y) - view_.depth(x, y); }

  bool inner(int x, int y) const {
    return std::isfinite(view_.depth(x - 1, y) + view_.depth(x + 1, y) + view_.depth(x, y - 1) + view_.depth(x, y + 1));
  }

  float slope(int x, int y) const {
    float steepest = 0;
    for (const float other :
         {view_.depth(x - 1, y), view_.depth(x + 1, y), view_.depth(x, y - 1), view_.depth(x, y + 1)})
      if (std::isfinite(other)) steepest = std::max(steepest, std::abs(other - view_.depth(x, y)));
    return std::min(steepest, kSteepest);
  }

  Seen judge(int x, int y) const {
    const float r = residual(x, y);
    if (std::isnan(r)) return Seen::kOther;
    const float tolerance = depth_tolerance(scene_, view_.depth(x, y), config_) + slope(x, y);
    if (r < -tolerance) return Seen::kCovered;
    return r > tolerance || !scene_.wanted(view_.u0 + x, view_.v0 + y) ? Seen::kOther : Seen::kExplained;
  }

  /// An occluder stands off: between the explained side and the covered one the scene steps. Where the difference to
  /// the model grows gently instead, one surface does not follow the model.
  void add_border(int x, int y, int dx, int dy, Sums& sums) const {
    const Seen a = seen_(x, y), b = seen_(x + dx, y + dy);
    if (!((a == Seen::kExplained && b == Seen::kCovered) || (b == Seen::kExplained && a == Seen::kCovered))) return;
    const float before = residual(x - kReach * dx, y - kReach * dy);
    const float after = residual(x + (kReach + 1) * dx, y + (kReach + 1) * dy);
    if (!std::isfinite(before) || !std::isfinite(after)) return;
    const float step = 1.5f * depth_tolerance(scene_, view_.depth(x, y), config_);
    std::abs(after - before) > step ? ++sums.steps : ++sums.smooth;
  }

  Eigen::Vector3f drawn_normal(int x, int y) const {
    const int u = view_.u0 + x, v = view_.v0 + y;
    const Eigen::Vector3f p = scene_.point(u, v, view_.depth(x, y));
    return (scene_.point(u, v + 1, view_.depth(x, y + 1)) - p)
        .cross(scene_.point(u + 1, v, view_.depth(x + 1, y)) - p)
        .normalized();
  }

  void add_patch(int x0, int y0, Sums& sums) const {
    double sum = 0;
    int count = 0;
    float z = 0;
    for (int y = y0; y < std::min(y0 + kPatch, seen_.height()); ++y)
      for (int x = x0; x < std::min(x0 + kPatch, seen_.width()); ++x) {
        if (seen_(x, y) != Seen::kExplained || !inner(x, y)) continue;
        const Eigen::Vector3f n = drawn_normal(x, y);
        const Eigen::Vector3f ray = scene_.point(view_.u0 + x, view_.v0 + y, 1);
        sum += residual(x, y) * std::abs(n.dot(ray));  // distance from the surface, seen along the axis
        z = view_.depth(x, y);
        ++count;
        const Eigen::Vector3f& s = scene_.normals(view_.u0 + x, view_.v0 + y);
        if (s.isZero()) continue;
        sums.turned += 1 - s.dot(n);
        sums.normals += 1;
      }
    if (count < kFewOfPatch) return;
    const double sigma = std::max(kLeastSigma, scene_.noise.sigma(z));
    const double share = std::min(1.0, scene_.correlated_px / count);
    const double mean = sum / count;
    sums.square += mean * mean / (sigma * sigma * (share + kBiasSigmas * kBiasSigmas));
    sums.patches += 1;
  }

  const Scene& scene_;
  const PartView& view_;
  const CheckConfig& config_;
  Image<Seen> seen_;
};

/// The pixel beyond the outline, as far out as the part itself lets it be; false inside of narrow gaps.
bool pixel_beyond(const PartView& view, const OutlinePixel& o, int& beyond, Eigen::Vector2i& out) {
  for (beyond = kBeyond; beyond >= kBeyondInHole; --beyond) {
    out = {static_cast<int>(std::lround(static_cast<float>(o.u) + static_cast<float>(beyond) * o.outward.x())),
           static_cast<int>(std::lround(static_cast<float>(o.v) + static_cast<float>(beyond) * o.outward.y()))};
    if (!view.inside(out.x(), out.y())) return true;
  }
  return false;
}

enum class Rim { kUnknown, kEnds, kGoesOn };

/// Does the scene's own surface, as it lies inside the outline, reach beyond it?
Rim judge_rim(const Scene& scene, const PartView& view, const OutlinePixel& o, const std::vector<std::uint8_t>& taken,
              const CheckConfig& config) {
  int beyond = 0;
  Eigen::Vector2i out;
  if (!pixel_beyond(view, o, beyond, out) || !scene.depth.contains(out.x(), out.y())) return Rim::kUnknown;
  const Eigen::Vector2i in(
      static_cast<int>(std::lround(static_cast<float>(o.u) - static_cast<float>(kInside) * o.outward.x())),
      static_cast<int>(std::lround(static_cast<float>(o.v) - static_cast<float>(kInside) * o.outward.y())));
  if (!view.inside(in.x(), in.y())) return Rim::kUnknown;
  const float inside = scene.depth(in.x(), in.y()), seen = scene.depth(out.x(), out.y());
  const float tolerance = depth_tolerance(scene, o.z, config);
  const Eigen::Vector3f& n = scene.normals(in.x(), in.y());
  if (!(std::abs(inside - view.at(in.x(), in.y())) < 2 * tolerance) || n.isZero() || std::isnan(seen))
    return Rim::kUnknown;
  const float facing = n.dot(scene.point(out.x(), out.y(), 1));
  const float expected = facing < -kLeastFacing ? n.dot(scene.point(in.x(), in.y(), inside)) / facing : 0;
  if (seen < expected - tolerance) return Rim::kUnknown;  // something nearer covers the place
  const bool turns = scene.normals(out.x(), out.y()).dot(n) < kLeastAlike;
  if (seen > expected + tolerance || turns || !scene.wanted(out.x(), out.y())) return Rim::kEnds;
  const auto index = static_cast<std::size_t>(out.y()) * static_cast<std::size_t>(scene.depth.width()) +
                     static_cast<std::size_t>(out.x());
  return taken[index] > 0 ? Rim::kUnknown : Rim::kGoesOn;
}

void judge_outline(const Scene& scene, const PartView& view, const std::vector<std::uint8_t>& taken,
                   const CheckConfig& config, PoseEvidence& e) {
  std::array<double, kSides> on{}, judged{};
  double all_judged = 0, all = 0;
  for (const OutlinePixel& o : outline_of(view)) {
    const double turn = std::atan2(o.outward.y(), o.outward.x()) / (2 * std::numbers::pi) + 1;  // 0.5 .. 1.5
    const int side = static_cast<int>(std::lround(turn * kSides)) % kSides;
    const Rim rim = judge_rim(scene, view, o, taken, config);
    all += 1;
    if (rim == Rim::kUnknown) continue;
    judged[side] += 1, all_judged += 1;
    if (rim == Rim::kGoesOn) on[side] += 1;
  }
  e.judged = all > 0 ? all_judged / all : 0;
  for (int k = 0; k < kSides; ++k) e.leak_side = std::max(e.leak_side, on[k] / (judged[k] + kFewOfSide));
}

}  // namespace

PoseEvidence gather_evidence(const Scene& scene, const SurfaceModel& model, const Pose& X_CP,
                             const std::vector<std::uint8_t>& taken, const CheckConfig& config) {
  PoseEvidence e;
  const PartView view = draw_part(scene.camera, model, X_CP);
  if (view.pixels == 0) return e;
  judge_outline(scene, view, taken, config, e);
  const Evidence pixels(scene, view, config);
  Sums sums;
  pixels.add_borders(sums);
  pixels.add_thin_cover(sums);
  pixels.add_patches(sums);
  e.smooth_cover = sums.smooth / (sums.smooth + sums.steps + 10.0);
  e.thin_cover = static_cast<double>(sums.thin) / view.pixels;
  if (sums.patches > 0) e.residual = std::sqrt(sums.square / sums.patches);
  if (sums.normals > 0) e.turned = sums.turned / sums.normals;
  return e;
}

}  // namespace binpick

#include "perception/pose_evidence.hpp"

#include <algorithm>
#include <cmath>

#include "perception/part_view.hpp"

namespace binpick {
namespace {

constexpr float kHigh = 0.012f;     // m, that an occluder commonly stands off
constexpr float kSteepest = 0.01f;  // m per px, slope that is carried on outside the outline
constexpr float kParallel = 0.9f;   // cosine between the normals of part and cover
constexpr double kFewPixels = 20;   // explained pixels that shares of them are damped by
constexpr int kReach = 2;           // px to either side of a border, over which a step is looked for
constexpr int kPatch = 6;           // px
constexpr int kFewOfPatch = 12;
constexpr double kLeastSigma = 0.0005;  // m, below which residuals say nothing more
constexpr double kBiasSigmas = 0.1;     // of the noise that no averaging within a patch removes

enum class Seen : std::uint8_t { kNothing, kExplained, kCovered, kThrough, kOther };

struct Sums {
  int smooth = 0, steps = 0, explained = 0, through = 0, foreign = 0, parallel = 0;
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

  /// What is seen through, and what covers, among its likes: a pixel beside an edge says little.
  void add_areas(const std::vector<std::uint8_t>& taken, Sums& sums) const {
    for (int y = 1; y < seen_.height() - 1; ++y)
      for (int x = 1; x < seen_.width() - 1; ++x) {
        sums.explained += seen_(x, y) == Seen::kExplained;
        sums.through += among_likes(x, y, Seen::kThrough);
        if (among_likes(x, y, Seen::kCovered) && taken[index(x, y)] == 0) add_cover(x, y, sums);
      }
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
    if (r > tolerance) return Seen::kThrough;
    return scene_.wanted(view_.u0 + x, view_.v0 + y) ? Seen::kExplained : Seen::kOther;
  }

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(view_.v0 + y) * static_cast<std::size_t>(scene_.depth.width()) +
           static_cast<std::size_t>(view_.u0 + x);
  }

  bool among_likes(int x, int y, Seen what) const {
    if (seen_(x, y) != what) return false;
    for (int b = -1; b <= 1; ++b)
      for (int a = -1; a <= 1; ++a)
        if (seen_(x + a, y + b) != what) return false;
    return true;
  }

  void add_cover(int x, int y, Sums& sums) const {
    ++sums.foreign;
    if (residual(x, y) < -kHigh || !inner(x, y)) return;
    const Eigen::Vector3f& s = scene_.normals(view_.u0 + x, view_.v0 + y);
    sums.parallel += !s.isZero() && s.dot(drawn_normal(x, y)) > kParallel;
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

}  // namespace

PoseEvidence gather_evidence(const Scene& scene, const SurfaceModel& model, const Pose& X_CP,
                             const std::vector<std::uint8_t>& taken, const CheckConfig& config) {
  PoseEvidence e;
  const PartView view = draw_part(scene.camera, model, X_CP);
  if (view.pixels == 0) return e;
  e.rims = judge_rims(scene, view, taken, config);
  const Evidence pixels(scene, view, config);
  Sums sums;
  pixels.add_borders(sums);
  pixels.add_areas(taken, sums);
  pixels.add_patches(sums);
  const double explained = sums.explained + kFewPixels;
  e.hollow = sums.through / explained;
  e.smooth_cover = sums.smooth / (sums.smooth + sums.steps + 10.0);
  e.parallel = sums.parallel / explained;
  e.foreign = sums.foreign / explained;
  if (sums.patches > 0) e.residual = std::sqrt(sums.square / sums.patches);
  if (sums.normals > 0) e.turned = sums.turned / sums.normals;
  return e;
}

}  // namespace binpick

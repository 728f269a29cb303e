#include "perception/view_check.hpp"

#include <algorithm>

#include "core/error.hpp"

namespace binpick {
namespace {

constexpr int kBeyond = 5;             // px outside the outline: past fattening and mixed pixels
constexpr float kSteepest = 0.01f;     // m per px, slope that is carried on outside the outline
constexpr double kSettledLead = 0.05;  // of the score: a pose that stood after an earlier search yields to a clear gain

/// A pixel of the drawn part among its neighbours; the crop's border is outside, so that all four exist.
struct Drawn {
  float z, left, right, up, down;
  Drawn(const PartView& view, int x, int y)
      : z(view.depth(x, y)),
        left(view.depth(x - 1, y)),
        right(view.depth(x + 1, y)),
        up(view.depth(x, y - 1)),
        down(view.depth(x, y + 1)) {}
  bool rim() const { return !std::isfinite(left + right + up + down); }
  /// Depth change to the steepest neighbour inside the part.
  float slope() const {
    float steepest = 0;
    for (const float other : {left, right, up, down})
      if (std::isfinite(other)) steepest = std::max(steepest, std::abs(other - z));
    return std::min(steepest, kSteepest);
  }
};

/// The drawn surface's normal away from its rim.
Eigen::Vector3f drawn_normal(const Scene& scene, int u, int v, const Drawn& at) {
  const Eigen::Vector3f p = scene.point(u, v, at.z);
  const Eigen::Vector3f dx = scene.point(u + 1, v, at.right) - p, dy = scene.point(u, v + 1, at.down) - p;
  return dy.cross(dx).normalized();  // x right, y down: towards the camera
}

struct PixelJudge {
  const Scene& scene;
  const CheckConfig& config;
  float least_normal = static_cast<float>(std::cos(config.normal_tolerance));

  void add(int u, int v, const Drawn& at, ViewCheck& out) const {
    const float seen = scene.depth(u, v);
    if (std::isnan(seen)) {
      ++out.unknown;
      return;
    }
    const bool edge = at.rim();
    const float tolerance = depth_tolerance(scene, at.z, config) + (edge ? 2.0f : 0.7f) * at.slope();
    if (seen - at.z > tolerance) {
      edge ? ++out.unknown : ++out.through;  // a rim pixel may see past the part by half a pixel
    } else if (seen - at.z < -tolerance) {
      ++out.covered;
    } else if (!scene.wanted(u, v)) {
      ++out.unknown;
    } else {
      const Eigen::Vector3f& s = scene.normals(u, v);
      if (!edge && !s.isZero() && s.dot(drawn_normal(scene, u, v, at)) < least_normal) {
        ++out.off;
        return;
      }
      ++out.inliers;
      out.explained.push_back(static_cast<std::uint32_t>(v) * static_cast<std::uint32_t>(scene.depth.width()) +
                              static_cast<std::uint32_t>(u));
    }
  }
};

/// Share of the outline just outside of which the scene carries on with the drawn surface.
double leak_of(const Scene& scene, const PartView& view, const CheckConfig& config) {
  int leaks = 0, ends = 0;
  for (const OutlinePixel& o : outline_of(view)) {
    const auto pixel = [&](int k) {
      return Eigen::Vector2i(
          static_cast<int>(std::lround(static_cast<float>(o.u) + static_cast<float>(k) * o.outward.x())),
          static_cast<int>(std::lround(static_cast<float>(o.v) + static_cast<float>(k) * o.outward.y())));
    };
    const Eigen::Vector2i out = pixel(kBeyond), in = pixel(-2);
    if (!scene.depth.contains(out.x(), out.y()) || !view.inside(in.x(), in.y()) || view.inside(out.x(), out.y()))
      continue;
    const float tolerance = depth_tolerance(scene, o.z, config);
    const float here = scene.depth(o.u, o.v);
    if (here < o.z - 2 * tolerance) continue;  // the rim itself is covered
    const float per_px = std::clamp((o.z - view.at(in.x(), in.y())) / 2, -kSteepest, kSteepest);
    const float seen = scene.depth(out.x(), out.y()), expected = o.z + kBeyond * per_px;
    if (seen < expected - tolerance) continue;
    const bool goes_on = seen < expected + tolerance && scene.wanted(out.x(), out.y());
    goes_on ? ++leaks : ++ends;
  }
  return leaks + ends >= 5 ? static_cast<double>(leaks) / (leaks + ends) : 0;
}

}  // namespace

void AcceptConfig::visit(ConfigVisitor& v) {
  v.field("least_quality", least_quality, Unit::kNone, "least inliers / (inliers + contradictions)");
  v.field("sure_quality", sure_quality, Unit::kNone,
          "the same, from which a pose keeps the search away from its place");
  v.field("least_explained", least_explained, Unit::kNone, "least inliers / pixels of the whole silhouette");
  v.field("least_pixels", least_pixels, "least number of inlier pixels");
  v.field("largest_leak", largest_leak, Unit::kNone, "largest share of the outline at which the surface goes on");
  v.field("least_own", least_own, Unit::kNone, "least share of the inliers that no better pose claims");
  v.field("largest_overlap", largest_overlap, Unit::kNone, "largest share of the surface inside a better pose");
  v.field("largest_side_leak", largest_side_leak, Unit::kNone,
          "the same of one side of the outline, where no other pose explains what follows");
  v.field("least_score", least_score, Unit::kNone, "least probability of being right of what is returned");
  v.field("least_presence", least_presence, Unit::kNone,
          "least probability, from all its poses, that a part is in view at all; below, no pose of it is returned");
}

void AcceptConfig::validate() const {
  const auto share = [](double x) { return x >= 0 && x <= 1; };
  if (!share(least_quality) || !share(sure_quality) || !share(least_explained) || !share(largest_leak) ||
      !share(largest_side_leak) || !share(least_own) || !share(largest_overlap) || !share(least_score) ||
      !share(least_presence))
    throw SpecError("accept: every share must lie between 0 and 1");
  if (least_pixels < 1) throw SpecError("accept.least_pixels: must be at least 1");
}

ViewCheck check_view(const Scene& scene, const SurfaceModel& model, const Pose& X_CP, const CheckConfig& config) {
  ViewCheck out;
  const PartView view = draw_part(scene.camera, model, X_CP);
  out.pixels = view.pixels;
  if (view.pixels == 0) return out;
  const PixelJudge judge{scene, config};
  out.explained.reserve(static_cast<std::size_t>(view.pixels));
  for (int y = 1; y < view.depth.height() - 1; ++y)
    for (int x = 1; x < view.depth.width() - 1; ++x)
      if (std::isfinite(view.depth(x, y))) judge.add(view.u0 + x, view.v0 + y, Drawn(view, x, y), out);
  out.leak = leak_of(scene, view, config);
  return out;
}

double overlap(const SurfaceModel& a, const Pose& X_Ca, const SurfaceModel& b, const Pose& X_Cb, float slack) {
  const Eigen::Isometry3f X_ab = (X_Ca.inverse() * X_Cb).cast<float>();
  if ((X_ab * b.center() - a.center()).norm() > a.radius() + b.radius()) return 0;
  const std::size_t step = std::max<std::size_t>(1, b.points().size() / 400);
  int inside = 0, all = 0;
  for (std::size_t i = 0; i < b.points().size(); i += step, ++all) {
    const Eigen::Vector3f p = X_ab * b.points()[i];
    const int k = a.nearest(p);
    inside += k >= 0 && a.normals()[k].dot(p - a.points()[k]) < -slack;
  }
  return static_cast<double>(inside) / all;
}

float overlap_slack(const Scene& scene, const Pose& X_CP) {
  return 0.002f + 2 * scene.sigma(static_cast<float>(X_CP.translation().z()));
}

bool accepted(const ViewCheck& check, const AcceptConfig& config) {
  return check.quality() >= config.least_quality && check.explained_share() >= config.least_explained &&
         check.inliers >= config.least_pixels && check.leak <= config.largest_leak;
}

std::vector<Candidate> resolve_conflicts(std::vector<Candidate> candidates,
                                         const std::vector<const SurfaceModel*>& models, const Scene& scene,
                                         const AcceptConfig& config) {
  const auto rank = [](const Candidate& c) { return c.check.score() + (c.settled ? kSettledLead : 0); };
  std::stable_sort(candidates.begin(), candidates.end(),
                   [&](const Candidate& a, const Candidate& b) { return rank(a) > rank(b); });
  std::vector<char> claimed(scene.depth.size(), 0);
  std::vector<Candidate> standing;
  for (Candidate& c : candidates) {
    int own = 0;
    for (const std::uint32_t i : c.check.explained) own += !claimed[i];
    if (own < config.least_own * c.check.inliers || own < config.least_pixels ||
        own < config.least_explained * c.check.pixels)
      continue;
    const float slack = overlap_slack(scene, c.fit.X_CP);
    c.own = static_cast<double>(own) / std::max(1, c.check.inliers);
    c.overlap = 0;
    for (const Candidate& s : standing)
      c.overlap = std::max(c.overlap, overlap(*models[s.part], s.fit.X_CP, *models[c.part], c.fit.X_CP, slack));
    if (c.overlap > config.largest_overlap) continue;
    for (const std::uint32_t i : c.check.explained) claimed[i] = 1;
    standing.push_back(std::move(c));
  }
  return standing;
}

}  // namespace binpick

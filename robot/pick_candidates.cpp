#include "robot/pick_candidates.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

namespace binpick {
namespace {

constexpr double kScoreWeight = 2, kCoverWeight = 2, kDepthWeight = 1, kSiteWeight = 1, kTiltWeight = 2;
constexpr double kCell = 0.005;  // m, the heap's own grid

/// Turns about the site's normal that are worth trying: all of them when any is as good, else those of the tool itself.
int turns_of(const PickSite& site, int tool_order, int spins) {
  if (site.free_spin) return std::max(1, spins);
  return std::max(1, tool_order);
}

}  // namespace

TargetFinder::TargetFinder(std::span<const Part> parts) : parts_(parts) {
  for (const Part& part : parts) queries_.emplace_back(part.mesh_P);
}

Target TargetFinder::look_at(const PoseEstimate& estimate, const Pose& X_WC, const ObstacleMap& heap,
                             double tolerance) const {
  Target target;
  target.part = estimate.part;
  target.X_WP = X_WC * estimate.X_CP;
  target.score = estimate.score;
  target.own_points.assign(heap.size(), 0);
  const Part& part = parts_[estimate.part];
  const MeshQuery& query = queries_[estimate.part];
  const Pose X_PW = target.X_WP.inverse();
  const Eigen::Vector3d down_P = X_PW.linear() * -Eigen::Vector3d::UnitZ();
  target.top = (target.X_WP * part.box_center_P).z();
  const Eigen::Vector3d center_W = target.X_WP * part.box_center_P;
  std::set<std::pair<long, long>> above;  // cells of the plan view that something else covers
  heap.for_each_in(center_W, Eigen::Vector3d::Constant(part.diameter / 2 + tolerance), [&](std::uint32_t i) {
    const Eigen::Vector3d p_P = X_PW * heap.points_W()[i];
    const auto near = query.closest(p_P, tolerance);
    const auto below = query.ray(p_P, down_P, part.diameter);
    // What lies under the surface that faces up cannot have been seen: noise or a wrong neighbour, but not on top.
    const bool inside = below && below->normal.dot(down_P) > 0;
    target.own_points[i] = near || inside;
    if (!target.own_points[i] && below)
      above.emplace(std::lround(heap.points_W()[i].x() / kCell), std::lround(heap.points_W()[i].y() / kCell));
  });
  const double shadow = surface_area(part.envelope_P) / 4;  // mean shadow of a convex body (Cauchy)
  target.covered = std::min(1.0, static_cast<double>(above.size()) * kCell * kCell / shadow);
  return target;
}

std::vector<Target> TargetFinder::find(const EstimateResult& found, const Pose& X_WC, const ObstacleMap& heap,
                                       double tolerance, double min_score) const {
  std::vector<Target> targets;
  for (std::size_t e = 0; e < found.estimates.size(); ++e) {
    const PoseEstimate& estimate = found.estimates[e];
    if (estimate.score < min_score || estimate.part >= parts_.size() || !is_rigid(estimate.X_CP, 1e-6)) continue;
    targets.push_back(look_at(estimate, X_WC, heap, tolerance));
    targets.back().estimate = e;
  }
  double lowest = 1e9;
  for (const Target& target : targets) lowest = std::min(lowest, target.top);
  for (Target& target : targets) target.top -= lowest;
  return targets;
}

std::vector<PickCandidate> ranked_candidates(const std::vector<Target>& targets, std::span<const PickSites> sites,
                                             int tool_order, const PlanningConfig& config,
                                             std::map<std::string, int>& rejections) {
  double highest = 1e-9;
  for (const Target& target : targets) highest = std::max(highest, target.top);
  std::vector<PickCandidate> out;
  for (std::size_t t = 0; t < targets.size(); ++t) {
    const Target& target = targets[t];
    for (const PickSite& site : sites[target.part].sites) {
      const Eigen::Vector3d z_K = (target.X_WP * site.X_PK).linear().col(2);
      const double tilt = std::acos(std::clamp(z_K.z(), -1.0, 1.0));
      if (tilt > config.max_tool_tilt) {
        ++rejections["tool tilted too far"];
        continue;
      }
      const double cost = kScoreWeight * (1 - target.score) + kCoverWeight * target.covered +
                          kDepthWeight * (1 - target.top / highest) + kSiteWeight * (1 - site.quality) +
                          kTiltWeight * tilt / config.max_tool_tilt;
      const int turns = turns_of(site, tool_order, config.spins);
      for (int k = 0; k < turns; ++k)
        out.push_back({t, site, tip_at_site(target.X_WP, site, 2 * std::numbers::pi * k / turns), cost});
    }
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const PickCandidate& a, const PickCandidate& b) { return a.cost < b.cost; });
  return out;
}

}  // namespace binpick

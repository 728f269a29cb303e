#include "robot/pick_candidates.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

namespace binpick {
namespace {

constexpr double kScoreWeight = 2, kCoverWeight = 4, kDepthWeight = 1, kSiteWeight = 1, kTiltWeight = 2;
constexpr double kLeanWeight = 1, kFailedWeight = 10;
constexpr double kCovered = 0.03;  // a part covered by more than this share comes out with what lies on it, or peels
constexpr double kCell = 0.005;    // m, the heap's own grid

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

Pose leaning(const Pose& X_WG, double lean) {
  const Eigen::Vector3d normal = -X_WG.linear().col(2), axis = normal.cross(Eigen::Vector3d::UnitZ());
  if (lean == 0 || axis.norm() < 1e-9) return X_WG;
  return pose_from(exp_so3(lean * axis.normalized()) * X_WG.linear(), X_WG.translation());
}

double lean_reach(const Gripper& gripper, double lean) {
  double reach = 0;
  for (const CupSpec& cup : gripper.cups())
    reach = std::max(reach, cup.X_GU.translation().head<2>().norm() * std::sin(lean));
  return reach;
}

ToolFreedom tool_freedom(const Gripper& gripper, const PlanningConfig& config) {
  ToolFreedom tool;
  tool.turn_order = turn_order(gripper);
  tool.largest_lean = config.max_lean;
  for (const CupSpec& cup : gripper.cups()) {
    // The lip that touches first is pushed back by twice the reach; a fifth of every limit is kept in hand.
    const double radius = cup.X_GU.translation().head<2>().norm();
    const double travel = 0.8 * cup.stroke - config.press;
    if (radius > 1e-6)
      tool.largest_lean = std::min(tool.largest_lean, std::asin(std::clamp(travel / (2 * radius), 0.0, 1.0)));
    tool.largest_lean = std::min(tool.largest_lean, 0.8 * cup.max_tilt);
  }
  return tool;
}

namespace {

/// Leans that are worth trying for a site whose normal is `tilt` off the vertical: none, half and all that is allowed.
std::vector<double> leans_for(double tilt, double largest) {
  constexpr double kSmall = 0.03;  // rad: less is not worth a candidate
  std::vector<double> leans = {0};
  const double most = std::min(tilt, largest);
  if (most > 2 * kSmall) leans.push_back(most / 2);
  if (most > kSmall) leans.push_back(most);
  return leans;
}

double target_cost(const Target& target, double highest) {
  return kScoreWeight * (1 - target.score) + kCoverWeight * std::min(1.0, target.covered / kCovered) +
         kDepthWeight * (1 - target.top / highest) + (target.failed ? kFailedWeight : 0);
}

/// The twin of X_WP, turned about the part's axis, whose site faces up most; X_WP itself without an axis.
Pose facing_up(const Pose& X_WP, const Symmetry& symmetry, const PickSite& site) {
  if (!symmetry.axis || site.cup < 0) return X_WP;
  const Eigen::Vector3d& d = symmetry.axis->direction_P;
  const Eigen::Vector3d n = site.X_PK.linear().col(2), up_P = X_WP.linear().transpose().col(2);
  const double across = n.dot(up_P) - n.dot(d) * up_P.dot(d), beside = up_P.dot(d.cross(n));
  if (std::hypot(across, beside) < 1e-9) return X_WP;
  const Pose about(Eigen::Translation3d(symmetry.axis->point_P) * Eigen::AngleAxisd(std::atan2(beside, across), d) *
                   Eigen::Translation3d(-symmetry.axis->point_P));
  return X_WP * about;
}

/// Adds every way to take one target at one site; false when the tool would be tilted too far.
bool add_candidates(std::size_t t, const Target& target, const PickSite& site, const CandidateInput& in, double highest,
                    std::vector<PickCandidate>& out) {
  const Pose X_WP = facing_up(target.X_WP, in.parts[target.part].symmetry, site);
  const Eigen::Vector3d z_K = (X_WP * site.X_PK).linear().col(2);
  const double tilt = std::acos(std::clamp(z_K.z(), -1.0, 1.0));
  const double largest = site.cup < 0 ? in.tool.largest_lean : 0;  // a single lip off the axis does not lean
  if (tilt - largest > in.config.max_tool_tilt) return false;
  const int turns = turns_of(site, in.tool.turn_order, in.config.spins);
  for (const double lean : leans_for(tilt, largest)) {
    if (tilt - lean > in.config.max_tool_tilt) continue;
    const double cost = target_cost(target, highest) + kSiteWeight * (1 - site.quality) +
                        kTiltWeight * (tilt - lean) / in.config.max_tool_tilt +
                        (lean > 0 ? kLeanWeight * lean / largest : 0);
    for (int k = 0; k < turns; ++k) {
      const Pose X_WG = leaning(tip_at_site(X_WP, site, 2 * std::numbers::pi * k / turns), lean);
      out.push_back({t, site, X_WP, X_WG, lean, cost});
    }
  }
  return true;
}

}  // namespace

std::vector<PickCandidate> ranked_candidates(const std::vector<Target>& targets, const CandidateInput& in,
                                             std::map<std::string, int>& rejections) {
  double highest = 1e-9;
  for (const Target& target : targets) highest = std::max(highest, target.top);
  std::vector<PickCandidate> out;
  for (std::size_t t = 0; t < targets.size(); ++t)
    for (const PickSite& site : in.sites[targets[t].part].sites)
      if (!add_candidates(t, targets[t], site, in, highest, out)) ++rejections["tool tilted too far"];
  std::stable_sort(out.begin(), out.end(),
                   [](const PickCandidate& a, const PickCandidate& b) { return a.cost < b.cost; });
  return out;
}

}  // namespace binpick

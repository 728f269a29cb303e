#include "robot/plan_pick.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/check.hpp"
#include "core/error.hpp"
#include "robot/look_pose.hpp"
#include "robot/motion_planner.hpp"
#include "robot/one_cup.hpp"
#include "robot/pick_candidates.hpp"
#include "robot/pick_sites.hpp"
#include "robot/tray_slots.hpp"

namespace binpick {
namespace {

constexpr double kOwnTolerance = 0.004;  // m, plus three sigma: a heap point this near an estimate's surface is its own

constexpr double kCare = 0.5;  // share of the acceleration for a part on one cup of several, or taken with a lean

double own_tolerance(const SceneView& view) { return kOwnTolerance + 3 * view.noise().sigma(0.6); }

void mark_failed(std::vector<Target>& targets, std::span<const Part> parts, std::span<const Eigen::Vector3d> failed_W) {
  for (Target& target : targets) {
    const Part& part = parts[target.part];
    for (const Eigen::Vector3d& p_W : failed_W)
      target.failed |= (target.X_WP * part.box_center_P - p_W).norm() < part.diameter / 4;
  }
}

/// Turns of the tool about one site follow one another, and mostly end alike: where some have been blocked on their
/// ways, each a dear thing to find out, only some of the others are tried.
struct SpinsInARow {
  std::size_t target = 0;
  double cost = -1;
  int count = 0, blocked = 0;

  bool worth(const PickCandidate& candidate) {
    constexpr int kBlocked = 6, kEvery = 6;
    if (candidate.target != target || candidate.cost != cost) *this = {candidate.target, candidate.cost, 0, 0};
    return count++ % kEvery == 0 || blocked < kBlocked;
  }
};

std::string summary(const std::map<std::string, int>& rejections) {
  std::vector<std::pair<std::string, int>> sorted(rejections.begin(), rejections.end());
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string text = "no reachable pick";
  for (std::size_t i = 0; i < sorted.size(); ++i)
    text += (i == 0 ? ": " : ", ") + std::to_string(sorted[i].second) + " " + sorted[i].first;
  return text;
}

}  // namespace

void PlanningConfig::visit(ConfigVisitor& v) {
  v.field("approach", approach, Unit::kLength, "straight approach along the tool before the contact");
  v.field("clearance", clearance, Unit::kLength, "least distance of arm and tool from everything but the target");
  v.field("max_tool_tilt", max_tool_tilt, Unit::kAngle, "largest angle between tool axis and vertical");
  v.field("max_lean", max_lean, Unit::kAngle,
          "tool axis off the surface's normal, as far as plungers and lips allow it");
  v.field("spins", spins, "turns about a site's normal that are tried");
  v.field("max_candidates", max_candidates, "candidates that are checked in full");
  v.field("search_checks", search_checks,
          "joint positions that a look may check in search of ways around obstacles; 0: direct ways only");
  v.field("press", press, Unit::kLength, "how far the lips are pressed beyond the believed contact");
  v.field("carry_tilt", carry_tilt, Unit::kAngle,
          "how much further than at pick and at place the tool may tilt on the way to the tray");
  v.field("place_height", place_height, Unit::kLength, "part's lowest point above the tray floor at release");
  v.field("min_score", min_score, Unit::kNone, "estimates with a lower score are not picked");
  v.field("acceleration", acceleration, Unit::kAcceleration,
          "largest acceleration of a held part; added to gravity when a site's hold is checked");
  v.field("safety", safety, Unit::kNone, "load factor of that check");
  v.field("hold_check", hold_check, "false: sites that would peel are tried too, last");
}

void PlanningConfig::validate() const {
  const auto need = [](bool good, const char* message) {
    if (!good) throw SpecError(std::string("planning.") + message);
  };
  need(approach >= 0.005 && approach <= 0.5, "approach: must lie between 5 and 500 mm");
  need(clearance >= 0 && clearance <= 0.05, "clearance: must lie between 0 and 50 mm");
  need(max_tool_tilt > 0 && max_tool_tilt <= 1.57, "max_tool_tilt: must lie between 0 and 90 degrees");
  need(max_lean >= 0 && max_lean <= 0.5, "max_lean: must lie between 0 and 0.5 rad");
  need(spins >= 1 && spins <= 360, "spins: must lie between 1 and 360");
  need(max_candidates >= 1 && max_candidates <= 100000, "max_candidates: must lie between 1 and 100000");
  need(search_checks >= 0 && search_checks <= 10000000, "search_checks: must lie between 0 and 10000000");
  need(press >= 0 && press <= 0.05, "press: must lie between 0 and 50 mm");
  need(carry_tilt >= 0.01 && carry_tilt <= 3.15, "carry_tilt: must lie between 0.01 rad and 180 degrees");
  need(place_height >= 0 && place_height <= 0.2, "place_height: must lie between 0 and 200 mm");
  need(min_score >= 0 && min_score <= 1, "min_score: must lie between 0 and 1");
  need(acceleration >= 0.1 && acceleration <= 100, "acceleration: must lie between 0.1 and 100 m/s^2");
  need(safety >= 1 && safety <= 10, "safety: must lie between 1 and 10");
}

struct PickPlanner::Impl {
  Impl(const Cell& c, std::span<const Part> p, const PlanningConfig& f) : cell(c), parts(p), config(f), finder(p) {
    BP_CHECK(cell.arm && cell.gripper, "the cell is not finished");
    PickSiteConfig site_config;
    site_config.acceleration = config.acceleration;
    site_config.safety = config.safety;
    site_config.press = config.press;
    site_config.keep_weak = !config.hold_check;
    for (const Part& part : parts) {
      sites.push_back(find_pick_sites(part, *cell.gripper, site_config));
      for (const PickSite& site : find_one_cup_sites(part, *cell.gripper, site_config))
        sites.back().sites.push_back(site);
      outlines_P.push_back(outline_of(part.mesh_P));
    }
    tool = tool_freedom(*cell.gripper, config);
  }

  /// A candidate that only free motions stood against, and its entry among the rejected.
  struct Blocked {
    const PickCandidate* candidate;
    std::size_t rejected;
  };
  std::vector<CollisionCheck> checks_for(const std::vector<Target>& targets, const ObstacleMap& heap,
                                         const PickStart& start) const;
  std::optional<PickPlan> try_candidates(const std::vector<Target>& targets, const ObstacleMap& heap,
                                         const PickStart& start, PlanResult& result) const;
  std::optional<PickPlan> search_ways(const std::vector<Target>& targets, const std::vector<Blocked>& blocked,
                                      const std::vector<CollisionCheck>& checks, const PickStart& start,
                                      PlanResult& result) const;
  static PickPlan plan_of(const Target& target, const PickCandidate& candidate, const PlannedMotion& motion);
  PickTask task_of(const PickCandidate& candidate, const Target& target, const PickStart& start) const;

  Cell cell;
  std::span<const Part> parts;
  PlanningConfig config;
  TargetFinder finder;
  std::vector<PickSites> sites;
  std::vector<std::vector<Eigen::Vector3d>> outlines_P;
  ToolFreedom tool;
};

PickTask PickPlanner::Impl::task_of(const PickCandidate& candidate, const Target& target,
                                    const PickStart& start) const {
  PickTask task;
  task.X_WG = candidate.X_WG;
  task.X_WP = candidate.X_WP;
  // Several plungers all hang fully out under a held part, which brings its face square to the tool; a single lip keeps
  // the lean it was pressed on with.
  const bool square = cell.gripper->cups().size() > 1 && candidate.site.cup < 0;
  task.care = square && candidate.lean == 0 ? 1 : cell.gripper->cups().size() > 1 ? kCare : 1;
  task.X_GP = (square ? leaning(candidate.X_WG, -candidate.lean) : candidate.X_WG).inverse() * candidate.X_WP;
  task.press = config.press + lean_reach(*cell.gripper, candidate.lean);
  task.up_P = candidate.site.X_PK.linear().col(2);
  task.outline_P = outlines_P[target.part];
  task.center_P = parts[target.part].mass.center_P;
  const TraySlot slot = tray_slot(cell.tray.inner_size, parts[target.part].diameter, start.placed);
  task.slot_T = slot.center_T;
  task.layer_height = slot.layer * height_along(task.outline_P, candidate.site.X_PK.linear().col(2));
  return task;
}

/// What each target is held against: its own points of the heap do not count.
std::vector<CollisionCheck> PickPlanner::Impl::checks_for(const std::vector<Target>& targets, const ObstacleMap& heap,
                                                          const PickStart& start) const {
  CollisionCheck empty(cell, config.clearance);
  std::vector<Primitive> placed_W;
  for (const PlacedPart& placed : start.in_tray)
    placed_W.push_back(box_in_tray(cell.tray, outlines_P[placed.part], placed.X_WP, config.place_height));
  empty.add_placed(placed_W);
  std::vector<CollisionCheck> checks(targets.size(), empty);
  for (std::size_t t = 0; t < targets.size(); ++t) {
    checks[t].set_heap(&heap);
    checks[t].set_ignored(targets[t].own_points);
  }
  return checks;
}

std::optional<PickPlan> PickPlanner::Impl::try_candidates(const std::vector<Target>& targets, const ObstacleMap& heap,
                                                          const PickStart& start, PlanResult& result) const {
  const std::vector<PickCandidate> candidates =
      ranked_candidates(targets, {parts, sites, tool, config}, result.rejections);
  std::vector<CollisionCheck> checks = checks_for(targets, heap, start);
  const Pose X_GF = cell.gripper->X_FG().inverse();
  // No estimate may use up the whole budget, so that a hopeless first one does not hide a good second one.
  const int share = std::max(24, config.max_candidates / std::max<int>(1, static_cast<int>(targets.size())));
  std::vector<int> used(targets.size(), 0);
  std::vector<Blocked> blocked;
  SpinsInARow spins;
  int checked = 0;
  for (const PickCandidate& candidate : candidates) {
    if (checked >= config.max_candidates) break;
    if (!spins.worth(candidate) || used[candidate.target] >= share) continue;
    const Target& target = targets[candidate.target];
    const CollisionCheck& check = checks[candidate.target];
    // The tool alone at contact is quickly looked at and does not count.
    if (const Obstacle hit = check.tool_hit(candidate.X_WG * X_GF); hit != Obstacle::kNone) {
      result.rejected.push_back({target.estimate, candidate.X_WG, "at contact in collision with " + to_string(hit)});
      continue;
    }
    ++checked;
    ++used[candidate.target];
    Refusal refusal;
    const MotionPlanner planner(cell, config, check, start.q_now.value_or(cell.q_look));
    const auto motion = planner.plan(task_of(candidate, target, start), refusal);
    if (motion) return plan_of(target, candidate, *motion);
    if (refusal.on_the_way) blocked.push_back({&candidate, result.rejected.size()});
    if (refusal.on_the_way) ++spins.blocked;
    result.rejected.push_back({target.estimate, candidate.X_WG, refusal.why});
  }
  return search_ways(targets, blocked, checks, start, result);
}

/// When no candidate can be had by direct motions: ways around what blocked the best of them are searched.
std::optional<PickPlan> PickPlanner::Impl::search_ways(const std::vector<Target>& targets,
                                                       const std::vector<Blocked>& blocked,
                                                       const std::vector<CollisionCheck>& checks,
                                                       const PickStart& start, PlanResult& result) const {
  int checks_left = config.search_checks;
  for (const Blocked& entry : blocked) {
    if (checks_left <= 0) break;
    const PickCandidate& candidate = *entry.candidate;
    const Target& target = targets[candidate.target];
    MotionPlanner planner(cell, config, checks[candidate.target], start.q_now.value_or(cell.q_look));
    planner.search_with(&checks_left);
    Refusal refusal;
    const auto motion = planner.plan(task_of(candidate, target, start), refusal);
    if (motion) {
      result.rejected.erase(result.rejected.begin() + static_cast<std::ptrdiff_t>(entry.rejected));
      return plan_of(target, candidate, *motion);
    }
    result.rejected[entry.rejected].reason += ", no way around found";
  }
  return std::nullopt;
}

PickPlan PickPlanner::Impl::plan_of(const Target& target, const PickCandidate& candidate, const PlannedMotion& motion) {
  return {target.estimate, candidate.site, candidate.X_WG, candidate.X_WP, motion.X_WP_place,
          motion.approach, motion.lift,    motion.place,   motion.back};
}

PickPlanner::PickPlanner(const Cell& cell, std::span<const Part> parts, const PlanningConfig& config)
    : impl_(std::make_unique<Impl>(cell, parts, config)) {}
PickPlanner::~PickPlanner() = default;
PickPlanner::PickPlanner(PickPlanner&&) noexcept = default;
PickPlanner& PickPlanner::operator=(PickPlanner&&) noexcept = default;

PlanResult PickPlanner::plan(const EstimateResult& found, const SceneView& view, const Pose& X_WC,
                             const PickStart& start) const {
  const auto begin = std::chrono::steady_clock::now();
  PlanResult result;
  // The frame was taken at the look pose, where the tool may stand in the picture.
  const ObstacleMap heap = heap_without_robot(impl_->cell, view, X_WC, impl_->cell.q_look);
  std::vector<Target> targets = impl_->finder.find(found, X_WC, heap, own_tolerance(view), impl_->config.min_score);
  mark_failed(targets, impl_->parts, start.failed_W);
  const int low = static_cast<int>(found.estimates.size() - targets.size());
  if (low > 0) result.rejections["score too low"] = low;
  for (const Target& target : targets) {
    const PickSites& sites = impl_->sites[target.part];
    if (sites.sites.empty())
      ++result.rejections["no seal predicted (" + impl_->parts[target.part].name + ": " + sites.why_none + ")"];
  }
  result.plan = impl_->try_candidates(targets, heap, start, result);
  for (const RejectedCandidate& candidate : result.rejected) ++result.rejections[candidate.reason];
  result.outcome = result.plan               ? PickOutcome::kSucceeded
                   : found.estimates.empty() ? PickOutcome::kNoDetection
                                             : PickOutcome::kNoReachablePick;
  if (!result.plan) result.reason = found.estimates.empty() ? "nothing was detected" : summary(result.rejections);
  result.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

PlanResult plan_pick(const EstimateResult& found, const SceneView& view, const Pose& X_WC, const Cell& cell,
                     std::span<const Part> parts, const PlanningConfig& config, int placed) {
  return PickPlanner(cell, parts, config).plan(found, view, X_WC, {placed, {}, {}});
}

}  // namespace binpick

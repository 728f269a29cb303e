// Every way to take an estimated part: estimates x sites x turns about the site, ranked by one stated cost.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/part.hpp"
#include "core/pose_estimate.hpp"
#include "robot/obstacle_map.hpp"
#include "robot/pick_sites.hpp"
#include "robot/plan_pick.hpp"

namespace binpick {

/// One believed part in the world, with what the heap says about it.
struct Target {
  std::size_t estimate = 0;
  std::size_t part = 0;
  Pose X_WP = Pose::Identity();
  double score = 0;
  double top = 0;                ///< m, height of its highest point over the lowest target's
  double covered = 0;            ///< 0..1, share of it that lies under something else
  bool failed = false;           ///< a pick at this place has just failed
  std::vector<char> own_points;  ///< per heap point: belongs to this part
};

struct PickCandidate {
  std::size_t target = 0;
  PickSite site;
  Pose X_WP = Pose::Identity();  ///< the believed part, or its symmetric twin whose site faces up
  Pose X_WG = Pose::Identity();
  double lean = 0;  ///< rad, tool axis off the surface's normal, towards the vertical
  double cost = 0;
};

/// Targets of all estimates with a score of at least `config.min_score`. A heap point belongs to a part when it lies
/// within `tolerance` of its surface, or inside.
class TargetFinder {
 public:
  explicit TargetFinder(std::span<const Part> parts);
  std::vector<Target> find(const EstimateResult& found, const Pose& X_WC, const ObstacleMap& heap, double tolerance,
                           double min_score) const;

 private:
  Target look_at(const PoseEstimate& estimate, const Pose& X_WC, const ObstacleMap& heap, double tolerance) const;
  std::span<const Part> parts_;
  std::vector<MeshQuery> queries_;
};

/// What the tool itself allows, worked out once.
struct ToolFreedom {
  int turn_order = 1;       ///< turns by 2 pi / n leave the cups where they are; 0: any turn
  double largest_lean = 0;  ///< rad: the plungers still bring every lip to a flat surface, and no lip is tilted too far
};
ToolFreedom tool_freedom(const Gripper& gripper, const PlanningConfig& config);

/// The tip turned about the site by `lean`, so that the tool's axis comes nearer to the vertical; negative undoes it.
Pose leaning(const Pose& X_WG, double lean);

/// How far beyond the tip's contact the tool must go on until its last lip touches a flat surface, leaning by `lean`.
double lean_reach(const Gripper& gripper, double lean);

/// cost = 2 (1 - score) + 4 (a part that lies under others: from a covered share of 3 %) + 1 (depth below the highest
///        target / largest depth) + 1 (1 - site quality) + 2 (tilt / largest tilt) + 1 (lean / largest lean)
///        + 10 where a pick has just failed; spins of a site follow one another, the first without any turn.
/// Candidates that a look at the tool's axis rules out are counted in `rejections`.
struct CandidateInput {
  std::span<const Part> parts;
  std::span<const PickSites> sites;  ///< per part
  const ToolFreedom& tool;
  const PlanningConfig& config;
};
std::vector<PickCandidate> ranked_candidates(const std::vector<Target>& targets, const CandidateInput& in,
                                             std::map<std::string, int>& rejections);

}  // namespace binpick

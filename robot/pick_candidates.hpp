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
  std::vector<char> own_points;  ///< per heap point: belongs to this part
};

struct PickCandidate {
  std::size_t target = 0;
  PickSite site;
  Pose X_WG = Pose::Identity();
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

/// cost = 2 (1 - score) + 2 covered + 1 (depth below the highest target / largest depth) + 1 (1 - site quality)
///        + 2 (tilt / largest tilt); spins of a site follow one another, the first without any turn.
/// Candidates that a look at the tool's axis rules out are counted in `rejections`.
std::vector<PickCandidate> ranked_candidates(const std::vector<Target>& targets, std::span<const PickSites> sites,
                                             int tool_order, const PlanningConfig& config,
                                             std::map<std::string, int>& rejections);

}  // namespace binpick

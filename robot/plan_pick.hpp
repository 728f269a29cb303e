// From estimates to a timed pick: the first candidate (estimate x site x spin, ranked) that survives every test, with
// the reasons against the others. Uses the perceived scene only; truth never reaches this file.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>

#include "core/pick_outcome.hpp"
#include "core/pose_estimate.hpp"
#include "robot/cell.hpp"

namespace binpick {

struct PlanningConfig {
  double approach = 0.10;      ///< m, straight approach and retreat along the tool, from above the contact
  double clearance = 0.003;    ///< m, least distance of arm and tool from bin and perceived heap
  double max_tool_tilt = 0.9;  ///< rad, between tool axis and vertical
  int spins = 12;              ///< turns about the site's normal that are tried
  int max_candidates = 400;    ///< candidates that are checked in full
  double press = 0.002;        ///< m, how far the lips are pressed beyond the believed contact
  double place_height = 0.01;  ///< m, part's lowest point above the tray floor when it is released
  double min_score = 0.0;      ///< estimates below are not picked
  void visit(ConfigVisitor& v);
  void validate() const;
};

struct PickPlan {
  std::size_t estimate = 0;
  PickSite site;
  Pose X_WG = Pose::Identity();        ///< tip at believed contact
  Pose X_WP_est = Pose::Identity();    ///< believed part pose
  Pose X_WP_place = Pose::Identity();  ///< where the part shall be when released
  JointTrajectory approach;            ///< from the look pose to pressed contact
  JointTrajectory lift;                ///< straight up out of the bin
  JointTrajectory place;               ///< to the tray, to release height
  JointTrajectory back;                ///< to the look pose
};

struct PlanResult {
  std::optional<PickPlan> plan;
  PickOutcome outcome = PickOutcome::kNoReachablePick;  ///< when there is no plan
  std::string reason;
  std::map<std::string, int> rejections;  ///< reason -> count
  double wall = 0;
};

/// `parts` are those of the estimator. `placed` counts parts already in the tray (chooses the slot).
PlanResult plan_pick(const EstimateResult& found, const SceneView& view, const Pose& X_WC, const Cell& cell,
                     std::span<const Part> parts, const PlanningConfig& config, int placed);

}  // namespace binpick

// From estimates to a timed pick: the first candidate (estimate x site x spin, ranked) that survives every test, with
// the reasons against the others. Uses the perceived scene only; truth never reaches this file.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/pick_outcome.hpp"
#include "core/pose_estimate.hpp"
#include "robot/cell.hpp"

namespace binpick {

struct PlanningConfig {
  double approach = 0.10;      ///< m, straight approach along the tool, before the contact
  double clearance = 0.002;    ///< m, least distance of arm and tool from bin, table, tray and perceived heap
  double max_lean = 0.17;      ///< rad, tool axis off the surface's normal, as far as plungers and lips allow it
  double max_tool_tilt = 1.1;  ///< rad, between tool axis and vertical
  int spins = 36;              ///< turns about the site's normal that are tried
  int max_candidates = 400;    ///< candidates whose motions are planned; the tool alone at contact is checked for all
  int search_checks = 20000;   ///< joint positions that a look may check while it searches ways around obstacles
  double press = 0.004;        ///< m, how far the lips are pressed beyond the believed contact: twice the paper's
                               ///< mean height error of 2 mm, so that a part believed too high is still touched
  double carry_tilt = 0.17;  ///< rad, how much further than at pick and place the tool may tilt on the way to the tray
  double place_height = 0.01;  ///< m, part's lowest point above the tray floor when it is released
  double min_score = 0.0;      ///< estimates below are not picked
  double acceleration = 3;  ///< m/s^2 of a held part, and added to gravity when a hold is checked (physical_models B1)
  double safety = 1.5;      ///< load factor of that check
  bool hold_check = true;   ///< false: sites that would peel are tried too, last
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
  JointTrajectory lift;                ///< out of the bin: straight up, a leaning part first off along its normal
  JointTrajectory place;               ///< to the tray, to release height
  JointTrajectory back;                ///< to the look pose
};

/// One way to take a part that was tried and given up.
struct RejectedCandidate {
  std::size_t estimate = 0;
  Pose X_WG = Pose::Identity();  ///< tip at believed contact
  std::string reason;
};

struct PlanResult {
  std::optional<PickPlan> plan;
  PickOutcome outcome = PickOutcome::kNoReachablePick;  ///< when there is no plan
  std::string reason;                     ///< "no reachable pick: 34 at contact in collision with the bin, .."
  std::map<std::string, int> rejections;  ///< reason -> count
  std::vector<RejectedCandidate>
      rejected;     ///< in the order tried; those that the tool's tilt alone rules out have no entry
  double wall = 0;  ///< s, decides nothing
};

/// A part that lies in the tray, as the robot believes: where it let go of it.
struct PlacedPart {
  std::size_t part = 0;
  Pose X_WP = Pose::Identity();
};

/// What a plan starts from, beside what was seen.
struct PickStart {
  int placed = 0;                             ///< parts already in the tray: chooses the slot
  std::span<const Eigen::Vector3d> failed_W;  ///< middles of believed parts at which a pick has just failed: come last
  std::optional<Vector6d> q_now;              ///< where the arm stands, reached straight from the look pose; else there
  std::span<const PlacedPart> in_tray = {};   ///< obstacles
};

/// Holds what depends on cell, parts and config alone (pick sites, prepared meshes); one per worker serves any number
/// of picks. Keeps references to `cell` and `parts`.
class PickPlanner {
 public:
  PickPlanner(const Cell& cell, std::span<const Part> parts, const PlanningConfig& config);
  ~PickPlanner();
  PickPlanner(PickPlanner&&) noexcept;
  PickPlanner& operator=(PickPlanner&&) noexcept;

  PlanResult plan(const EstimateResult& found, const SceneView& view, const Pose& X_WC, const PickStart& start) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The same for a single pick: finds the pick sites anew, so it is slower by some 0.1 s for each part.
PlanResult plan_pick(const EstimateResult& found, const SceneView& view, const Pose& X_WC, const Cell& cell,
                     std::span<const Part> parts, const PlanningConfig& config, int placed);

}  // namespace binpick

// From a candidate to timed motions: look pose -> above -> contact, straight up out of the bin, to the tray, back.
// Every sample of every path is held against limits and obstacles; the first test that fails names the reason.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "robot/cell.hpp"
#include "robot/collision_check.hpp"
#include "robot/plan_pick.hpp"

namespace binpick {

/// What shall be taken and put where.
struct PickTask {
  Pose X_WG = Pose::Identity();                        ///< tip at believed contact
  Pose X_WP = Pose::Identity();                        ///< believed part
  Pose X_GP = Pose::Identity();                        ///< the part as it hangs on the tool
  std::vector<Eigen::Vector3d> outline_P;              ///< vertices that bound the part
  Eigen::Vector3d center_P = Eigen::Vector3d::Zero();  ///< mass centre
  Eigen::Vector2d slot_T = Eigen::Vector2d::Zero();    ///< centre of its place in the tray
  double care = 1;                                     ///< share of the configured acceleration of the held part
  double press = 0;                                    ///< m, how far the tip goes on along the tool
  Eigen::Vector3d up_P = Eigen::Vector3d::UnitZ();     ///< what faces up in the tray
  double layer_height = 0;                             ///< m above the tray's floor: top of what lies below
};

struct PlannedMotion {
  JointTrajectory approach, lift, place, back;
  Pose X_WP_place = Pose::Identity();
};

class MotionPlanner {
 public:
  /// `check` already knows the heap; the tool at contact has been looked at. `q_now`: where the arm stands, come
  /// straight from the look pose.
  MotionPlanner(const Cell& cell, const PlanningConfig& config, const CollisionCheck& check, const Vector6d& q_now);

  /// Empty when no way is found; `why` then says what stood in it.
  std::optional<PlannedMotion> plan(const PickTask& task, std::string& why) const;

 private:
  struct Place {
    Pose X_WG, X_WP;
    double over = 0;  ///< m, how far above the release the part clears tray and neighbours
  };
  struct WayToPlace {
    Place place;
    double over = 0;  ///< m, height of q_over above the release
    Vector6d q_over;
    double time = 0;  ///< s, estimated
  };
  bool plan_approach(const PickTask& task, double approach, PlannedMotion& out, std::string& why) const;
  bool approach_from(const std::vector<Pose>& tips, const Vector6d& q_start, PlannedMotion& out,
                     std::string& why) const;
  Obstacle way_to(const Vector6d& q_start, JointTrajectory& way) const;
  bool plan_lift(const PickTask& task, PlannedMotion& out, std::string& why) const;
  bool plan_place(const PickTask& task, PlannedMotion& out, std::string& why) const;
  std::vector<WayToPlace> ways_to_place(const PickTask& task, const Vector6d& q_lifted) const;
  Obstacle carried_hit(const PickTask& task, const JointTrajectory& carry) const;
  bool place_by(const PickTask& task, const WayToPlace& way, const JointTrajectory& carry, PlannedMotion& out,
                std::string& why) const;
  Place place_at(const PickTask& task, double yaw) const;
  std::vector<Vector6d> joints_for(const Pose& X_WG, const Vector6d& q_near) const;
  Pose flange_in_base(const Pose& X_WG) const;
  JointTrajectory straight(const Vector6d& q_from, const Pose& X_WG_to) const;
  JointTrajectory slowed(const PickTask& task, const JointTrajectory& path) const;
  double rim() const;

  const Cell& cell_;
  const PlanningConfig& config_;
  const CollisionCheck& check_;
  Pose X_GF_;
  Vector6d q_now_;
};

}  // namespace binpick

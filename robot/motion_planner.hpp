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

/// Why a candidate was given up.
struct Refusal {
  std::string why;
  bool on_the_way = false;  ///< a free motion was blocked: a search might find another way
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

  /// From now on ways around obstacles are searched where the direct ones are blocked, while `checks_left` lasts.
  void search_with(int* checks_left) { checks_left_ = checks_left; }

  /// Empty when no way is found; `refusal` then says what stood in it.
  std::optional<PlannedMotion> plan(const PickTask& task, Refusal& refusal) const;

 private:
  static constexpr double kOverRim = 0.020;   ///< m, everything that crosses the bin's rim clears it by this
  static constexpr double kCarryGap = 0.010;  ///< m, between a carried part and bin, tray, table
  static Pose raised(const Pose& X, double height);
  static std::string in_the_way(Obstacle obstacle, const char* where);

  struct Place {
    Pose X_WG, X_WP;
    double over = 0;  ///< m, how far above the release the part clears tray and neighbours
  };
  struct WayToPlace {
    Place place;
    double over = 0;  ///< m, height of q_over above the release
    Vector6d q_over;
    double time = 0;                   ///< s, estimated
    std::optional<Vector6d> via = {};  ///< the joint motion turns here; none: straight to q_over
  };
  bool plan_approach(const PickTask& task, double approach, PlannedMotion& out, Refusal& refusal) const;
  bool approach_from(const std::vector<Pose>& tips, const Vector6d& q_start, PlannedMotion& out,
                     Refusal& refusal) const;
  Obstacle way_to(const Vector6d& q_start, JointTrajectory& way) const;
  bool plan_lift(const PickTask& task, PlannedMotion& out, std::string& why) const;
  bool plan_place(const PickTask& task, PlannedMotion& out, Refusal& refusal) const;
  bool search_place(const PickTask& task, const std::vector<WayToPlace>& ways, PlannedMotion& out) const;
  /// A way found by a search; `held`: with this part, the tool upright.
  std::optional<JointTrajectory> around(const Vector6d& q_from, const Vector6d& q_to, const PickTask* held) const;
  bool way_is_free(const JointTrajectory& path, const PickTask* held) const;
  std::optional<Vector6d> uprighted(const Vector6d& q, double tilt) const;
  double tilt_bound(const Vector6d& q_from, const Vector6d& q_to) const;
  std::vector<WayToPlace> ways_to_place(const PickTask& task, const Vector6d& q_lifted) const;
  JointTrajectory carry_by(const Vector6d& q_lifted, const WayToPlace& way) const;
  std::string carry_fault(const PickTask& task, const JointTrajectory& carry) const;
  std::optional<WayToPlace> over_the_edge(const PickTask& task, const WayToPlace& way,
                                          const JointTrajectory& carry) const;
  Obstacle carried_hit(const PickTask& task, const Vector6d& q) const;
  Obstacle carried_hit(const PickTask& task, const JointTrajectory& carry) const;
  bool place_by(const PickTask& task, const WayToPlace& way, const JointTrajectory& carry, PlannedMotion& out,
                Refusal& refusal) const;
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
  int* checks_left_ = nullptr;
};

}  // namespace binpick

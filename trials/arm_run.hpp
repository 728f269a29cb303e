// The arm on its way through the physics world: steps arm and world together along a path, watches for collisions and
// for the hold, keeps time and the largest force.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/pick_outcome.hpp"
#include "trials/cell_world.hpp"
#include "trials/pick_execution.hpp"

namespace binpick {

class ArmRun {
 public:
  enum class Watch { kNothing, kCollisions, kHold };
  struct Blocked {
    PickOutcome outcome;
    std::string reason;
  };

  ArmRun(CellWorld& cell_world, const ExecutionConfig& config) : cell_(cell_world), config_(config) {}

  /// Runs a path. Stops early (false) when what is watched happens; kHold watches for collisions too.
  bool follow(const JointTrajectory& path, Watch watch);
  /// What follow() had left over, without watching.
  void finish(const JointTrajectory& path);
  /// Back along what follow() travelled of a path, to where it began.
  void retreat(const JointTrajectory& path);
  /// Stands still; the time goes to vacuum_time when `vacuum`, else to motion_time.
  void wait(double duration, bool vacuum);

  /// Set when follow() ended by a collision.
  const std::optional<Blocked>& blocked() const { return blocked_; }
  double motion_time() const { return motion_time_; }
  double vacuum_time() const { return vacuum_time_; }
  double peak_force() const { return peak_force_; }
  /// From this call on, while `body` is held: its largest turn against the tool, the largest share of a cup's limits
  /// that the load takes, what it pushes on, and how far the other parts rise.
  void watch_held(BodyId body);
  double swing() const { return swing_; }
  double hold_use() const { return hold_use_; }
  /// Largest contact of arm, tool or held part with heap, bin, tray or table, and the deepest.
  const CellWorld::Touch& contacts() const { return contacts_; }
  /// What arm, tool and lips met of bin, tray and table in every step so far, watched or not: how often each contact
  /// began, and the deepest of arm and tool (m).
  const std::map<std::string, int>& collisions() const { return collisions_; }
  double collision_depth() const { return collision_depth_; }
  /// m, how far part i of the heap rose at most.
  double rise(std::size_t i) const { return rise_.empty() ? 0 : rise_[i]; }

 private:
  void step(const Vector6d& q);
  bool collides();
  void step_held();
  void touch_held();
  void log_collisions();
  Eigen::Matrix3d turn_of_held() const;

  CellWorld& cell_;
  const ExecutionConfig& config_;
  std::optional<Blocked> blocked_;
  double motion_time_ = 0, vacuum_time_ = 0, peak_force_ = 0, swing_ = 0, hold_use_ = 0;
  double pushed_for_ = 0;  ///< s, the held part harder than the protective force
  CellWorld::Touch contacts_;
  std::map<std::string, int> collisions_;
  std::map<std::string, double> in_contact_;  ///< in the last step
  double collision_depth_ = 0;
  std::vector<double> start_heights_, rise_;
  double reached_ = 0;  ///< s along the last path
  BodyId held_ = -1;
  Eigen::Matrix3d R_GP_start_ = Eigen::Matrix3d::Identity();
};

}  // namespace binpick

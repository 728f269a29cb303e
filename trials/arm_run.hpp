// The arm on its way through the physics world: steps arm and world together along a path, watches for collisions and
// for the hold, keeps time and the largest force.
#pragma once

#include <optional>
#include <string>

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
  /// Largest turn of `body` against the tool since this call, while it is held.
  void watch_swing(BodyId body);
  double swing() const { return swing_; }

 private:
  void step(const Vector6d& q);
  bool collides();
  Eigen::Matrix3d turn_of_held() const;

  CellWorld& cell_;
  const ExecutionConfig& config_;
  std::optional<Blocked> blocked_;
  double motion_time_ = 0, vacuum_time_ = 0, peak_force_ = 0, swing_ = 0;
  double reached_ = 0;  ///< s along the last path
  BodyId held_ = -1;
  Eigen::Matrix3d R_GP_start_ = Eigen::Matrix3d::Identity();
};

}  // namespace binpick

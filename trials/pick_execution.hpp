// Executes a plan in the physics world: steps world and arm together, asks the gripper whether the TRUE contact seals, holds
// the part by springs whose reaction is held against the limits x p(t), carries it to the tray and lets go.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "core/config.hpp"
#include "core/pick_outcome.hpp"
#include "robot/plan_pick.hpp"
#include "trials/cell_world.hpp"

namespace binpick {

struct ExecutionConfig {
  double step = 1.0 / 500;            ///< s, fixed while the arm moves
  double protective_force = 80;       ///< N, arm or tool against anything but the lips: PathBlocked beyond
  double break_time = 0.010;          ///< s, limits must be exceeded this long
  double vacuum_share = 0.8;          ///< lift starts at this share of the full vacuum
  double vacuum_timeout = 0.5;        ///< s
  double settle_time = 1.0;           ///< s after release, until the part must rest in the tray
  void visit(ConfigVisitor& v);
  void validate() const;
};

struct ExecutionResult {
  PickOutcome outcome = PickOutcome::kSucceeded;
  std::string reason;
  double motion_time = 0;              ///< s simulated
  double vacuum_time = 0;              ///< s simulated
  std::optional<std::size_t> lifted;   ///< heap index
  std::optional<double> place_error;   ///< m
  std::optional<double> place_rotation;///< rad
  double swing = 0;                    ///< rad
  double peak_force = 0;               ///< N
  int neighbours_moved = 0;
};

/// Called once when the cups hold the part before the lift, and once at release: for pictures.
using ExecutionHook = std::function<void(const char* moment, const CellWorld& cell)>;

ExecutionResult execute_pick(CellWorld& cell_world, const PickPlan& plan, const ExecutionConfig& config,
                             const ExecutionHook& hook = {});

}  // namespace binpick

// Executes a plan in the physics world: steps world and arm together, asks the gripper whether the TRUE contact seals,
// holds the part by couplings whose reaction is held against the limits x p(t), carries it to the tray and lets go.
//
// Outcomes: PathBlocked (arm or tool reached into bin, tray or table), ProtectiveStop (arm, tool, held part or a
// plunger at its end pushed harder than `protective_force`), NoSeal, PulledOff and Slipped (lost during the lift: pull
// or peel; shear or twist), DroppedInBin and LostInTransit (lost later: back in the bin; anywhere else), DoublePick
// (another part came out with it), WrongPlace (released, but not at rest in the tray), Succeeded. After every outcome
// the arm stands at the end of plan.back, the cups are free and the heap is at rest.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>

#include "core/config.hpp"
#include "core/pick_outcome.hpp"
#include "robot/plan_pick.hpp"
#include "trials/cell_world.hpp"

namespace binpick {

struct ExecutionConfig {
  double step = 1.0 / 500;       ///< s, fixed while the arm moves
  double protective_force = 80;  ///< N, by arm, tool, held part or a plunger at its end: ProtectiveStop beyond
  double break_time = 0.010;     ///< s, limits must be exceeded this long
  double vacuum_share = 0.8;     ///< lift starts at this share of the full vacuum
  double vacuum_timeout = 0.5;   ///< s
  double settle_time = 1.0;      ///< s after release, until the part must rest in the tray
  bool ideal_seal = false;       ///< scenario's `oracles: {seal: true}`
  void visit(ConfigVisitor& v);
  void validate() const;
};

struct ExecutionResult {
  PickOutcome outcome = PickOutcome::kSucceeded;
  std::string reason;
  double motion_time = 0;                ///< s simulated, waiting for rest included
  double vacuum_time = 0;                ///< s simulated, contact, build-up and venting
  std::optional<std::size_t> lifted;     ///< heap index of the part that was held
  std::optional<double> place_error;     ///< m, horizontal distance of the part's box centre from the plan's, at rest
  std::optional<double> place_rotation;  ///< rad, from the plan's orientation to the nearest equivalent one, at rest
  double hold_use = 0;  ///< largest share of a cup's limits that the load took; above 1 for less than break_time: held
  double contact_force = 0;  ///< N, largest by arm, tool or held part on heap, bin, tray or table
  double contact_depth = 0;  ///< m, deepest of those contacts
  std::string contact;       ///< what pushed on what, at the largest force; else what reached into what
  /// Contacts of arm, tool and lips with bin, tray and table, by name ("tool in the bin", "lip on the table"): how
  /// often each began, in every step of the arm; and the deepest of arm and tool (m).
  std::map<std::string, int> collisions;
  double collision_depth = 0;
  int neighbours_dragged = 0;  ///< other parts in the bin that rose more than 10 mm with the held one
  int parts_dropped_back = 0;  ///< of those, the ones that lie in the bin afterwards
  int parts_lost = 0;          ///< other parts of the bin that lie neither there nor in the tray afterwards
  double swing = 0;            ///< rad, largest turn of the held part against the tool
  double peak_force = 0;       ///< N, largest on one cup or on arm and tool
  int neighbours_moved = 0;    ///< other parts in the bin whose box centre moved more than 5 mm
};

/// Called when the cups hold the part before the lift ("held"), when it is out of the bin ("lifted") and at release
/// ("released"): for pictures.
using ExecutionHook = std::function<void(const char* moment, const CellWorld& cell)>;

ExecutionResult execute_pick(CellWorld& cell_world, const PickPlan& plan, const ExecutionConfig& config,
                             const ExecutionHook& hook = {});

}  // namespace binpick

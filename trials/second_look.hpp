// A second look before a pick: when nothing can be picked by the first one, when the fit of the part to be picked is
// poor, or when a pick of it has failed, the arm takes its camera near the part or to a side of it
// (robot/look_pose), and the frames of both looks are fused (the paper's section 6 looks again from 300 mm above).
#pragma once

#include <optional>
#include <span>
#include <string>

#include "evaluation/trial_record.hpp"
#include "trials/sight.hpp"

namespace binpick {

/// The pick that a look belongs to.
struct LookRun {
  const Scenario& s;
  CellWorld& cell_world;
  TrialContext& context;
  Seed seed;  ///< of the trial
  int pick = 0;
  PickStart start;
  std::span<const Eigen::Vector3d> failed_W;  ///< middles of believed parts at which picks have failed
};

/// Why the arm should look again, one phrase; empty: it need not.
std::string why_look_again(const SecondLookConfig& config, const Sight& first, const Cell& cell,
                           std::span<const Part> parts, std::span<const Eigen::Vector3d> failed_W);

/// From where: around the part that would be picked, or else the first that was tried, the best estimate, or the
/// highest of what was seen; empty when nothing was.
std::optional<LookRequest> look_request(const Scenario& s, const Sight& first, std::span<const Part> parts,
                                        const ObstacleMap& heap);

/// Moves the arm and looks again if there is reason to; `sight` is then what both looks led to. True when the arm
/// stands elsewhere than at the look pose afterwards. The record says why, and what it cost; a look that is not
/// possible changes nothing but that.
bool look_again(const LookRun& run, Sight& sight, PickRecord& record);

/// Back to the look pose when nothing was picked from where the second look was taken.
void return_home(const LookRun& run, PickRecord& record);

/// Adds the contacts of one motion to those of the pick.
void add_collisions(const std::map<std::string, int>& collisions, double depth, PickRecord& record);

}  // namespace binpick

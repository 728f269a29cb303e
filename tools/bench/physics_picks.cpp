#include "tools/bench/physics_picks.hpp"

#include "tools/bench/cpu_clock.hpp"
#include "tools/bench/truth_picks.hpp"

namespace binpick {
namespace {

int parts_in_bin(const CellWorld& cell_world) {
  int count = 0;
  for (std::size_t i = 0; i < cell_world.heap().bodies.size(); ++i) count += cell_world.in_bin(i) ? 1 : 0;
  return count;
}

}  // namespace

std::vector<PickCost> bench_picks(const PicksBenchConfig& config) {
  Scenario scenario = truth_scenario(config.scene);
  scenario.physics.freeze_far = config.freeze_far;
  TrialContext context = make_trial_context(scenario);
  std::vector<PickCost> costs;
  for (std::uint64_t seed = config.first_seed; seed < config.last_seed; ++seed)
    pick_on_truth(scenario, context, seed, config.picks, [&](const TruthPick& look) {
      if (!look.plan.plan) return look.plan.outcome;
      PickCost& cost = costs.emplace_back();
      cost.seed = seed;
      cost.pick = look.pick;
      cost.left_in_bin = parts_in_bin(look.cell_world);
      const CpuClock clock;
      const ExecutionResult result = execute_pick(look.cell_world, *look.plan.plan, scenario.execution);
      cost.cpu = clock.seconds();
      cost.outcome = to_string(result.outcome);
      cost.reason = result.reason;
      cost.simulated = result.motion_time + result.vacuum_time;
      cost.neighbours_moved = result.neighbours_moved;
      cost.peak_force = result.peak_force;
      cost.swing = result.swing;
      return result.outcome;
    });
  return costs;
}

}  // namespace binpick

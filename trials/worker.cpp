#include "trials/worker.hpp"

#include <istream>
#include <memory>
#include <nlohmann/json.hpp>
#include <ostream>

#include "trials/trial.hpp"

namespace binpick {

void run_worker(const WorkerOptions& options, std::istream& seeds, std::ostream& records) {
  Scenario scenario = read_scenario(options.scene, options.overrides);
  TrialContext context = make_trial_context(scenario);
  const nlohmann::ordered_json ready = {
      {"ready", true}, {"scenario_hash", context.hash}, {"renderer", context.renderer->description()}};
  records << ready.dump() << std::endl;
  for (std::uint64_t number = 0; seeds >> number;) {
    std::unique_ptr<TrialPictures> pictures;
    if (!options.artifacts.empty())
      pictures =
          std::make_unique<TrialPictures>(options.artifacts + "/seed-" + std::to_string(number), options.pictured);
    records << to_json_line(run_trial(scenario, Seed{number}, context, pictures.get())) << std::endl;
  }
}

}  // namespace binpick

#include "trials/worker.hpp"

#include <istream>
#include <memory>
#include <nlohmann/json.hpp>
#include <ostream>
#include <sstream>

#include "core/error.hpp"
#include "trials/environment.hpp"
#include "trials/planted_fault.hpp"
#include "trials/replay_files.hpp"
#include "trials/trial.hpp"

namespace binpick {

namespace {

struct Order {
  std::uint64_t seed = 0;
  int attempt = 1;
};

bool read_order(std::istream& in, Order& order) {
  std::string line;
  if (!std::getline(in, line)) return false;
  order = Order();
  std::istringstream words(line);
  words >> order.seed;
  if (!words) throw SpecError("worker: '" + line + "' is no seed");
  words >> order.attempt;
  return true;
}

}  // namespace

void run_worker(const WorkerOptions& options, std::istream& orders, std::ostream& records) {
  Scenario scenario = read_scenario(options.scene, options.overrides);
  TrialContext context = make_trial_context(scenario);
  const std::string build = build_id();
  const nlohmann::ordered_json ready = {
      {"ready", true}, {"scenario_hash", context.hash}, {"renderer", context.renderer->description()}};
  records << ready.dump() << std::endl;
  for (Order order; read_order(orders, order);) {
    commit_planted_fault(options.plant, order.seed, order.attempt);
    std::unique_ptr<TrialPictures> pictures;
    if (!options.artifacts.empty())
      pictures =
          std::make_unique<TrialPictures>(options.artifacts + "/seed-" + std::to_string(order.seed), options.pictured);
    std::unique_ptr<ReplayRecorder> recorder;
    if (!options.artifacts.empty()) recorder = std::make_unique<ReplayRecorder>();
    TrialRecord record = run_trial(scenario, Seed{order.seed}, context, pictures.get(), recorder.get());
    record.build = build;
    if (recorder && !failure_of(record)) keep_replay(recorder->finish(record), options.artifacts);
    records << to_json_line(record) << std::endl;
  }
}

}  // namespace binpick

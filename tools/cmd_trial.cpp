// binpick trial SCENE --seed N [--out DIR]: one trial; its record goes to standard output. Replays any record line.

#include <iostream>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "tools/commands.hpp"
#include "trials/trial.hpp"

namespace binpick {
namespace {

struct Options {
  std::string scene, out, sensor;
  std::uint64_t seed = 0;
};

int run(const Options& options) {
  Scenario scenario = read_scenario(options.scene, {options.sensor});
  TrialContext context = make_trial_context(scenario);
  std::unique_ptr<TrialPictures> pictures;
  if (!options.out.empty()) {
    make_folder(options.out);
    pictures = std::make_unique<TrialPictures>(options.out + "/artifacts/seed-" + std::to_string(options.seed),
                                               scenario.trial.max_picks);
    write_file(options.out + "/scenario.yaml", expanded_yaml(scenario, options.out));
  }
  const TrialRecord record = run_trial(scenario, Seed{options.seed}, context, pictures.get());
  const std::string line = to_json_line(record) + "\n";
  if (pictures) {
    make_folder(options.out + "/records");
    write_file(options.out + "/records/seed-" + std::to_string(options.seed) + ".jsonl", line);
  }
  std::cout << line << std::flush;
  if (!std::cout) throw StorageError("standard output: cannot write");
  for (std::size_t k = 0; k < record.picks.size(); ++k)
    if (record.picks[k].outcome == PickOutcome::kNoReachablePick)
      std::cerr << "pick " << k << ": " << record.picks[k].reason << '\n';
  std::cerr << "placed " << record.placed << " of " << record.dropped << " in " << record.picks.size() << " picks"
            << std::endl;
  return record.error.empty() ? 0 : 5;
}

}  // namespace

void add_sensor_option(CLI::App& command, std::string& sensor) {
  command.add_option("--sensor", sensor, "NAME or NAME:PRESET, in place of the scene's sensor and intrinsics");
}

Action add_trial(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("trial", "one trial: drop, see, estimate, pick, score; replays any record");
  command->add_option("scene", options->scene, "scene file (YAML)")->required();
  command->add_option("--seed", options->seed, "seed of the trial")->required();
  command->add_option("--out", options->out, "folder for the record and pictures of every look and pick");
  add_sensor_option(*command, options->sensor);
  return [options] { return run(*options); };
}

}  // namespace binpick

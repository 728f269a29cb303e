// binpick bench perception: recall, precision, errors and times of pose estimators on heaps of our own physics.

#include <filesystem>
#include <iostream>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/quantity.hpp"
#include "tools/bench/bench_commands.hpp"
#include "tools/bench/peers/peer.hpp"
#include "tools/bench/perception_ablation.hpp"
#include "tools/bench/perception_calibration.hpp"
#include "tools/bench/perception_rows.hpp"
#include "tools/bench/perception_score_fit.hpp"
#include "tools/bench/perception_wrong.hpp"

namespace binpick {
namespace {

struct Options {
  PerceptionBenchConfig bench;
  std::vector<std::string> parts, estimators, files, settings;
  std::string scenes_folder = "scenes", features, seeds, json, calibration, bin_offset, bin_turn, other_part;
  int scenes = 10;
  bool failures = false, ablation = false, peers = false, markdown = false, wrong = false;
};

/// The shipped scene of a part: scenes/<part>_bin.yaml, or with the first word of the part's name.
std::string scene_of(const std::string& folder, const std::string& part) {
  std::vector<std::string> tried;
  for (const std::string& word : {part, part.substr(0, part.find('_'))}) {
    tried.push_back(folder + "/" + word + "_bin.yaml");
    if (std::filesystem::exists(tried.back())) return tried.back();
  }
  throw SpecError("--parts " + part + ": neither " + tried[0] + " nor " + tried[1] + " is there");
}

std::vector<ContenderSpec> contenders(const Options& options) {
  std::vector<ContenderSpec> specs;
  if (options.ablation) specs = ablation_variants();
  for (const std::string& text : options.estimators) specs.push_back(parse_contender(text));
  for (const std::string& file : options.files) {
    ContenderSpec spec;
    spec.file = file;
    specs.push_back(spec);
  }
  if (specs.empty()) specs.push_back(parse_contender("ppf"));
  for (ContenderSpec& spec : specs)
    spec.settings.insert(spec.settings.end(), options.settings.begin(), options.settings.end());
  if (!options.peers) return specs;
  if (peer_registry().empty()) throw SpecError("--peers: this program was built without OpenCV's and PCL's matchers");
  for (const EstimatorEntry& peer : peer_registry()) specs.push_back(parse_contender(peer.name));
  return specs;
}

void finish(Options& options) {
  for (const std::string& part : options.parts) options.bench.scenes.push_back(scene_of(options.scenes_folder, part));
  if (options.bench.scenes.empty()) {
    std::vector<std::string> parts = {"bearing_6914", "bracket_l",    "bolt_m24x80",
                                      "gear_m3_z24",  "plate_100x60", "shaft_25_35x120"};
    if (options.wrong) parts.push_back("tee");
    for (const std::string& part : parts) options.bench.scenes.push_back(scene_of(options.scenes_folder, part));
  }
  if (options.bench.sensors.empty()) options.bench.sensors = {"gauss_0.5mm", "d435_848"};
  options.bench.contenders = contenders(options);
  options.bench.last_seed = options.bench.first_seed + static_cast<std::uint64_t>(options.scenes);
  options.bench.ask_first = !options.ablation && !options.wrong && options.features.empty();
  ViewTrouble& trouble = options.bench.trouble;
  if (!options.other_part.empty()) trouble.other_part = read_part_spec(options.other_part);
  if (!options.bin_offset.empty()) trouble.bin_offset = parse_quantity(options.bin_offset, Unit::kLength);
  if (!options.bin_turn.empty()) trouble.bin_turn = parse_quantity(options.bin_turn, Unit::kAngle);
  if (!options.seeds.empty()) std::tie(options.bench.first_seed, options.bench.last_seed) = parse_seeds(options.seeds);
}

std::string table_for(const Options& options, const std::vector<PerceptionRow>& rows) {
  if (options.ablation) return ablation_table(rows);
  if (options.wrong) return wrong_parts_table(rows);
  return options.markdown ? markdown_of(rows) : table_of(rows);
}

int run(Options options) {
  finish(options);
  options.bench.features = !options.features.empty();
  if (!options.json.empty()) write_file(options.json, "{\"rows\": []}\n");  // a bad place is known at once
  StderrProgress progress;
  const std::vector<PerceptionRow> rows =
      options.wrong ? bench_wrong_parts(options.bench, progress) : bench_perception(options.bench, progress);
  if (!options.json.empty()) write_file(options.json, json_of(rows));
  if (!options.bench.heaps_only) std::cout << table_for(options, rows);
  if (!options.calibration.empty()) std::cout << "\n" << write_calibration(rows, options.calibration);
  if (!options.features.empty()) write_file(options.features, features_csv(rows));
  if (options.failures) std::cout << failures_of(rows);
  std::cout << std::flush;
  if (!std::cout) throw StorageError("standard output: cannot write");
  return 0;
}

void add_options(CLI::App& command, Options& o) {
  command
      .add_option("--parts", o.parts,
                  "parts whose shipped scenes are looked at; default: the six of the project but the tee")
      ->delimiter(',');
  command.add_option("--scene-files", o.bench.scenes, "scene files, beside or in place of --parts");
  command.add_option("--part-scale", o.bench.part_scale, "every part this much larger, in the heaps and sought")
      ->check(CLI::Range(0.01, 100.0));
  command.add_option("--scenes-folder", o.scenes_folder, "where --parts finds <part>_bin.yaml; default scenes");
  command.add_option("--scenes", o.scenes, "heaps of each, seeds from 100")->check(CLI::Range(1, 100000));
  command.add_option("--seeds", o.seeds, "A:B, heaps of the seeds A .. B-1 instead");
  command
      .add_option("--sensor", o.bench.sensors,
                  "gauss_0.5mm, d435_848, .. or NAME[:PRESET] of `list sensor_presets`; default these two")
      ->delimiter(',');
  command.add_option("--estimator", o.estimators,
                     "TYPE, or 'TYPE key=value ..' with settings of its own; may be repeated; default ppf");
  command.add_option("--estimator-file", o.files, "YAML as in a scene's `estimator:`; may be repeated");
  command.add_option("--set", o.settings, "key=value for all of them, sections by dots: search.rounds=1");
  command.add_option("--threads", o.bench.threads, "that an estimator may use")->check(CLI::Range(1, 256));
  command.add_option("--cache", o.bench.cache, "folder in which heaps at rest are kept");
  command.add_flag("--heaps-only", o.bench.heaps_only, "drop the heaps into --cache and look at nothing");
  command.add_flag("--failures", o.failures, "list every missed instance and every wrong estimate");
  command.add_flag("--peers", o.peers, "OpenCV's and PCL's matchers, too, as far as they were built in");
  command.add_option("--peer-scenes", o.bench.peer_scenes, "heaps that they are asked about")
      ->check(CLI::Range(1, 100000));
  command.add_flag("--ablation", o.ablation, "each step taken out alone, as Markdown");
  command.add_flag("--markdown", o.markdown, "the table as Markdown");
  command.add_option("--calibration", o.calibration, "folder for the curve of the scores: CSV and picture");
  command.add_option("--features", o.features, "file for what every score is made of, as `bench score` reads it");
  command.add_option("--json", o.json, "file for the figures");
}

void add_troubles(CLI::App& command, Options& o) {
  ViewTrouble& trouble = o.bench.trouble;
  command.add_option("--bin-offset", o.bin_offset, "the believed bin is off by this length, as in '5 mm'");
  command.add_option("--bin-turn", o.bin_turn, "and turned by this angle, as in '1 deg'");
  command.add_flag("--no-bin", trouble.no_bin, "the estimator is told of no bin: floor and walls stay in the cloud");
  command.add_flag("--as-cloud", trouble.as_cloud, "points in random order in place of the depth image");
  command.add_flag("--no-parts", trouble.no_parts, "the bins are empty: every estimate is wrong");
  command.add_option("--other-part", o.other_part, "part.yaml that is looked for instead: every estimate is wrong");
  CLI::Option* wrong = command.add_flag(
      "--wrong", o.wrong, "every part looked for in the heaps of every other, as Markdown; default: all seven");
  command.add_option("--sought-scale", o.bench.sought_scale, "with --wrong: what is looked for this much larger")
      ->check(CLI::Range(0.01, 100.0))
      ->needs(wrong);
}

}  // namespace

Action add_bench_perception(CLI::App& bench) {
  auto options = std::make_shared<Options>();
  CLI::App* command = bench.add_subcommand("perception", "recall, precision, errors and times of pose estimators");
  add_options(*command, *options);
  add_troubles(*command, *options);
  return [options] { return run(*options); };
}

}  // namespace binpick

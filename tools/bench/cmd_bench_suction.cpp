// binpick bench suction: which cups carry the bearing at which acceleration, measured beside statics.

#include <iostream>

#include "core/file_io.hpp"
#include "tools/bench/bench_commands.hpp"
#include "tools/bench/suction_table.hpp"

namespace binpick {
namespace {

struct Options {
  SuctionTableConfig config;
  std::string part, json;
};

int run(const Options& options) {
  if (!options.json.empty()) write_file(options.json, "{}\n");  // a place that cannot be written is known at once
  RingSubject ring = paper_ring();
  if (!options.part.empty()) ring.part = load_part(read_part_spec(options.part));
  const SuctionTable table = suction_table(ring, options.config);
  std::cout << text_of(table, options.config) << std::flush;
  if (!options.json.empty()) write_file(options.json, json_of(table, options.config));
  return 0;
}

}  // namespace

Action add_bench_suction(CLI::App& bench) {
  auto options = std::make_shared<Options>();
  CLI::App* command = bench.add_subcommand("suction", "cups x vacuum x acceleration: share of grasps that hold a ring");
  command->add_option(
      "--part", options->part,
      "part.yaml of a ring 70 x 100 mm about its z axis; default: the paper's bearing with sharp edges");
  command->add_option("--draws", options->config.draws, "grasps of each row")->check(CLI::Range(1, 100000));
  command->add_option("--seed", options->config.seed, "the first grasp's seed");
  command->add_option("--diameters", options->config.diameters, "of the cups, m")->check(CLI::Range(0.002, 0.1));
  command->add_option("--cups", options->config.cups, "how many; several stand on the land's circle")
      ->check(CLI::Range(1, 8));
  command->add_option("--vacuums", options->config.vacuums, "Pa below the air's pressure")->check(CLI::Range(1e3, 1e5));
  command->add_option("--json", options->json, "file for the figures");
  return [options] { return run(*options); };
}

}  // namespace binpick

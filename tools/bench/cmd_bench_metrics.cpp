// binpick bench metrics: what the errors of pairs of poses cost (docs/metrics.md).

#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/file_io.hpp"
#include "tools/bench/bench_commands.hpp"
#include "tools/bench/metrics_bench.hpp"

namespace binpick {
namespace {

struct Options {
  std::size_t pairs = 1000, drawn = 100;
  std::string json;
};

int run(const Options& options) {
  if (!options.json.empty()) write_file(options.json, "{}\n");  // a place that cannot be written is known at once
  nlohmann::ordered_json json;
  std::printf("%-66s %7s %9s %9s\n", "", "pairs", "CPU s", "at most");
  for (const MetricsRow& row : bench_metrics(options.pairs, options.drawn)) {
    std::printf("%-66s %7zu %9.3f %9.0f\n", row.name.c_str(), row.pairs, row.seconds, row.limit);
    json["rows"].push_back({{"name", row.name}, {"pairs", row.pairs}, {"cpu_s", row.seconds}, {"limit_s", row.limit}});
  }
  if (!options.json.empty()) write_file(options.json, json.dump(2) + "\n");
  return 0;
}

}  // namespace

Action add_bench_metrics(CLI::App& bench) {
  auto options = std::make_shared<Options>();
  CLI::App* command = bench.add_subcommand("metrics", "errors of pairs of poses on a model of 1,000 vertices");
  command->add_option("--pairs", options->pairs, "of estimate and truth")->check(CLI::Range(1, 1000000));
  command->add_option("--drawn", options->drawn, "estimates that VSD draws")->check(CLI::Range(1, 100000));
  command->add_option("--json", options->json, "file for the figures");
  return [options] { return run(*options); };
}

}  // namespace binpick

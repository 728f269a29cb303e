// binpick bench merge RUN --records N --shards K --out DIR: what merging costs. The records of a real run, each under
// many seeds of its own, are laid out as K shards and merged; the figures beside it are what a cluster needs to know.

#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "evaluation/trial_record.hpp"
#include "tools/bench/bench_commands.hpp"
#include "tools/bench/cpu_clock.hpp"
#include "trials/run_merge.hpp"
#include "trials/scenario.hpp"

namespace binpick {
namespace {

struct Options {
  std::string run, out, json;
  int records = 100000, shards = 100;
};

/// Peak of resident memory so far, bytes.
double peak_memory() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

/// Bytes written.
double lay_out(const std::vector<TrialRecord>& records, const Options& options, std::vector<std::string>& folders) {
  const Scenario scenario = read_scenario(options.run + "/scenario.yaml");
  double bytes = 0;
  for (int shard = 1; shard <= options.shards; ++shard) {
    folders.push_back(options.out + "/shards/" + std::to_string(shard));
    make_folder(folders.back() + "/records");
    std::string text;
    for (int seed = 0; seed < options.records; ++seed) {
      if (!in_shard(static_cast<std::uint64_t>(seed), shard, options.shards)) continue;
      TrialRecord record = records[static_cast<std::size_t>(seed) % records.size()];
      record.seed = Seed{static_cast<std::uint64_t>(seed)};
      text += to_json_line(record) + "\n";
    }
    bytes += static_cast<double>(text.size());
    write_file(folders.back() + "/records/records.jsonl", text);
    write_file(folders.back() + "/scenario.yaml", expanded_yaml(scenario, folders.back()));
    write_file(folders.back() + "/environment.json", read_file(options.run + "/environment.json"));
  }
  return bytes;
}

int run(const Options& options) {
  if (std::filesystem::exists(options.out)) throw SpecError(options.out + ": is there already");
  const std::vector<TrialRecord> records = read_records(options.run);
  if (records.empty()) throw SpecError(options.run + ": holds no records");
  std::vector<std::string> folders;
  const double bytes = lay_out(records, options, folders), before = peak_memory();
  const CpuClock cpu;
  const auto start = std::chrono::steady_clock::now();
  const MergeResult merged =
      merge_runs(folders, options.out + "/merged", 0, static_cast<std::uint64_t>(options.records));
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  if (!merged.missing.empty() || !merged.conflicts.empty()) throw SpecError("bench merge: records are missing");
  const double n = options.records;
  std::printf(
      "%d records of %.0f bytes in %d shards: merged in %.1f s CPU, %.1f s wall; %.0f records per CPU second;\n"
      "memory at most %.0f MB (%.0f MB before merging)\n",
      options.records, bytes / n, options.shards, cpu.seconds(), wall.count(), n / cpu.seconds(), 1e-6 * peak_memory(),
      1e-6 * before);
  if (!options.json.empty()) {
    const nlohmann::ordered_json json = {{"records", options.records},    {"shards", options.shards},
                                         {"bytes_per_record", bytes / n}, {"cpu_s", cpu.seconds()},
                                         {"wall_s", wall.count()},        {"peak_bytes", peak_memory()},
                                         {"peak_bytes_before", before}};
    write_file(options.json, json.dump(2) + "\n");
  }
  return 0;
}

}  // namespace

Action add_bench_merge(CLI::App& bench) {
  auto options = std::make_shared<Options>();
  CLI::App* command = bench.add_subcommand("merge", "merging shards of many records, made from those of a run");
  command->add_option("run", options->run, "run folder whose records are multiplied")->required();
  command->add_option("--out", options->out, "folder for shards and merged run; it must not exist")->required();
  command->add_option("--records", options->records, "records in all")->check(CLI::Range(1, 10000000));
  command->add_option("--shards", options->shards, "run folders they come in")->check(CLI::Range(1, 100000));
  command->add_option("--json", options->json, "file for the figures");
  return [options] { return run(*options); };
}

}  // namespace binpick

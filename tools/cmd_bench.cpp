// binpick bench WHAT: wall times on this machine beside what is asked for. Never a verdict.

#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "evaluation/statistics.hpp"
#include "tools/bench/bench_commands.hpp"
#include "tools/bench/cmd_bench_gate.hpp"
#include "tools/bench/sensor_bench.hpp"
#include "tools/commands.hpp"

namespace binpick {
namespace {

constexpr std::size_t kParts = 40;
constexpr std::uint64_t kHeapSeed = 5000;

struct SensorOptions {
  SensorBenchConfig config;
  int thread_check = 0;
  std::string json;
};

void print_rows(const std::vector<BenchRow>& rows) {
  std::printf("%-17s %17s %23s %8s %14s\n", "", "frame ms", "with visibility ms", "cpu ms", "target ms");
  std::printf("%-17s %9s %7s %15s %7s %8s %8s %5s\n", "", "median", "p95", "median", "p95", "median", "at most", "aim");
  for (const BenchRow& row : rows) {
    std::printf("%-17s %9.1f %7.1f %15.1f %7.1f %8.1f", row.name.c_str(), quantile(row.frame_ms, 0.5),
                quantile(row.frame_ms, 0.95), quantile(row.capture_ms, 0.5), quantile(row.capture_ms, 0.95),
                quantile(row.cpu_ms, 0.5));
    if (row.limit_ms > 0) std::printf(" %8.0f %5.0f", row.limit_ms, row.aim_ms);
    std::printf("\n");
  }
}

void write_rows(const std::vector<BenchRow>& rows, const SensorBenchConfig& config, const std::string& path) {
  nlohmann::ordered_json json;
  json["frames"] = config.frames;
  json["threads"] = config.threads;
  for (const BenchRow& row : rows) {
    nlohmann::ordered_json out;
    out["name"] = row.name;
    out["frame_ms"] = {{"median", quantile(row.frame_ms, 0.5)}, {"p95", quantile(row.frame_ms, 0.95)}};
    out["with_visibility_ms"] = {{"median", quantile(row.capture_ms, 0.5)}, {"p95", quantile(row.capture_ms, 0.95)}};
    out["with_visibility_cpu_ms"] = {{"median", quantile(row.cpu_ms, 0.5)}, {"p95", quantile(row.cpu_ms, 0.95)}};
    if (row.limit_ms > 0) out["limit_ms"] = row.limit_ms, out["aim_ms"] = row.aim_ms;
    json["rows"].push_back(out);
  }
  write_file(path, json.dump(2) + "\n");
}

int run_thread_check(int frames) {
  const ThreadCheck check = check_threads(frames);
  std::printf("%d frames by 4 threads against one by one: %d equal, %d different\n", frames, check.equal,
              check.different);
  return check.different == 0 ? 0 : 7;
}

int run_sensors(const SensorOptions& options) {
  if (options.thread_check > 0) return run_thread_check(options.thread_check);
  const BenchHeap heap = bench_heap(kParts, Seed{kHeapSeed});
  std::printf("%zu parts of %zu triangles at rest, %d x %d pixels, %d frames, %d threads\n", heap.parts, heap.triangles,
              heap.camera.width, heap.camera.height, options.config.frames, options.config.threads);
  const std::vector<BenchRow> rows = bench_sensors(heap, options.config);
  print_rows(rows);
  if (!options.json.empty()) write_rows(rows, options.config, options.json);
  return 0;
}

}  // namespace

Action add_bench(CLI::App& app) {
  auto options = std::make_shared<SensorOptions>();
  CLI::App* command = app.add_subcommand("bench", "wall times on this machine");
  command->require_subcommand(1);
  CLI::App* sensors = command->add_subcommand("sensors", "one frame of every renderer and every sensor");
  sensors->add_option("--frames", options->config.frames, "frames of each")->check(CLI::Range(1, 100000));
  sensors->add_option("--threads", options->config.threads, "threads a frame may use")->check(CLI::Range(1, 256));
  sensors
      ->add_option("--thread-check", options->thread_check,
                   "instead: this many frames by four threads at once are compared with the same one by one")
      ->check(CLI::Range(1, 1000000));
  sensors->add_option("--json", options->json, "file for the figures");
  const Action perception = add_bench_perception(*command), score = add_bench_score(*command);
  const Action physics = add_bench_physics(*command), suction = add_bench_suction(*command);
  const Action heaps = add_bench_heaps(*command), planning = add_bench_planning(*command);
  const Action gate = add_bench_gate(*command), metrics = add_bench_metrics(*command);
  const Action merge = add_bench_merge(*command);
  return [=] {
    if (sensors->parsed()) return run_sensors(*options);
    if (command->get_subcommand("physics")->parsed()) return physics();
    if (command->get_subcommand("suction")->parsed()) return suction();
    if (command->get_subcommand("heaps")->parsed()) return heaps();
    if (command->get_subcommand("gate")->parsed()) return gate();
    if (command->get_subcommand("metrics")->parsed()) return metrics();
    if (command->get_subcommand("merge")->parsed()) return merge();
    if (command->get_subcommand("planning")->parsed()) return planning();
    return command->get_subcommand("score")->parsed() ? score() : perception();
  };
}

}  // namespace binpick

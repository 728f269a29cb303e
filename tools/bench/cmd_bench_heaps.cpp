// binpick bench heaps: are many heaps of a scene at rest, and what did that cost?

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/file_io.hpp"
#include "core/hash.hpp"
#include "evaluation/statistics.hpp"
#include "tools/bench/bench_commands.hpp"
#include "tools/bench/heap_rest.hpp"

namespace binpick {
namespace {

struct Options {
  HeapRestConfig heaps;
  std::string seeds, json;
  bool rows = false;
};

double deepest(const HeapRest& heap) {
  return heap.penetrations.empty() ? 0 : *std::max_element(heap.penetrations.begin(), heap.penetrations.end());
}

template <class Get>
std::vector<double> column(const std::vector<HeapRest>& heaps, Get get) {
  std::vector<double> values;
  for (const HeapRest& heap : heaps) values.push_back(get(heap));
  return values;
}

void print_row(const HeapRest& h) {
  std::printf(
      "seed %llu %s: rest after %5.2f s, %6.2f + %5.2f CPU s, moved %2d / %2d, at most %.3f mm, %.1e J, deepest %.3f "
      "mm",
      static_cast<unsigned long long>(h.seed), hex(h.hash).c_str(), h.settle_time, h.settle_cpu, h.check_cpu, h.moved,
      h.parts, 1e3 * h.motion, h.energy, 1e3 * deepest(h));
  std::printf("%s%s\n", h.damped ? ", damped" : "", h.unsettled.empty() ? "" : (": " + h.unsettled).c_str());
}

void print_share(const char* what, std::size_t hits, std::size_t total) {
  const Interval i = wilson_interval(hits, total);
  std::printf("%-36s %zu / %zu = %.2f %% (%.2f - %.2f)\n", what, hits, total,
              100.0 * static_cast<double>(hits) / static_cast<double>(total), 100 * i.low, 100 * i.high);
}

void print_quantiles(const char* what, const std::vector<double>& values, double scale, const char* unit) {
  if (values.empty()) return;
  std::printf("%-36s median %.3g, p95 %.3g, p99 %.3g, largest %.3g %s\n", what, scale * quantile(values, 0.5),
              scale * quantile(values, 0.95), scale * quantile(values, 0.99), scale * quantile(values, 1), unit);
}

void print_summary(const std::vector<HeapRest>& heaps) {
  std::size_t parts = 0, moved = 0, outside = 0, invalid = 0;
  std::vector<double> depths;
  Hasher all;
  for (const HeapRest& h : heaps) {
    all.add(h.hash);
    parts += static_cast<std::size_t>(h.parts);
    outside += static_cast<std::size_t>(h.outside);
    invalid += h.unsettled.empty() && h.outside == 0 ? 0 : 1;
    if (!h.unsettled.empty()) continue;
    moved += static_cast<std::size_t>(h.moved);
    depths.insert(depths.end(), h.penetrations.begin(), h.penetrations.end());
  }
  print_share("heaps not settled or not all inside", invalid, heaps.size());
  print_share("parts outside the bin", outside, parts);
  print_share("parts that moved when woken", moved, parts);
  print_quantiles("largest motion when woken", column(heaps, [](const auto& h) { return h.motion; }), 1e3, "mm");
  print_quantiles("largest kinetic energy then", column(heaps, [](const auto& h) { return h.energy; }), 1e6, "uJ");
  print_quantiles("penetration, pairs under load", depths, 1e3, "mm");
  print_quantiles("at rest after the last release", column(heaps, [](const auto& h) { return h.settle_time; }), 1, "s");
  print_quantiles("CPU, release to rest", column(heaps, [](const auto& h) { return h.settle_cpu; }), 1, "s");
  print_quantiles("CPU, kept awake and looked into", column(heaps, [](const auto& h) { return h.check_cpu; }), 1, "s");
  std::printf("hash of all heaps %s\n", hex(all.value()).c_str());
}

nlohmann::ordered_json json_of(const std::vector<HeapRest>& heaps) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const HeapRest& h : heaps)
    json.push_back({{"seed", h.seed},
                    {"hash", hex(h.hash)},
                    {"parts", h.parts},
                    {"outside", h.outside},
                    {"moved", h.moved},
                    {"motion_m", h.motion},
                    {"energy_j", h.energy},
                    {"penetrations_m", h.penetrations},
                    {"settle_time_s", h.settle_time},
                    {"settle_cpu_s", h.settle_cpu},
                    {"check_cpu_s", h.check_cpu},
                    {"damped", h.damped},
                    {"unsettled", h.unsettled}});
  return json;
}

int run(const Options& options) {
  const std::vector<HeapRest> heaps = rest_of_heaps(options.heaps);
  if (options.rows)
    for (const HeapRest& heap : heaps) print_row(heap);
  print_summary(heaps);
  if (!options.json.empty()) write_file(options.json, json_of(heaps).dump(1) + "\n");
  return 0;
}

}  // namespace

Action add_bench_heaps(CLI::App& bench) {
  auto options = std::make_shared<Options>();
  CLI::App* command = bench.add_subcommand("heaps", "rest, penetration and bits of many heaps");
  command->add_option("scene", options->heaps.scene, "scene file")->required();
  command->add_option("--parts", options->heaps.parts, "so many of the scene's first part instead of its own counts")
      ->check(CLI::Range(1, 1000));
  command->add_option("--seeds", options->seeds, "A:B, default 5000:5020");
  command->add_option("--workers", options->heaps.workers, "threads")->check(CLI::Range(1, 256));
  command->add_flag("--fresh", options->heaps.fresh, "every heap in a process of its own");
  command->add_flag("--rows", options->rows, "every heap");
  command->add_option("--json", options->json, "file for the figures");
  return [options] {
    if (!options->seeds.empty())
      std::tie(options->heaps.first_seed, options->heaps.last_seed) = parse_seeds(options->seeds);
    return run(*options);
  };
}

}  // namespace binpick

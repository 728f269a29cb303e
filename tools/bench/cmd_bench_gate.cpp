// binpick bench gate [--runs-of BASE NEW]: false alarms, power and interval coverage of the gate, by simulation.

#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/file_io.hpp"
#include "tools/bench/cmd_bench_gate.hpp"
#include "tools/bench/gate_bench.hpp"

namespace binpick {
namespace {

struct Options {
  GateBenchConfig config;
  PileLaw law;
  std::vector<std::string> runs_of;
  std::string margins, json;
  int equal = 2000, power = 400, coverage = 1000;
};

void print(const GateRunCounts& c) {
  std::printf(
      "%-34s %6d gates: worse %6.2f %% (95 %%: %.2f - %.2f), pass %6.2f %%, undecided %6.2f %%; %5.1f seeds in the "
      "mean",
      c.name.c_str(), c.runs, 100.0 * c.worse / c.runs, 100 * c.worse_share.low, 100 * c.worse_share.high,
      100.0 * c.held / c.runs, 100.0 * c.undecided / c.runs, c.mean_seeds);
  if (c.worse > 0) std::printf(", %.1f to a \"worse\"", c.mean_seeds_worse);
  std::printf("\n");
  std::fflush(stdout);
}

nlohmann::ordered_json to_json(const GateRunCounts& c) {
  return {{"name", c.name},
          {"runs", c.runs},
          {"worse", c.worse},
          {"worse_interval", {c.worse_share.low, c.worse_share.high}},
          {"pass", c.held},
          {"undecided", c.undecided},
          {"mean_seeds", c.mean_seeds},
          {"mean_seeds_worse", c.mean_seeds_worse}};
}

class Bench {
 public:
  explicit Bench(const Options& options) : options_(options) {
    options_.config.rules = read_gate_rules(options.margins);
    if (options.runs_of.size() == 2) base_ = read_piles(options.runs_of[0]), fresh_ = read_piles(options.runs_of[1]);
  }

  int run() {
    if (!real())
      std::printf(
          "piles of %d picks at %.0f %%, spread %.2f (design effect %.1f), %.0f %% of the piles redrawn, "
          "%.0f %% of the luck shared; at most %zu seeds in blocks of %zu, alpha %g\n",
          options_.law.picks, 100 * options_.law.base_rate, options_.law.spread, design_effect(options_.law),
          100 * options_.law.redrawn, 100 * options_.law.shared, options_.config.plan.max_seeds,
          options_.config.plan.block, options_.config.rules.alpha);
    if (options_.equal > 0) equal();
    if (options_.power > 0) power();
    if (options_.coverage > 0) coverage();
    if (!options_.json.empty()) write_file(options_.json, json_.dump(2) + "\n");
    return 0;
  }

 private:
  bool real() const { return !base_.piles.empty(); }

  void gates(const std::string& name, int runs, bool intervals, const DrawPairs& draw) {
    GateBenchConfig config = options_.config;
    config.runs = runs;
    config.intervals = intervals;
    const GateRunCounts counts = run_gates(name, config, draw);
    print(counts);
    json_["gates"].push_back(to_json(counts));
  }

  // Equal versions: without intervals no gate passes early, so that false alarms are what they can be at most.
  void equal() {
    gates("equal versions, worst case", options_.equal, false,
          real() ? pairs_of_runs(base_, fresh_, true) : pairs_of(options_.law));
  }

  void power() {
    if (real()) return gates("the two runs as they are", options_.power, true, pairs_of_runs(base_, fresh_, false));
    for (const double drop : {0.05, 0.03, 0.0}) {
      PileLaw law = options_.law;
      law.new_rate = law.base_rate - drop;
      char name[60];
      std::snprintf(name, sizeof name, "%.0f -> %.0f %%", 100 * law.base_rate, 100 * law.new_rate);
      gates(name, options_.power, true, pairs_of(law));
    }
    PileLaw single = options_.law;  // one pick a pile: what McNemar on single verdicts can do at best
    single.picks = 1;
    single.new_rate = single.base_rate - 0.05;
    single.shared = 1;
    gates("one pick a pile, 5 points lost", options_.power, true, pairs_of(single));
  }

  void coverage() {
    std::vector<CoverageRow> rows = binomial_coverage();
    for (const CoverageRow& row : pile_coverage(options_.coverage, options_.config.threads)) rows.push_back(row);
    for (const CoverageRow& row : rows) {
      std::printf("%-18s of %-34s covers %.2f %% in the mean, at least %.2f %% (%s)\n", row.interval.c_str(),
                  row.of.c_str(), 100 * row.mean, 100 * row.covered, row.worst.c_str());
      json_["coverage"].push_back({{"interval", row.interval},
                                   {"of", row.of},
                                   {"mean", row.mean},
                                   {"least", row.covered},
                                   {"where", row.worst}});
    }
  }

  Options options_;
  PileSet base_, fresh_;
  nlohmann::ordered_json json_;
};

}  // namespace

Action add_bench_gate(CLI::App& bench) {
  auto options = std::make_shared<Options>();
  CLI::App* command = bench.add_subcommand("gate", "false alarms, power and interval coverage of the gate");
  command->add_option("--runs-of", options->runs_of, "two run folders whose piles are drawn from, instead of a law")
      ->expected(2);
  command->add_option("--equal", options->equal, "gates of equal versions");
  command->add_option("--power", options->power, "gates of each loss");
  command->add_option("--coverage", options->coverage, "experiments at each point of the coverage grid");
  command->add_option("--max-seeds", options->config.plan.max_seeds, "of a gate")->check(CLI::Range(1, 100000));
  command->add_option("--block", options->config.plan.block, "seeds between two looks")->check(CLI::Range(1, 100000));
  command->add_option("--spread", options->law.spread, "of the rate from pile to pile")->check(CLI::Range(0.0, 0.2));
  command->add_option("--redrawn", options->law.redrawn, "share of the piles that go another way")
      ->check(CLI::Range(0.0, 1.0));
  command->add_option("--shared", options->law.shared, "share of the luck that is the same")
      ->check(CLI::Range(0.0, 1.0));
  command->add_option("--margins", options->margins, "YAML, as for `binpick gate`");
  command->add_option("--threads", options->config.threads, "threads")->check(CLI::Range(1, 256));
  command->add_option("--json", options->json, "file for the figures");
  return [options] { return Bench(*options).run(); };
}

}  // namespace binpick

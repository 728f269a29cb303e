#include "tools/bench/gate_bench.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"

namespace binpick {
namespace {

struct Ending {
  Verdict verdict = Verdict::kInconclusive;
  std::size_t seeds = 0;
};

PileSet set_of(const char* name) {
  PileSet set;
  set.name = name;
  return set;
}

Ending run_one(const GateBenchConfig& config, const std::vector<PilePair>& pairs) {
  PileSet base = set_of("base"), fresh = set_of("new");
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    base.piles.push_back(pairs[i].base);
    fresh.piles.push_back(pairs[i].fresh);
    base.piles.back().seed = fresh.piles.back().seed = i;
  }
  const std::vector<std::size_t> sizes = look_sizes(config.plan);
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    Look look = look_at(config.plan, config.rules, k);
    look.intervals = config.intervals;
    look.resamples = config.resamples;
    const Comparison comparison = compare_first(base, fresh, sizes[k], config.rules, look);
    if (is_certain(comparison, k + 1 == sizes.size())) return {comparison.verdict, sizes[k]};
  }
  return {};
}

}  // namespace

GateRunCounts run_gates(const std::string& name, const GateBenchConfig& config, const DrawPairs& draw) {
  std::vector<Ending> endings(static_cast<std::size_t>(config.runs));
  parallel_for(endings.size(), config.threads, [&](std::size_t i) {
    Rng rng = Seed{}.child("bench/gate").child(name, i).rng();
    endings[i] = run_one(config, draw(config.plan.max_seeds, rng));
  });
  GateRunCounts counts;
  counts.name = name;
  counts.runs = config.runs;
  for (const Ending& ending : endings) {
    const auto seeds = static_cast<double>(ending.seeds);
    counts.mean_seeds += seeds / config.runs;
    if (ending.verdict == Verdict::kWorse)
      ++counts.worse, counts.mean_seeds_worse += seeds;
    else if (ending.verdict == Verdict::kInconclusive)
      ++counts.undecided;
    else
      ++counts.held;
  }
  counts.mean_seeds_worse = counts.worse > 0 ? counts.mean_seeds_worse / counts.worse : 0;
  counts.worse_share = clopper_pearson(static_cast<std::size_t>(counts.worse), endings.size());
  return counts;
}

DrawPairs pairs_of(const PileLaw& law) {
  return [law](std::size_t count, Rng& rng) {
    std::vector<PilePair> pairs;
    for (std::size_t i = 0; i < count; ++i) pairs.push_back(draw_pair(law, i, rng));
    return pairs;
  };
}

DrawPairs pairs_of_runs(const PileSet& base, const PileSet& fresh, bool swapped) {
  std::vector<PilePair> all;
  auto b = fresh.piles.begin();
  for (const PileFigures& a : base.piles) {
    while (b != fresh.piles.end() && b->seed < a.seed) ++b;
    if (b != fresh.piles.end() && b->seed == a.seed && !a.crashed && !b->crashed) all.push_back({a, *b});
  }
  if (all.empty()) throw SpecError(base.name + " and " + fresh.name + ": no seed is in both");
  return [all, swapped](std::size_t count, Rng& rng) {
    std::vector<PilePair> pairs;
    for (std::size_t i = 0; i < count; ++i) {
      PilePair pair = all[rng.below(all.size())];
      if (swapped && rng.below(2) == 1) std::swap(pair.base, pair.fresh);
      pairs.push_back(std::move(pair));
    }
    return pairs;
  };
}

}  // namespace binpick

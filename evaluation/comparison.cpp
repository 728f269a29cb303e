#include "evaluation/comparison.hpp"

#include <algorithm>

#include "core/error.hpp"

namespace binpick {
namespace {

std::string of_parts(const ClusterCount& count) {
  return std::to_string(static_cast<long>(count.hits)) + " of " + std::to_string(static_cast<long>(count.total));
}

// What flipped, in words; empty when no verdict of the pile did. `lost` is set when any of them was lost.
std::string flipped(const PileFigures& base, const PileFigures& fresh, bool& lost) {
  std::string what;
  const auto changed = [&](bool was, bool is, const std::string& text) {
    if (was == is) return;
    lost = lost || was;
    what += (what.empty() ? "" : "; ") + text;
  };
  const auto empty = [](const PileFigures& p) { return p.cleared.total > 0 && p.cleared.hits == p.cleared.total; };
  lost = false;
  changed(base.first_pick == "Succeeded", fresh.first_pick == "Succeeded",
          "first pick " + base.first_pick + " -> " + fresh.first_pick);
  changed(empty(base), empty(fresh), "cleared " + of_parts(base.cleared) + " -> " + of_parts(fresh.cleared));
  return what;
}

struct Pairs {
  std::vector<const PileFigures*> base, fresh;
};

// Ascending seeds on both sides. Crashed piles are told, and left out of what is tested.
Pairs pair_up(const PileSet& base, const PileSet& fresh, Comparison& result) {
  Pairs pairs;
  auto a = base.piles.begin(), b = fresh.piles.begin();
  while (a != base.piles.end() || b != fresh.piles.end()) {
    if (b == fresh.piles.end() || (a != base.piles.end() && a->seed < b->seed)) {
      ++result.only_base;
      ++a;
    } else if (a == base.piles.end() || b->seed < a->seed) {
      ++result.only_fresh;
      ++b;
    } else {
      if (a->crashed) result.base_crashes.push_back(a->seed);
      if (b->crashed) result.crashes.push_back(b->seed);
      if (!a->crashed && !b->crashed) {
        pairs.base.push_back(&*a);
        pairs.fresh.push_back(&*b);
      }
      ++a;
      ++b;
    }
  }
  if (result.only_base == base.piles.size()) {
    throw SpecError(base.name + " and " + fresh.name + ": no seed is in both");
  }
  return pairs;
}

void compare_bits(const Pairs& pairs, Comparison& result) {
  const bool same_schema = result.base.record_schema == result.fresh.record_schema;
  for (std::size_t i = 0; i < pairs.base.size(); ++i) {
    const PileFigures &base = *pairs.base[i], &fresh = *pairs.fresh[i];
    result.equal_heaps += base.heap_hash == fresh.heap_hash ? 1 : 0;
    const std::optional<BitDifference> difference = first_difference(base, fresh, same_schema);
    if (!difference) continue;
    result.differences.push_back(*difference);
    ++result.differing_stages[to_string(difference->stage)];
    bool lost = false;
    const std::string what = flipped(base, fresh, lost);
    if (!what.empty()) result.flips.push_back({base.seed, lost, what, describe(*difference)});
  }
  std::stable_sort(result.flips.begin(), result.flips.end(),
                   [](const Flip& a, const Flip& b) { return a.lost && !b.lost; });
}

Verdict verdict_of(const Comparison& comparison) {
  const auto any = [&](Finding finding) {
    return std::any_of(comparison.metrics.begin(), comparison.metrics.end(),
                       [&](const MetricComparison& m) { return m.rule.gate && m.finding == finding; });
  };
  if (comparison.pairs == 0) return Verdict::kInconclusive;
  if (comparison.differences.empty()) return Verdict::kNoBitChanged;
  if (any(Finding::kWorse)) return Verdict::kWorse;
  return any(Finding::kUnclear) || !any(Finding::kHolds) ? Verdict::kInconclusive : Verdict::kHolds;
}

PileSet without_piles(const PileSet& set) {
  return {set.name, set.replay, set.scenario, set.scenario_hash, set.record_schema, {}};
}

}  // namespace

Comparison compare(const PileSet& base, const PileSet& fresh, const GateRules& rules, const Look& look) {
  Comparison result;
  result.base = without_piles(base);
  result.fresh = without_piles(fresh);
  result.rules = rules;
  result.look = look;
  const Pairs pairs = pair_up(base, fresh, result);
  result.pairs = pairs.base.size();
  compare_bits(pairs, result);
  result.changed_share = clopper_pearson(result.differences.size(), result.pairs, look.confidence);
  if (result.pairs > 0) result.metrics = compare_metrics(pairs.base, pairs.fresh, rules, look);
  result.verdict = verdict_of(result);
  result.too_many_crashes = result.crashes.size() > static_cast<std::size_t>(rules.crash_budget);
  return result;
}

Comparison compare(const PileSet& base, const PileSet& fresh, const GateRules& rules) {
  Look look;
  look.alpha = rules.alpha;
  look.confidence = rules.confidence;
  return compare(base, fresh, rules, look);
}

int exit_code(const Comparison& comparison) {
  if (comparison.too_many_crashes) return 5;  // what crashed is missing from every figure
  switch (comparison.verdict) {
    case Verdict::kNoBitChanged:
    case Verdict::kHolds:
      return 0;
    case Verdict::kWorse:
      return 1;
    case Verdict::kInconclusive:
      return 3;
  }
  return 3;
}

std::string replay_command(const Comparison& comparison, std::uint64_t seed) {
  const std::string scene = comparison.fresh.replay.empty() ? "SCENE" : comparison.fresh.replay;
  std::string quoted = "'";
  for (const char c : scene) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  quoted += "'";
  const bool plain = scene.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_./+-") ==
                     std::string::npos;
  return "binpick trial " + (plain ? scene : quoted) + " --seed " + std::to_string(seed) + " --out replay/seed-" +
         std::to_string(seed);
}

}  // namespace binpick

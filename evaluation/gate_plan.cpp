#include "evaluation/gate_plan.hpp"

#include <algorithm>

#include "core/check.hpp"

namespace binpick {
namespace {

double smallest_share_margin(const Comparison& comparison) {
  double smallest = 1;
  for (const MetricComparison& m : comparison.metrics) {
    if (m.rule.gate && m.kind != MetricKind::kQuantile) smallest = std::min(smallest, m.rule.margin);
  }
  return smallest;
}

PileSet first_piles(const PileSet& set, std::uint64_t last_seed) {
  PileSet part{set.name, set.replay, set.scenario, set.scenario_hash, set.record_schema, {}};
  for (const PileFigures& pile : set.piles) {
    if (pile.seed <= last_seed) part.piles.push_back(pile);
  }
  return part;
}

}  // namespace

std::vector<std::size_t> look_sizes(const GatePlan& plan) {
  BP_CHECK(plan.max_seeds > 0 && plan.block > 0, plan.max_seeds << " seeds in blocks of " << plan.block);
  std::vector<std::size_t> sizes;
  for (std::size_t n = plan.block; n < plan.max_seeds; n += plan.block) sizes.push_back(n);
  sizes.push_back(plan.max_seeds);
  return sizes;
}

Look look_at(const GatePlan& plan, const GateRules& rules, std::size_t index) {
  const std::vector<std::size_t> sizes = look_sizes(plan);
  const std::size_t before = index == 0 ? 0 : sizes.at(index - 1);
  const double share = static_cast<double>(sizes.at(index) - before) / static_cast<double>(plan.max_seeds);
  Look look;
  look.alpha = rules.alpha * share;
  look.confidence = 1 - (1 - rules.confidence) * share;
  return look;
}

bool is_certain(const Comparison& comparison, bool last_look) {
  if (last_look || comparison.too_many_crashes) return true;
  switch (comparison.verdict) {
    case Verdict::kNoBitChanged:
      return comparison.changed_share.high < smallest_share_margin(comparison);
    case Verdict::kHolds:
    case Verdict::kWorse:
      return true;
    case Verdict::kInconclusive:
      return false;
  }
  return false;
}

Comparison compare_first(const PileSet& base, const PileSet& fresh, std::size_t n, const GateRules& rules,
                         const Look& look) {
  BP_CHECK(n > 0 && n <= base.piles.size(), n << " of " << base.piles.size());
  const std::uint64_t last = base.piles[n - 1].seed;
  return compare(first_piles(base, last), first_piles(fresh, last), rules, look);
}

}  // namespace binpick

// When a gate looks at what has run so far, and what each look may spend. Group-sequential: seeds come in blocks, and
// after each block the gate stops if the verdict is certain. The error budgets (alpha of a false "worse", and what the
// intervals leave of a false "holds") are spent in proportion to the seeds; looks are then safe by the union bound,
// whatever their dependence, without any model of the figures.
#pragma once

#include <cstddef>
#include <vector>

#include "evaluation/comparison.hpp"

namespace binpick {

struct GatePlan {
  std::size_t max_seeds = 300;
  std::size_t block = 30;
};

/// Seeds at each look: block, 2 block, .. , max_seeds.
std::vector<std::size_t> look_sizes(const GatePlan& plan);

/// The budgets of look `index`.
Look look_at(const GatePlan& plan, const GateRules& rules, std::size_t index);

/// Does nothing that more seeds could bring change the verdict? Worse and holds are certain by their budgets; crashes
/// when they are more than allowed. Where no bit has changed: when the seeds are exhausted, or when the piles that a
/// change can still touch are too few to lose the smallest margin of a share.
bool is_certain(const Comparison& comparison, bool last_look);

/// The comparison of the first n seeds, with the budgets of one look. `base` and `fresh` may hold more.
Comparison compare_first(const PileSet& base, const PileSet& fresh, std::size_t n, const GateRules& rules,
                         const Look& look);

}  // namespace binpick

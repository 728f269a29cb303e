#include "tools/bench/gate_piles.hpp"

#include <algorithm>
#include <cmath>

namespace binpick {
namespace {

// Marsaglia and Tsang (ACM TOMS 26, 2000); shapes below 1 by the usual power of a uniform.
double gamma(double shape, Rng& rng) {
  if (shape < 1) {
    const double boost = std::pow(rng.uniform(), 1 / shape);
    return gamma(shape + 1, rng) * boost;
  }
  const double d = shape - 1.0 / 3, c = 1 / std::sqrt(9 * d);
  for (;;) {
    const double x = rng.normal(), v = std::pow(1 + c * x, 3);
    if (v > 0 && std::log(rng.uniform()) < 0.5 * x * x + d - d * v + d * std::log(v)) return d * v;
  }
}

double beta(double mean, double spread, Rng& rng) {
  if (spread <= 0) return mean;
  const double size = mean * (1 - mean) / (spread * spread) - 1;
  const double a = gamma(mean * size, rng), b = gamma((1 - mean) * size, rng);
  return a / (a + b);
}

// What both versions share of a look: visible parts and errors, which no version changes in these laws.
void draw_errors(const PileLaw& law, Rng& rng, PileFigures& pile) {
  pile.recall = pile.recall_first_look = pile.precision = {};
  for (int i = 0; i < law.errors; ++i) {
    const bool found = rng.uniform() < 0.98;
    pile.recall.total += 1;
    pile.recall.hits += found ? 1 : 0;
    pile.precision.total += found ? 1 : 0;
    pile.precision.hits += found && rng.uniform() < 0.99 ? 1 : 0;
    if (!found) {
      ++pile.missed;
      continue;
    }
    pile.translations.push_back(0.4e-3 * std::exp(0.5 * rng.normal()));
    pile.rotations.push_back(0.008 * std::exp(0.5 * rng.normal()));
    pile.cycles.push_back(9.4 + 0.5 * rng.normal());
  }
  pile.recall_first_look = pile.recall;
}

}  // namespace

PilePair draw_pair(const PileLaw& law, std::uint64_t seed, Rng& rng) {
  PilePair pair;
  // The harder pile is harder for both: a failure of the base is one of the new version, which has some of its own.
  const double base_rate = beta(law.base_rate, law.spread, rng);
  const double here = rng.uniform() < law.redrawn ? beta(law.base_rate, law.spread, rng) : base_rate;
  const double new_rate = law.new_rate <= law.base_rate ? here * law.new_rate / law.base_rate
                                                        : 1 - (1 - here) * (1 - law.new_rate) / (1 - law.base_rate);
  for (PileFigures* pile : {&pair.base, &pair.fresh}) {
    pile->seed = seed;
    pile->content_hash = rng.next_u64();
    pile->picks.total = pile->cleared.total = law.picks;
    draw_errors(law, rng, *pile);
  }
  for (int i = 0; i < law.picks; ++i) {
    const double luck = rng.uniform();
    const double luck_new = rng.uniform() < law.shared ? luck : rng.uniform();
    const bool base = luck < base_rate, fresh = luck_new < new_rate;
    pair.base.picks.hits += base ? 1 : 0;
    pair.fresh.picks.hits += fresh ? 1 : 0;
    if (i == 0) {
      pair.base.first_pick = base ? "Succeeded" : "NoSeal";
      pair.fresh.first_pick = fresh ? "Succeeded" : "NoSeal";
    }
  }
  pair.base.cleared.hits = pair.base.picks.hits;
  pair.fresh.cleared.hits = pair.fresh.picks.hits;
  return pair;
}

double design_effect(const PileLaw& law) {
  const double correlation = law.spread * law.spread / (law.base_rate * (1 - law.base_rate));
  return 1 + (law.picks - 1) * correlation;
}

}  // namespace binpick

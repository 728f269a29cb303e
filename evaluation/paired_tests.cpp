#include "evaluation/paired_tests.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/check.hpp"

namespace binpick {
namespace {

// Sums of signed losses, eight at a time: bit i of a group's byte set means that loss i is taken negative.
class SignedSums {
 public:
  explicit SignedSums(const std::vector<double>& losses) {
    for (std::size_t first = 0; first < losses.size(); first += 8) {
      const std::size_t size = std::min<std::size_t>(8, losses.size() - first);
      std::array<double, 256>& sums = tables_.emplace_back();
      for (std::size_t pattern = 0; pattern < 256; ++pattern) {
        sums[pattern] = 0;
        for (std::size_t i = 0; i < size; ++i) sums[pattern] += (pattern >> i & 1 ? -1 : 1) * losses[first + i];
      }
    }
  }

  double of(std::uint64_t pattern) const {
    double sum = 0;
    for (const auto& table : tables_) {
      sum += table[pattern & 255];
      pattern >>= 8;
    }
    return sum;
  }
  double random(Rng& rng) const {
    double sum = 0;
    std::uint64_t bits = 0;
    for (std::size_t g = 0; g < tables_.size(); ++g, bits >>= 8) {
      if (g % 8 == 0) bits = rng.next_u64();
      sum += tables_[g][bits & 255];
    }
    return sum;
  }
  double observed() const {
    double sum = 0;
    for (const auto& table : tables_) sum += table[0];
    return sum;
  }

 private:
  std::vector<std::array<double, 256>> tables_;
};

double exact_share(const SignedSums& sums, std::size_t piles, double bar) {
  const std::uint64_t patterns = std::uint64_t{1} << piles;
  std::uint64_t beyond = 0;
  for (std::uint64_t pattern = 0; pattern < patterns; ++pattern) beyond += sums.of(pattern) >= bar ? 1 : 0;
  return static_cast<double>(beyond) / static_cast<double>(patterns);
}

double drawn_share(const SignedSums& sums, double bar, Seed seed, const SignFlipEffort& effort) {
  Rng rng = seed.child("sign_flip").rng();
  std::size_t beyond = 0;
  for (std::size_t i = 1; i <= effort.draws; ++i) {
    if (sums.random(rng) >= bar) ++beyond;
    if (beyond == effort.enough_beyond) return static_cast<double>(beyond) / static_cast<double>(i);
  }
  return static_cast<double>(beyond + 1) / static_cast<double>(effort.draws + 1);  // what was seen is a pattern too
}

// Tango 1998: the score of loss d, at the likelihood's best split between lost and won that has this difference.
double tango_score(const PairedVerdicts& v, double d) {
  const double n = static_cast<double>(v.total()), lost = static_cast<double>(v.lost), won = static_cast<double>(v.won);
  const double b = -lost - won + (2 * n - lost + won) * d, c = -won * d * (1 - d);
  const double share_won = (std::sqrt(std::max(0.0, b * b - 8 * n * c)) - b) / (4 * n);
  const double variance = n * (2 * share_won + d * (1 - d));
  const double excess = lost - won - n * d;
  if (variance <= 0) return excess == 0 ? 0 : std::copysign(std::numeric_limits<double>::infinity(), excess);
  return excess / std::sqrt(variance);
}

// The score falls as d grows: the d between `low` and `high` where it passes `z`.
double tango_bound(const PairedVerdicts& v, double z, double low, double high) {
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (tango_score(v, middle) > z ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

double mcnemar_worse(const PairedVerdicts& verdicts) {
  return binomial_at_least(verdicts.lost, verdicts.lost + verdicts.won, 0.5);
}

Interval tango_interval(const PairedVerdicts& verdicts, double confidence) {
  BP_CHECK(confidence > 0 && confidence < 1, "confidence " << confidence);
  const std::size_t n = verdicts.total();
  if (n == 0) return {-1, 1};
  const double z = normal_quantile(0.5 + confidence / 2);
  const double loss = (static_cast<double>(verdicts.lost) - static_cast<double>(verdicts.won)) / static_cast<double>(n);
  return {verdicts.won == n ? -1.0 : tango_bound(verdicts, z, -1, loss),
          verdicts.lost == n ? 1.0 : tango_bound(verdicts, -z, loss, 1)};
}

double sign_flip_worse(std::span<const double> losses, Seed seed, const SignFlipEffort& effort) {
  BP_CHECK(effort.exact_up_to < 40 && effort.draws > 0 && effort.enough_beyond > 0, "no effort");
  std::vector<double> differing;  // a pile that does not differ has no sign to flip
  double size = 0;
  for (const double loss : losses) {
    BP_CHECK(std::isfinite(loss), "loss " << loss);
    if (loss == 0) continue;
    differing.push_back(loss);
    size += std::abs(loss);
  }
  if (differing.empty()) return 1;
  const SignedSums sums(differing);
  const double bar = sums.observed() - 1e-12 * size;  // equal sums of another order are equal
  return differing.size() <= effort.exact_up_to ? exact_share(sums, differing.size(), bar)
                                                : drawn_share(sums, bar, seed, effort);
}

std::vector<double> holm(std::span<const double> p_values) {
  std::vector<std::size_t> order(p_values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p_values[a] < p_values[b]; });
  std::vector<double> adjusted(p_values.size());
  double largest = 0;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const double scaled = static_cast<double>(order.size() - rank) * p_values[order[rank]];
    largest = std::max(largest, std::min(1.0, scaled));
    adjusted[order[rank]] = largest;
  }
  return adjusted;
}

}  // namespace binpick

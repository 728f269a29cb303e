#include "evaluation/paired_shares.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace binpick {
namespace {

void add(ClusterCount& sum, const ClusterCount& other) {
  sum.hits += other.hits;
  sum.total += other.total;
}

// The mean loss is at most (share of piles that differ) x (largest loss seen) + (share of piles beyond the largest
// seen) x 1; each share is bounded exactly, with half the doubt each. The pile of the largest of n losses is as good as
// any: a larger one has a share of at most clopper_pearson(0, n).
Interval few_differing(std::span<const SharePair> pairs, std::size_t differing, double confidence) {
  const std::size_t n = pairs.size();
  if (differing == 0) return {-clopper_pearson(0, n, confidence).high, clopper_pearson(0, n, confidence).high};
  double total = 0, largest = 0;
  for (const SharePair& pair : pairs) total += pair.base.total;
  for (const double loss : pile_losses(pairs)) largest = std::max(largest, std::abs(loss));
  const double worst = total > 0 ? std::min(1.0, largest * static_cast<double>(n) / total) : 1;
  const double halved = (1 + confidence) / 2;
  const double most = clopper_pearson(differing, n, halved).high * worst + clopper_pearson(0, n, halved).high;
  return {-std::min(1.0, most), std::min(1.0, most)};
}

}  // namespace

SharePair& SharePair::operator+=(const SharePair& other) {
  add(base, other.base);
  add(fresh, other.fresh);
  return *this;
}

double SharePair::loss() const {
  if (!(base.total > 0 && fresh.total > 0)) return std::numeric_limits<double>::quiet_NaN();
  return base.hits / base.total - fresh.hits / fresh.total;
}

std::vector<double> pile_losses(std::span<const SharePair> pairs) {
  ClusterCount pooled;
  for (const SharePair& pair : pairs) {
    add(pooled, pair.base);
    add(pooled, pair.fresh);
  }
  const double all = pooled.total > 0 ? pooled.hits / pooled.total : 0;
  std::vector<double> losses;
  for (const SharePair& pair : pairs)
    losses.push_back(pair.base.hits - pair.fresh.hits - all * (pair.base.total - pair.fresh.total));
  return losses;
}

Interval loss_interval(std::span<const SharePair> pairs, Seed seed, double confidence, int resamples) {
  const auto differing = static_cast<std::size_t>(
      std::count_if(pairs.begin(), pairs.end(), [](const SharePair& p) { return p.differs(); }));
  if (differing < kFewDifferingPiles) return few_differing(pairs, differing, confidence);
  const std::vector<double> losses = bootstrap(pairs.size(), seed, resamples, [&](std::span<const std::size_t> drawn) {
    SharePair sum;
    for (const std::size_t k : drawn) sum += pairs[k];
    return sum.base.total > 0 && sum.fresh.total > 0 ? sum.loss() : 0.0;
  });
  return {quantile(losses, (1 - confidence) / 2), quantile(losses, (1 + confidence) / 2)};
}

}  // namespace binpick

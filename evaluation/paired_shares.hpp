// A share (parts cleared of dropped, picks succeeded of attempted) of two versions on the same piles: what each pile
// says of the loss, and the interval of the loss. The unit is the pile.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "evaluation/statistics.hpp"

namespace binpick {

/// Hits of all, of one pile by both versions; or sums of such.
struct SharePair {
  ClusterCount base, fresh;
  SharePair& operator+=(const SharePair& other);
  /// Rate of the base less that of the new version; NaN where either has no trials.
  double loss() const;
  bool differs() const { return base.hits != fresh.hits || base.total != fresh.total; }
};

/// With fewer piles that differ than this a bootstrap knows too little of them (and of none, nothing): an interval is
/// then what so small a share of changed piles can do at all.
inline constexpr std::size_t kFewDifferingPiles = 10;

/// A pile's share in the loss of the pooled rate. The pooled rate of both versions does not change when a pile's
/// results change places, so each of these numbers then changes its sign, which is what the sign-flip test needs.
std::vector<double> pile_losses(std::span<const SharePair> pairs);

/// Of the loss: bootstrap over piles, in which a resample without trials counts as no loss; exact bounds where few
/// differ.
Interval loss_interval(std::span<const SharePair> pairs, Seed seed, double confidence, int resamples = 4000);

}  // namespace binpick

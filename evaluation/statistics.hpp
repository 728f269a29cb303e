// Intervals and quantiles.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/random.hpp"

namespace binpick {

struct Interval {
  double low = 0;
  double high = 1;
};

/// Wilson score interval of hits / total; [0, 1] when total is 0.
Interval wilson_interval(std::size_t hits, std::size_t total, double confidence = 0.95);

/// Clopper and Pearson's exact interval, which holds at least `confidence` whatever the rate; [0, 1] when total is 0.
Interval clopper_pearson(std::size_t hits, std::size_t total, double confidence = 0.95);

/// P(X >= hits) for X binomial of `total` trials at rate p.
double binomial_at_least(std::size_t hits, std::size_t total, double p);

/// Student's interval of a mean from independent values; all numbers for fewer than two.
Interval student_interval(std::span<const double> values, double confidence = 0.95);

/// Standard normal: the z with P(Z < z) = p, p in (0, 1).
double normal_quantile(double p);

/// Hits and trials of one pile.
struct ClusterCount {
  double hits = 0;
  double total = 0;
};
/// Bootstrap of sum(hits) / sum(total) over whole piles, corrected for bias and skewness (BCa, Efron 1987), its normal
/// quantiles widened to Student's times sqrt(n / (n - 1)), since a resample of few piles varies too little (Hesterberg
/// 2015). Never narrower on either side than Wilson's interval at the effective number of trials (Rao and Scott 1992),
/// since thirty piles that hold none of the bad ones have nothing to resample them from. How often it holds the truth:
/// `bench gate`, docs/gate.md. With fewer than two piles, or when every pile agrees (all hits or none), it falls back
/// to the Wilson interval of the pooled counts, which is then the honest one.
Interval cluster_bootstrap(std::span<const ClusterCount> piles, Seed seed, int resamples = 4000,
                           double confidence = 0.95);

/// The statistic of `resamples` resamples of the units 0 .. units-1, drawn with replacement.
std::vector<double> bootstrap(std::size_t units, Seed seed, int resamples,
                              const std::function<double(std::span<const std::size_t> drawn)>& statistic);

/// Linear interpolation between order statistics (type 7); NaN for an empty sample.
double quantile(std::vector<double> values, double q);
double mean(std::span<const double> values);

}  // namespace binpick

#include "evaluation/statistics.hpp"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/check.hpp"

namespace binpick {

namespace {

/// Wilson 1927: the rates from which the share p of n trials is z standard errors away.
Interval wilson_of(double p, double n, double z) {
  const double middle = p + z * z / (2 * n);
  const double spread = z * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
  const double scale = 1 + z * z / n;
  return {p <= 0 ? 0.0 : std::max(0.0, (middle - spread) / scale),
          p >= 1 ? 1.0 : std::min(1.0, (middle + spread) / scale)};
}

}  // namespace

Interval wilson_interval(std::size_t hits, std::size_t total, double confidence) {
  BP_CHECK(hits <= total, hits << " of " << total);
  BP_CHECK(confidence > 0 && confidence < 1, "confidence " << confidence);
  if (total == 0) return {0, 1};
  const double n = static_cast<double>(total);
  return wilson_of(static_cast<double>(hits) / n, n, normal_quantile(0.5 + confidence / 2));
}

Interval clopper_pearson(std::size_t hits, std::size_t total, double confidence) {
  BP_CHECK(hits <= total, hits << " of " << total);
  BP_CHECK(confidence > 0 && confidence < 1, "confidence " << confidence);
  if (total == 0) return {0, 1};
  using Binomial = boost::math::binomial_distribution<>;
  const double n = static_cast<double>(total), k = static_cast<double>(hits), tail = (1 - confidence) / 2;
  return {hits == 0 ? 0.0 : Binomial::find_lower_bound_on_p(n, k, tail),
          hits == total ? 1.0 : Binomial::find_upper_bound_on_p(n, k, tail)};
}

double binomial_at_least(std::size_t hits, std::size_t total, double p) {
  BP_CHECK(p >= 0 && p <= 1, "p " << p);
  if (hits == 0) return 1;
  if (hits > total) return 0;
  const boost::math::binomial_distribution<> binomial(static_cast<double>(total), p);
  return boost::math::cdf(boost::math::complement(binomial, static_cast<double>(hits - 1)));
}

Interval student_interval(std::span<const double> values, double confidence) {
  BP_CHECK(confidence > 0 && confidence < 1, "confidence " << confidence);
  const double infinity = std::numeric_limits<double>::infinity();
  if (values.size() < 2) return {-infinity, infinity};
  const double n = static_cast<double>(values.size()), middle = mean(values);
  double squares = 0;
  for (const double value : values) squares += (value - middle) * (value - middle);
  const double t = boost::math::quantile(boost::math::students_t(n - 1), 0.5 + confidence / 2);
  const double half = t * std::sqrt(squares / (n - 1) / n);
  return {middle - half, middle + half};
}

double normal_quantile(double p) {
  BP_CHECK(p > 0 && p < 1, "p " << p);
  return boost::math::quantile(boost::math::normal(), p);
}

std::vector<double> bootstrap(std::size_t units, Seed seed, int resamples,
                              const std::function<double(std::span<const std::size_t>)>& statistic) {
  BP_CHECK(resamples > 0, "resamples " << resamples);
  std::vector<double> values;
  std::vector<std::size_t> drawn(units);
  for (int i = 0; i < resamples; ++i) {
    Rng rng = seed.child("resample", static_cast<std::uint64_t>(i)).rng();
    for (std::size_t& unit : drawn) unit = rng.below(units);
    values.push_back(statistic(drawn));
  }
  return values;
}

namespace {

/// How far the resamples' median lies from the rate, in normal units; ties count half.
double median_bias(std::span<const double> rates, double rate) {
  double below = 0;
  for (const double r : rates) below += r < rate ? 1 : r == rate ? 0.5 : 0;
  const double n = static_cast<double>(rates.size());
  return normal_quantile(std::clamp(below / n, 0.5 / n, 1 - 0.5 / n));
}

/// How fast the rate's standard error changes with the rate: a sixth of the skewness of what each pile adds.
double jackknife_acceleration(std::span<const ClusterCount> piles, const ClusterCount& pooled) {
  std::vector<double> without;
  for (const ClusterCount& pile : piles) {
    const double total = pooled.total - pile.total;
    without.push_back(total > 0 ? (pooled.hits - pile.hits) / total : 0);
  }
  const double middle = mean(without);
  double squares = 0, cubes = 0;
  for (const double w : without) {
    squares += (middle - w) * (middle - w);
    cubes += (middle - w) * (middle - w) * (middle - w);
  }
  return squares > 0 ? cubes / (6 * std::pow(squares, 1.5)) : 0;
}

/// Wilson's interval of the number of independent trials that would know the rate as well as the piles do (Rao and
/// Scott, Biometrics 48, 1992: total over design effect), at most all of them.
Interval effective_wilson(std::span<const ClusterCount> piles, const ClusterCount& pooled, double t) {
  const double rate = pooled.hits / pooled.total, n = static_cast<double>(piles.size());
  double squares = 0;
  for (const ClusterCount& pile : piles) squares += std::pow(pile.hits - rate * pile.total, 2);
  const double variance = n / (n - 1) * squares / (pooled.total * pooled.total);
  const double independent = rate * (1 - rate);
  return wilson_of(rate, variance * pooled.total > independent ? independent / variance : pooled.total, t);
}

}  // namespace

Interval cluster_bootstrap(std::span<const ClusterCount> piles, Seed seed, int resamples, double confidence) {
  std::vector<ClusterCount> counted;  // a pile that asked nothing says nothing
  ClusterCount pooled;
  for (const ClusterCount& pile : piles) {
    BP_CHECK(pile.hits >= 0 && pile.hits <= pile.total, pile.hits << " of " << pile.total);
    if (pile.total <= 0) continue;
    counted.push_back(pile);
    pooled.hits += pile.hits;
    pooled.total += pile.total;
  }
  if (counted.size() < 2 || pooled.hits <= 0 || pooled.hits >= pooled.total) {
    return wilson_interval(static_cast<std::size_t>(std::llround(pooled.hits)),
                           static_cast<std::size_t>(std::llround(pooled.total)), confidence);
  }
  const std::vector<double> rates = bootstrap(counted.size(), seed, resamples, [&](std::span<const std::size_t> drawn) {
    ClusterCount sum;
    for (const std::size_t k : drawn) {
      sum.hits += counted[k].hits;
      sum.total += counted[k].total;
    }
    return sum.hits / sum.total;
  });
  const double rate = pooled.hits / pooled.total;
  const double bias = median_bias(rates, rate), acceleration = jackknife_acceleration(counted, pooled);
  const double n = static_cast<double>(counted.size());
  const double t = boost::math::quantile(boost::math::students_t(n - 1), 0.5 + confidence / 2);
  const double z = std::sqrt(n / (n - 1)) * t;
  const auto corrected = [&](double at) {
    const double stretch = 1 - acceleration * (bias + at);
    if (stretch <= 0) return at < 0 ? 0.0 : 1.0;
    return boost::math::cdf(boost::math::normal(), bias + (bias + at) / stretch);
  };
  const Interval resampled{quantile(rates, corrected(-z)), quantile(rates, corrected(z))};
  const Interval wilson = effective_wilson(counted, pooled, t);
  return {std::min(resampled.low, wilson.low), std::max(resampled.high, wilson.high)};
}

double quantile(std::vector<double> values, double q) {
  BP_CHECK(q >= 0 && q <= 1, "q " << q);
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const double place = q * static_cast<double>(values.size() - 1);  // Hyndman and Fan's type 7
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
}

double mean(std::span<const double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace binpick

// The metrics of a comparison: each as a share, a verdict per pile or a quantile, with its test and its interval.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "evaluation/comparison.hpp"
#include "evaluation/paired_shares.hpp"
#include "evaluation/weighted_quantile.hpp"

namespace binpick {
namespace {

using Piles = std::vector<const PileFigures*>;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Metric {
  MetricComparison head;
  std::function<ClusterCount(const PileFigures&)> count;          // shares and verdicts: good of all
  std::function<std::vector<double>(const PileFigures&)> values;  // quantiles: more is worse
  double q = 0.5;
};

double rate(const ClusterCount& c) { return c.total > 0 ? c.hits / c.total : kNaN; }

Seed stream(const MetricComparison& metric) { return Seed{}.child("compare").child(metric.name); }

void count_sides(const std::vector<double>& losses, MetricComparison& metric) {
  for (const double loss : losses) {
    metric.worse_piles += loss > 0 ? 1 : 0;
    metric.better_piles += loss < 0 ? 1 : 0;
  }
}

void compare_share(const Metric& metric, const Piles& base, const Piles& fresh, const Look& look,
                   MetricComparison& result) {
  std::vector<SharePair> pairs;
  SharePair sum;
  for (std::size_t i = 0; i < base.size(); ++i) {
    pairs.push_back({metric.count(*base[i]), metric.count(*fresh[i])});
    sum += pairs.back();
  }
  result.base = rate(sum.base);
  result.fresh = rate(sum.fresh);
  result.loss = result.base - result.fresh;
  const std::vector<double> losses = pile_losses(pairs);
  count_sides(losses, result);
  result.p = sign_flip_worse(losses, stream(result));
  if (look.intervals) result.interval = loss_interval(pairs, stream(result), look.confidence, look.resamples);
}

void compare_verdict(const Metric& metric, const Piles& base, const Piles& fresh, const Look& look,
                     MetricComparison& result) {
  PairedVerdicts verdicts;
  for (std::size_t i = 0; i < base.size(); ++i) {
    const ClusterCount before = metric.count(*base[i]), after = metric.count(*fresh[i]);
    if (before.total <= 0 || after.total <= 0) continue;
    const bool was = before.hits > 0, is = after.hits > 0;
    ++(was ? is ? verdicts.both : verdicts.lost : is ? verdicts.won : verdicts.neither);
  }
  const double n = static_cast<double>(verdicts.total());
  result.base = n > 0 ? static_cast<double>(verdicts.both + verdicts.lost) / n : kNaN;
  result.fresh = n > 0 ? static_cast<double>(verdicts.both + verdicts.won) / n : kNaN;
  result.loss = result.base - result.fresh;
  result.worse_piles = verdicts.lost;
  result.better_piles = verdicts.won;
  result.p = mcnemar_worse(verdicts);
  if (look.intervals) result.interval = tango_interval(verdicts, look.confidence);
}

double difference(double fresh, double base) {
  return fresh == base ? 0 : fresh - base;  // infinite both: no loss
}

Interval quantile_interval(const WeightedQuantile& base, const WeightedQuantile& fresh, double q, std::size_t differing,
                           std::size_t piles, const MetricComparison& metric, const Look& look) {
  if (differing < kFewDifferingPiles) {
    const double most = clopper_pearson(differing, piles, look.confidence).high;
    const double here = base.quantile(q);
    return {difference(base.quantile(std::max(0.0, q - most)), here),
            q + most < 1 ? difference(base.quantile(q + most), here) : kInfinity};
  }
  std::vector<int> times(piles);
  const std::vector<double> losses =
      bootstrap(piles, stream(metric), look.resamples, [&](std::span<const std::size_t> drawn) {
        std::fill(times.begin(), times.end(), 0);
        for (const std::size_t k : drawn) ++times[k];
        return difference(fresh.quantile(q, times), base.quantile(q, times));
      });
  // Order statistics themselves: between finite and infinite there is nothing to interpolate.
  std::vector<double> sorted = losses;
  for (double& loss : sorted) loss = std::isnan(loss) ? kInfinity : loss;
  std::sort(sorted.begin(), sorted.end());
  const double last = static_cast<double>(sorted.size() - 1), tail = (1 - look.confidence) / 2;
  return {sorted[static_cast<std::size_t>(std::floor(tail * last))],
          sorted[static_cast<std::size_t>(std::ceil((1 - tail) * last))]};
}

void compare_quantile(const Metric& metric, const Piles& base, const Piles& fresh, const Look& look,
                      MetricComparison& result) {
  WeightedQuantile before(base, metric.values), after(fresh, metric.values);
  WeightedQuantile pooled(base, metric.values);
  pooled.add(fresh, metric.values);
  result.base = before.quantile(metric.q);
  result.fresh = after.quantile(metric.q);
  result.loss = difference(result.fresh, result.base);
  // How many of a pile's values lie within the pooled quantile, which does not change when results change places.
  const double bar = pooled.quantile(metric.q);
  std::vector<SharePair> pairs;
  std::size_t differing = 0;
  for (std::size_t i = 0; i < base.size(); ++i) {
    std::vector<double> a = metric.values(*base[i]), b = metric.values(*fresh[i]);
    const auto within = [&](const std::vector<double>& v) {  // an infinite bar asks who is found at all
      const auto hits = std::count_if(v.begin(), v.end(), [&](double x) { return x <= bar && std::isfinite(x); });
      return ClusterCount{static_cast<double>(hits), static_cast<double>(v.size())};
    };
    pairs.push_back({within(a), within(b)});
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    differing += a != b ? 1 : 0;
  }
  const std::vector<double> losses = pile_losses(pairs);
  count_sides(losses, result);
  result.p = sign_flip_worse(losses, stream(result));
  if (look.intervals && !std::isnan(result.base) && !std::isnan(result.fresh)) {
    result.interval = quantile_interval(before, after, metric.q, differing, base.size(), result, look);
  }
}

MetricComparison head(const char* name, const char* label, MetricKind kind, const MetricRule& rule,
                      Unit unit = Unit::kNone) {
  MetricComparison head;
  head.name = name;
  head.label = label;
  head.kind = kind;
  head.rule = rule;
  head.unit = unit;
  head.interval = {-kInfinity, kInfinity};
  return head;
}

Metric share(const char* name, const char* label, const MetricRule& rule, ClusterCount PileFigures::*count) {
  return {head(name, label, MetricKind::kShare, rule), [count](const PileFigures& p) { return p.*count; }, {}, 0};
}

// Errors of the right poses; what was visible and not found is an error without bound, never left out: dropping it
// would reward an estimator that gives up.
std::function<std::vector<double>(const PileFigures&)> errors(std::vector<double> PileFigures::*member) {
  return [member](const PileFigures& pile) {
    std::vector<double> values = pile.*member;
    values.insert(values.end(), pile.missed, kInfinity);
    return values;
  };
}

std::vector<Metric> metrics_of(const GateRules& r) {
  const auto quantile_of = [](const char* name, const char* label, const MetricRule& rule, Unit unit, double q,
                              std::function<std::vector<double>(const PileFigures&)> values) {
    return Metric{head(name, label, MetricKind::kQuantile, rule, unit), {}, std::move(values), q};
  };
  const auto first_pick = [](const PileFigures& p) {
    return ClusterCount{p.first_pick == "Succeeded" ? 1.0 : 0.0, p.first_pick.empty() ? 0.0 : 1.0};
  };
  const auto bin_cleared = [](const PileFigures& p) {
    return ClusterCount{p.cleared.hits == p.cleared.total ? 1.0 : 0.0, p.cleared.total > 0 ? 1.0 : 0.0};
  };
  const auto t = errors(&PileFigures::translations), a = errors(&PileFigures::rotations);
  const auto cycles = [](const PileFigures& p) { return p.cycles; };
  return {
      share("picks", "picks succeeded", r.picks, &PileFigures::picks),
      {head("first_pick", "first pick succeeded", MetricKind::kVerdict, r.first_pick), first_pick, {}, 0},
      {head("bin_cleared", "bins picked empty", MetricKind::kVerdict, r.bin_cleared), bin_cleared, {}, 0},
      share("cleared", "parts cleared", r.cleared, &PileFigures::cleared),
      share("recall", "recall, every look", r.recall, &PileFigures::recall),
      share("recall_first_look", "recall, first look", r.recall_first_look, &PileFigures::recall_first_look),
      share("precision", "precision", r.precision, &PileFigures::precision),
      quantile_of("translation_median", "translation error, median", r.translation_median, Unit::kLength, 0.5, t),
      quantile_of("translation_p95", "translation error, 95 %", r.translation_p95, Unit::kLength, 0.95, t),
      quantile_of("rotation_median", "rotation error, median", r.rotation_median, Unit::kAngle, 0.5, a),
      quantile_of("rotation_p95", "rotation error, 95 %", r.rotation_p95, Unit::kAngle, 0.95, a),
      quantile_of("cycle", "cycle, median", r.cycle, Unit::kTime, 0.5, cycles),
  };
}

bool estimable(const MetricComparison& m) {
  const bool base = !std::isnan(m.base), fresh = !std::isnan(m.fresh);
  return base && fresh && !(std::isinf(m.base) && std::isinf(m.fresh));
}

void judge(const Look& look, std::vector<MetricComparison>& metrics) {
  std::vector<double> p_values;
  for (const MetricComparison& m : metrics)
    if (m.rule.gate && estimable(m)) p_values.push_back(m.p);
  const std::vector<double> adjusted = holm(p_values);
  std::size_t next = 0;
  for (MetricComparison& m : metrics) {
    const bool known = estimable(m);
    m.p_holm = m.rule.gate && known ? adjusted[next++] : kNaN;
    const bool holds = look.intervals && m.interval.high < m.rule.margin;
    const bool worse = m.rule.gate && m.p_holm <= look.alpha && m.loss > 0;
    m.finding = !known ? Finding::kNotEstimable : holds ? Finding::kHolds : worse ? Finding::kWorse : Finding::kUnclear;
  }
}

}  // namespace

std::vector<MetricComparison> compare_metrics(const Piles& base, const Piles& fresh, const GateRules& rules,
                                              const Look& look) {
  std::vector<MetricComparison> results;
  for (const Metric& metric : metrics_of(rules)) {
    MetricComparison result = metric.head;
    if (metric.head.kind == MetricKind::kShare) compare_share(metric, base, fresh, look, result);
    if (metric.head.kind == MetricKind::kVerdict) compare_verdict(metric, base, fresh, look, result);
    if (metric.head.kind == MetricKind::kQuantile) compare_quantile(metric, base, fresh, look, result);
    results.push_back(std::move(result));
  }
  judge(look, results);
  return results;
}

}  // namespace binpick

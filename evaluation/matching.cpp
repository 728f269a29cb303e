#include "evaluation/matching.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/check.hpp"
#include "evaluation/metric.hpp"

namespace binpick {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kIgnoredBelow = 0.1;  // visible fraction
constexpr double kRecallFrom = 0.5;    // visible fraction
enum Threshold { kRight, kTight, kTwoMillimetres, kThresholds };

double limit_of(int threshold, double diameter) {
  return threshold == kRight ? 0.1 * diameter : threshold == kTight ? 0.05 * diameter : 0.002;
}

using Match = std::vector<std::optional<std::size_t>>;  // instance per estimate

/// One look: poses of the estimates in W, and every MSSD that some threshold can see.
struct Look {
  const EstimateResult& result;
  const GroundTruth& truth;
  const std::vector<ScoringModel>& models;
  std::vector<Pose> X_WP_est;
  std::vector<std::vector<double>> mssd;  ///< [estimate][instance]; infinite: out of reach of every threshold
  std::vector<std::size_t> by_score;

  std::size_t estimates() const { return result.estimates.size(); }
  std::size_t instances() const { return truth.instances.size(); }
  const ScoringModel& model(std::size_t estimate) const { return models[result.estimates[estimate].part]; }
  bool comparable(std::size_t estimate, std::size_t instance) const {
    return truth.instances[instance].part == result.estimates[estimate].part && X_WP_est[estimate].matrix().allFinite();
  }
};

std::vector<std::size_t> order_by_score(const std::vector<PoseEstimate>& estimates) {
  std::vector<std::size_t> order(estimates.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto score = [&](std::size_t i) { return std::isnan(estimates[i].score) ? -kInfinity : estimates[i].score; };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return score(a) > score(b); });
  return order;
}

Look look_at(const EstimateResult& result, const Pose& X_WC, const GroundTruth& truth,
             const std::vector<ScoringModel>& models) {
  Look look{result, truth, models, {}, {}, order_by_score(result.estimates)};
  const std::unique_ptr<Metric> mssd = make_metric("mssd");
  for (const PoseEstimate& estimate : result.estimates) {
    BP_CHECK(estimate.part < models.size(), "part " << estimate.part << " of " << models.size());
    look.X_WP_est.push_back(X_WC * estimate.X_CP);
  }
  look.mssd.assign(look.estimates(), std::vector<double>(look.instances(), kInfinity));
  for (std::size_t e = 0; e < look.estimates(); ++e) {
    const ScoringModel& model = look.model(e);
    const double reach = std::max(limit_of(kRight, model.diameter()), limit_of(kTwoMillimetres, model.diameter()));
    for (std::size_t i = 0; i < look.instances(); ++i) {
      const Pose& X_WP_true = truth.instances[i].X_WP;
      if (!look.comparable(e, i) || model.mssd_lower_bound(look.X_WP_est[e], X_WP_true) >= reach) continue;
      look.mssd[e][i] = mssd->error(look.X_WP_est[e], X_WP_true, model);
    }
  }
  return look;
}

/// The free instance of the wanted visibility that is nearest to the estimate, strictly within the limit.
std::optional<std::size_t> best_free(const Look& look, std::size_t estimate, double limit,
                                     const std::vector<bool>& taken, bool hidden) {
  std::optional<std::size_t> best;
  double least = limit;
  for (std::size_t i = 0; i < look.instances(); ++i) {
    if (taken[i] || (look.truth.instances[i].visible_fraction < kIgnoredBelow) != hidden) continue;
    if (look.mssd[estimate][i] >= least) continue;
    least = look.mssd[estimate][i];
    best = i;
  }
  return best;
}

Match match(const Look& look, int threshold) {
  Match matched(look.estimates());
  std::vector<bool> taken(look.instances(), false);
  for (std::size_t e : look.by_score) {
    const double limit = limit_of(threshold, look.model(e).diameter());
    matched[e] = best_free(look, e, limit, taken, false);
    if (!matched[e]) matched[e] = best_free(look, e, limit, taken, true);
    if (matched[e]) taken[*matched[e]] = true;
  }
  return matched;
}

std::size_t count_found(const Look& look, const Match& matched) {
  return static_cast<std::size_t>(std::count_if(matched.begin(), matched.end(), [&](const auto& instance) {
    return instance && look.truth.instances[*instance].visible_fraction >= kRecallFrom;
  }));
}

/// Least MSSD over all instances of the part, however far: by rising lower bound, until no other can be nearer.
std::optional<std::size_t> nearest_instance(const Look& look, std::size_t estimate) {
  struct Candidate {
    double bound;
    std::size_t instance;
  };
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < look.instances(); ++i) {
    if (!look.comparable(estimate, i)) continue;
    candidates.push_back(
        {look.model(estimate).mssd_lower_bound(look.X_WP_est[estimate], look.truth.instances[i].X_WP), i});
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.bound < b.bound; });
  const std::unique_ptr<Metric> mssd = make_metric("mssd");
  std::optional<std::size_t> nearest;
  double least = kInfinity;
  for (const auto& [bound, instance] : candidates) {
    if (bound >= least) break;
    const double known = look.mssd[estimate][instance];
    const double error = known < kInfinity ? known
                                           : mssd->error(look.X_WP_est[estimate], look.truth.instances[instance].X_WP,
                                                         look.model(estimate));
    if (error >= least) continue;
    least = error;
    nearest = instance;
  }
  return nearest;
}

PoseError unknown_error() {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  return {nan, nan, nan, nan, Eigen::Vector3d::Constant(nan), Eigen::Vector3d::Constant(nan)};
}

MatchedEstimate judge(const Look& look, std::size_t e, const std::array<Match, kThresholds>& matches) {
  const PoseEstimate& estimate = look.result.estimates[e];
  MatchedEstimate judged;
  judged.estimate = e;
  judged.score = estimate.score;
  judged.fit_rms = estimate.fit_rms;
  judged.right = matches[kRight][e].has_value();
  judged.right_tight = matches[kTight][e].has_value();
  judged.right_2mm = matches[kTwoMillimetres][e].has_value();
  judged.instance = judged.right ? matches[kRight][e] : nearest_instance(look, e);
  judged.ignored = judged.right && look.truth.instances[*judged.instance].visible_fraction < kIgnoredBelow;
  judged.error = judged.instance
                     ? pose_error(look.X_WP_est[e], look.truth.instances[*judged.instance].X_WP, look.model(e))
                     : unknown_error();
  return judged;
}

}  // namespace

PoseChecker::PoseChecker(std::span<const Part> parts) : models_(parts.begin(), parts.end()) {}

PoseCheck PoseChecker::check(const EstimateResult& result, const Pose& X_WC_believed, const GroundTruth& truth) const {
  const Look look = look_at(result, X_WC_believed, truth, models_);
  const std::array<Match, kThresholds> matches = {match(look, kRight), match(look, kTight),
                                                  match(look, kTwoMillimetres)};
  PoseCheck check;
  for (std::size_t e = 0; e < look.estimates(); ++e) {
    check.estimates.push_back(judge(look, e, matches));
    if (check.estimates.back().ignored) continue;
    ++check.counted;
    if (check.estimates.back().right) ++check.right;
  }
  for (const GroundTruth::Instance& instance : truth.instances) {
    if (instance.visible_fraction >= kRecallFrom) ++check.visible;
  }
  check.found = count_found(look, matches[kRight]);
  check.found_tight = count_found(look, matches[kTight]);
  check.found_2mm = count_found(look, matches[kTwoMillimetres]);
  return check;
}

PoseCheck check_poses(const EstimateResult& result, const Pose& X_WC_believed, const GroundTruth& truth,
                      std::span<const Part> parts) {
  return PoseChecker(parts).check(result, X_WC_believed, truth);
}

}  // namespace binpick

#include "tools/bench/perception_score.hpp"

#include <cmath>
#include <limits>

#include "core/symmetry.hpp"

namespace binpick {
namespace {

constexpr double kVisible = 0.5, kPartly = 0.3;
constexpr double kRightShare = 0.1;  // of the diameter
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

using Instance = GroundTruth::Instance;

/// By which of the three thresholds was the instance found?
struct Found {
  bool right = false, tight = false;
};

std::vector<Found> found_instances(const LookJudge& look) {
  std::vector<Found> found(look.truth.instances.size());
  for (const MatchedEstimate& e : look.check.estimates) {
    if (!e.instance) continue;
    found[*e.instance].right |= e.right;
    found[*e.instance].tight |= e.right_tight;
  }
  return found;
}

void count(ClusterCount& counter, bool hit) {
  counter.total += 1;
  counter.hits += hit ? 1 : 0;
}

MissedInstance missed_instance(const LookJudge& look, std::size_t index) {
  const Instance& instance = look.truth.instances[index];
  MissedInstance missed;
  missed.body = instance.body;
  missed.X_CP = look.X_WC.inverse() * instance.X_WP;
  missed.visible_fraction = instance.visible_fraction;
  missed.visible_pixels = instance.visible_pixels;
  missed.ambiguous_view = look.ambiguous[index];
  missed.nearest_mssd = missed.nearest_score = kNan;
  for (const MatchedEstimate& e : look.check.estimates) {
    if (e.instance != index || !(std::isnan(missed.nearest_mssd) || e.error.mssd < missed.nearest_mssd)) continue;
    missed.nearest_mssd = e.error.mssd;
    missed.nearest_score = e.score;
  }
  return missed;
}

WrongEstimate wrong_estimate(const LookJudge& look, const MatchedEstimate& e) {
  const PoseEstimate& estimate = look.result.estimates[e.estimate];
  WrongEstimate wrong;
  wrong.rank = e.estimate;
  wrong.score = e.score;
  wrong.ambiguous = estimate.ambiguous;
  wrong.X_CP = estimate.X_CP;
  wrong.error = e.error;
  if (!e.instance) return wrong;
  const Instance& instance = look.truth.instances[*e.instance];
  wrong.body = instance.body;
  wrong.visible_fraction = instance.visible_fraction;
  wrong.visible_pixels = instance.visible_pixels;
  wrong.ambiguous_view = look.ambiguous[*e.instance];
  wrong.duplicate = e.error.mssd < kRightShare * look.parts[estimate.part].diameter;
  return wrong;
}

RightEstimate right_estimate(const LookJudge& look, const MatchedEstimate& e) {
  const PoseEstimate& estimate = look.result.estimates[e.estimate];
  const Part& part = look.parts[estimate.part];
  const Pose X_CP_true = look.X_WC.inverse() * look.truth.instances[*e.instance].X_WP;
  const Pose X_CP_twin = nearest_equivalent(X_CP_true, estimate.X_CP, part.symmetry);
  const Eigen::Vector3d off_C = estimate.X_CP * part.box_center_P - X_CP_twin * part.box_center_P;
  return {e.error.translation, off_C.head<2>().norm(), off_C.z(), e.error.rotation};
}

void add_instances(const LookJudge& look, std::size_t part, LookScore& score) {
  const std::vector<Found> found = found_instances(look);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Instance& instance = look.truth.instances[i];
    if (instance.part != part || instance.visible_fraction < kPartly) continue;
    if (instance.visible_fraction < kVisible) {
      count(score.recall_partly, found[i].right);
      continue;
    }
    count(score.recall, found[i].right);
    count(score.recall_tight, found[i].tight);
    if (!look.ambiguous[i]) count(score.recall_clear, found[i].right);
    score.found_by_pixels.push_back({instance.visible_pixels, found[i].right});
    if (!found[i].right) score.missed.push_back(missed_instance(look, i));
  }
}

void add_estimates(const LookJudge& look, std::size_t part, LookScore& score) {
  for (const MatchedEstimate& e : look.check.estimates) {
    if (look.result.estimates[e.estimate].part != part) continue;
    const bool flagged = look.result.estimates[e.estimate].ambiguous;
    const bool clear = !e.instance || !look.ambiguous[*e.instance];
    if (!score.top1) score.top1 = e.right, score.top1_in_clear_view = clear;
    if (e.ignored) continue;
    count(score.precision, e.right);
    if (clear) count(score.precision_clear, e.right);
    if (!flagged) count(score.precision_sure, e.right);
    score.scored.push_back(
        {e.score, e.right, flagged, look.result.estimates[e.estimate].inlier_fraction, e.fit_rms, e.estimate});
    if (e.right)
      score.right.push_back(right_estimate(look, e));
    else
      score.wrong.push_back(wrong_estimate(look, e));
  }
  if (!score.top1 && score.recall.total > 0) score.top1 = false;  // something lay in full view
}

}  // namespace

LookScore LookJudge::of_part(std::size_t part, std::uint64_t seed) const {
  LookScore score;
  score.seed = seed;
  add_instances(*this, part, score);
  add_estimates(*this, part, score);
  for (MissedInstance& missed : score.missed) missed.seed = seed;
  for (WrongEstimate& wrong : score.wrong) wrong.seed = seed;
  return score;
}

}  // namespace binpick

// How the weights of perception/score_calibration.cpp are made: what every returned pose said of itself, and whether it
// was right, fitted by a logistic model (Newton's method, ridge). Whether it holds for a part it has not seen is told
// by leaving out one part after the other.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tools/bench/perception_bench.hpp"

namespace binpick {

struct ScoreSample {
  std::string part, sensor;
  ScoreFeatures features{};
  bool right = false;
  bool ambiguous = false;
};

/// part,sensor,seed,right,ambiguous and the features; a line an estimate.
std::string features_csv(std::span<const PerceptionRow> rows);
/// Throws SpecError naming file and line.
std::vector<ScoreSample> read_features(const std::string& path);

/// Minimises the mean log loss of the samples that are not ambiguous, plus ridge / 2 |w|^2 / n of the terms scaled to
/// unit spread (not of the constant). A wrong sample counts `wrong_weight` times: the prior.
ScoreTerms fit_weights(std::span<const ScoreSample> samples, double ridge, double wrong_weight = 1);

double probability(const ScoreTerms& weights, const ScoreSample& sample);

/// What a threshold keeps: of the right poses, and how many of the kept ones are right.
struct Threshold {
  double score = 0;
  std::size_t kept = 0, kept_right = 0, right = 0;
};
std::vector<Threshold> thresholds(const ScoreTerms& weights, std::span<const ScoreSample> samples);

/// Weights as C++, log loss, calibration error inside and on left-out parts, thresholds.
std::string fit_report(std::span<const ScoreSample> samples, double ridge, double wrong_weight = 1);

}  // namespace binpick

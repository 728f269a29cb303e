// The score of a pose: the probability that it is right (MSSD below a tenth of the diameter), with one meaning for
// every part and sensor. A logistic model on what the drawn part says of itself:
//   p = 1 / (1 + exp(-sum_k w_k t_k)),  halved for an ambiguous pose (two twins, and no way to tell)
// Its terms t are the features f and, nearly all of them once more, f times the sensor's noise: a ragged outline or a
// normal that turns elsewhere means little under a noisy sensor and gives a wrong pose away under a quiet one.
// The weights stand in score_calibration.cpp with the command that made them: heaps of seeds below 1000, all shipped
// parts, four sensors, acceptance thresholds opened so that wrong poses are seen, too.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/symmetry.hpp"
#include "perception/view_check.hpp"

namespace binpick {

constexpr std::size_t kScoreFeatures = 21;
using ScoreFeatures = std::array<double, kScoreFeatures>;
const std::array<std::string, kScoreFeatures>& score_feature_names();

constexpr std::size_t kScoreTerms = 39;
using ScoreTerms = std::array<double, kScoreTerms>;
/// The features, and those that the noise gives another meaning times (noise - that of a D435 on a part of 100 mm).
ScoreTerms score_terms(const ScoreFeatures& features);

/// `symmetry_twists`: directions of P in which a symmetric part has no pose to be known (translation, rotation).
ScoreFeatures score_features(const Scene& scene, const SurfaceModel& model, const Candidate& candidate,
                             const std::vector<Vector6d>& symmetry_twists);

/// 0 .. 1.
double calibrated_score(const ScoreFeatures& features, bool ambiguous);

/// Largest standard deviation of a corner of the part's box, m, with the symmetric twists held.
double corner_deviation(const Matrix6d& covariance, const Eigen::AlignedBox3f& box_P,
                        const std::vector<Vector6d>& symmetry_twists);

/// Turns about the axis of revolution, or about the centre of a sphere.
std::vector<Vector6d> symmetry_twists(const Symmetry& symmetry);

}  // namespace binpick

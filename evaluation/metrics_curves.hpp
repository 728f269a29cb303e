// What the right and wrong estimates of a data set tell beside its scores: precision against recall, how well scores
// tell the chance of being right, recall by how much of an instance is visible.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "evaluation/metrics_scores.hpp"

namespace binpick {

struct CurvePoint {
  double score = 0;  ///< estimates of at least this score
  double precision = 0, recall = 0;
};

/// One point a distinct score, falling; pooled over objects. `judged` by descending score.
std::vector<CurvePoint> precision_recall(const std::vector<Judged>& judged, std::size_t targets);

/// Scores as probabilities (Brier 1950; expected calibration error: Naeini et al., AAAI 2015).
struct Calibration {
  struct Bin {
    double low = 0, high = 0;  ///< scores low <= s < high, the last bin with its end
    std::size_t count = 0, right = 0;
    double mean_score = 0;
  };
  std::vector<Bin> bins;      ///< of equal width over 0 .. 1, empty ones left out
  std::size_t outside = 0;    ///< estimates whose score is no probability; they are in no bin
  double expected_error = 0;  ///< mean over the estimates of |share right - mean score| of their bin
  double brier = 0;           ///< mean of (score - right)^2
};
Calibration score_calibration(const std::vector<Judged>& judged, int bins = 10);

struct VisibilityBin {
  double low = 0, high = 0;  ///< visible fraction, low <= f < high, the last bin with its end
  std::size_t instances = 0, found = 0;
};
/// Of all instances, those less visible than detection asks for among them.
std::vector<VisibilityBin> recall_by_visibility(std::span<const ImageErrors> images, const TableOf& table,
                                                double threshold, const std::vector<double>& edges);
/// 0, 0.1, 0.3, 0.5, 0.7, 0.9, 1
std::vector<double> visibility_edges();

}  // namespace binpick

// Does a score mean what it says? Of all estimates with a score near 0.9, which share was right?
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tools/bench/perception_bench.hpp"

namespace binpick {

/// Estimates whose scores lie in one interval.
struct ReliabilityBin {
  double low = 0, high = 0;  ///< scores: low <= score < high; the last includes 1
  double mean_score = 0;
  std::size_t right = 0, total = 0;
  Interval interval;  ///< Wilson, 95 %
};

/// `bins` of equal width over 0 .. 1; those without an estimate are left out.
std::vector<ReliabilityBin> reliability(std::span<const ScoredEstimate> estimates, int bins);

/// Mean distance between score and share of right ones, weighted by the estimates of each bin (expected calibration
/// error); NaN without estimates.
double calibration_error(std::span<const ReliabilityBin> bins);

/// folder/calibration.csv, .gp and, where gnuplot is installed, .png: every part and all parts of each estimator,
/// sensors pooled. A table of the latter for the terminal is returned. Throws StorageError.
std::string write_calibration(std::span<const PerceptionRow> rows, const std::string& folder);

}  // namespace binpick

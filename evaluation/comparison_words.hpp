// Private to this folder: words and numbers of a comparison, shared by its tables and pages.
#pragma once

#include <string>

#include "evaluation/comparison.hpp"

namespace binpick::words {

/// In mm, deg, s or %; "-" for what is no number.
std::string value(const MetricComparison& metric, double value);
/// The same for a loss, with its sign; points instead of % for shares.
std::string loss(const MetricComparison& metric, double value);
std::string loss_interval(const MetricComparison& metric);
std::string p_value(double p);
std::string finding(const MetricComparison& metric);
/// "of 300 common seeds 12 differ, the first is seed 17 (turn 0: frame)".
std::string bits(const Comparison& comparison);
std::string crashes(const Comparison& comparison);

}  // namespace binpick::words

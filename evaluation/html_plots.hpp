// Small inline drawings for the report: no script, no external file. Private to this folder.
#pragma once

#include <string>
#include <vector>

#include "evaluation/summary.hpp"

namespace binpick::html {

/// A track from 0 to 100 % with the interval as a band and the rate as a dot; `reference` (a share, < 0: none) as a
/// tick.
std::string rate_track(const Rate& rate, double reference);

/// Cumulative distribution of `values` (already in `unit`), with its median and 95 % marked. Values must be
/// finite; empty when there is nothing to draw.
std::string distribution(const std::string& title, const std::string& unit, std::vector<double> values);

}  // namespace binpick::html

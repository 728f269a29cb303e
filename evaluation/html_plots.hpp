// Small inline drawings for the report that need no script; its plots are Chart.js. Private to this folder.
#pragma once

#include <string>

#include "evaluation/summary.hpp"

namespace binpick::html {

/// A track from 0 to 100 % with the interval as a band and the rate as a dot; `reference` (a share, < 0: none) as a
/// tick.
std::string rate_track(const Rate& rate, double reference);

}  // namespace binpick::html

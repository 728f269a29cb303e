// What each step of `type: ppf` gains: the estimator as it is, each step taken out alone, and the paper's pipeline.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tools/bench/perception_bench.hpp"

namespace binpick {

/// The variants, the full estimator first. A step that moves into another setting changes here and nowhere else.
std::vector<ContenderSpec> ablation_variants();

/// A Markdown table for every part and sensor, a row a variant.
std::string ablation_table(std::span<const PerceptionRow> rows);

}  // namespace binpick

// A metric measures how wrong an estimated pose is, modulo the part's symmetry: zero on the truth and on its symmetric
// twins, growing with the error. To add one: metrics/<name>.cpp and one line in metrics/registry.cpp; the contract test
// then covers it. Metres and radians.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/config.hpp"
#include "core/pose.hpp"
#include "evaluation/scoring_model.hpp"

namespace binpick {

class Metric {
 public:
  virtual ~Metric() = default;
  virtual double error(const Pose& X_WP_est, const Pose& X_WP_true, const ScoringModel& model) const = 0;
};

struct MetricEntry {
  std::string name;
  Unit unit;  ///< kLength or kAngle
  std::string help;
  std::unique_ptr<Metric> (*make)();
};

const std::vector<MetricEntry>& metric_registry();

/// Throws SpecError naming the nearest known metric.
std::unique_ptr<Metric> make_metric(const std::string& name);

}  // namespace binpick

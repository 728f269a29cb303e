// What a comparison asks for: how much worse than the base each metric may be, and how sure one must be. Read from YAML
// (`binpick compare --margins F`, `binpick gate --margins F`); a file names only what differs from the defaults here.
#pragma once

#include <string>

#include "core/config.hpp"

namespace binpick {

struct MetricRule {
  double margin = 0;  ///< in the metric's unit: worse by less than this is as good as equal (non-inferiority)
  bool gate = true;   ///< false: shown, but takes no part in the verdict
};

struct GateRules {
  double alpha = 1e-3;       ///< of the whole family of metrics and looks: how often equal versions are called worse
  double confidence = 0.95;  ///< of the intervals, two-sided; "holds" is judged by the upper end
  int crash_budget = 0;      ///< trials of the new version that may end in an InternalError
  MetricRule picks{0.05};    ///< share of the attempts
  MetricRule first_pick{0.05};
  MetricRule bin_cleared{0.10};  ///< share of the piles picked to the last part
  MetricRule cleared{0.05};      ///< share of the parts
  MetricRule recall{0.02};
  MetricRule recall_first_look{0.02};
  MetricRule precision{0.02};
  MetricRule translation_median{0.2e-3, false};  ///< m
  MetricRule translation_p95{0.5e-3};            ///< m
  MetricRule rotation_median{0.0035, false};     ///< rad
  MetricRule rotation_p95{0.0175};               ///< rad
  MetricRule cycle{0.5};                         ///< s

  void visit(ConfigVisitor& v);
  void validate() const;  ///< throws SpecError
};

/// Throws SpecError, AssetError; an empty path gives the defaults.
GateRules read_gate_rules(const std::string& path);

}  // namespace binpick

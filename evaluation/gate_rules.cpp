#include "evaluation/gate_rules.hpp"

#include "core/error.hpp"
#include "core/yaml.hpp"

namespace binpick {
namespace {

void visit_rule(ConfigVisitor& v, const char* key, MetricRule& rule, Unit unit, const char* help) {
  v.section_with(
      key,
      [&](ConfigVisitor& inner) {
        inner.field("margin", rule.margin, unit, "worse by less than this is as good as equal");
        inner.field("gate", rule.gate, "false: shown only");
        if (inner.reading() && !(rule.margin > 0)) inner.fail("margin", "must be above 0");
      },
      help);
}

}  // namespace

void GateRules::visit(ConfigVisitor& v) {
  v.field("alpha", alpha, Unit::kNone, "how often equal versions may be called worse, over all metrics and looks");
  v.field("confidence", confidence, Unit::kNone, "of the intervals");
  v.field("crash_budget", crash_budget, "trials of the new version that may end in an InternalError");
  visit_rule(v, "picks", picks, Unit::kNone, "succeeded / attempted picks");
  visit_rule(v, "first_pick", first_pick, Unit::kNone, "piles whose first pick succeeded");
  visit_rule(v, "bin_cleared", bin_cleared, Unit::kNone, "piles picked to the last part");
  visit_rule(v, "cleared", cleared, Unit::kNone, "placed / dropped parts");
  visit_rule(v, "recall", recall, Unit::kNone, "found / visible parts, every look");
  visit_rule(v, "recall_first_look", recall_first_look, Unit::kNone, "found / visible parts, first look");
  visit_rule(v, "precision", precision, Unit::kNone, "right / counted estimates");
  visit_rule(v, "translation_median", translation_median, Unit::kLength, "error of found parts, a miss is infinite");
  visit_rule(v, "translation_p95", translation_p95, Unit::kLength, "error of found parts, a miss is infinite");
  visit_rule(v, "rotation_median", rotation_median, Unit::kAngle, "error of found parts, a miss is infinite");
  visit_rule(v, "rotation_p95", rotation_p95, Unit::kAngle, "error of found parts, a miss is infinite");
  visit_rule(v, "cycle", cycle, Unit::kTime, "simulated cycle of succeeded picks, median");
}

void GateRules::validate() const {
  if (!(alpha > 0 && alpha < 0.5)) throw SpecError("alpha: must be above 0 and below 0.5");
  if (!(confidence > 0.5 && confidence < 1)) throw SpecError("confidence: must be above 0.5 and below 1");
  if (crash_budget < 0) throw SpecError("crash_budget: must be at least 0");
}

GateRules read_gate_rules(const std::string& path) {
  GateRules rules;
  if (path.empty()) return rules;
  rules = read_config_file<GateRules>(path);
  try {
    rules.validate();
  } catch (const SpecError& error) {
    throw SpecError(path + ": " + error.what());
  }
  return rules;
}

}  // namespace binpick

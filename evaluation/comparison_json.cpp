// A comparison for machines: JSON (SI and radians), and JUnit XML for CI systems.
#include <tinyxml2.h>

#include <nlohmann/json.hpp>

#include "evaluation/comparison_words.hpp"

namespace binpick {
namespace {

using Json = nlohmann::ordered_json;

const char* name(Finding finding) {
  switch (finding) {
    case Finding::kHolds:
      return "holds";
    case Finding::kWorse:
      return "worse";
    case Finding::kUnclear:
      return "unclear";
    case Finding::kNotEstimable:
      return "not_estimable";
  }
  return "";
}

const char* name(Verdict verdict) {
  switch (verdict) {
    case Verdict::kNoBitChanged:
      return "no_bit_changed";
    case Verdict::kHolds:
      return "holds";
    case Verdict::kWorse:
      return "worse";
    case Verdict::kInconclusive:
      return "inconclusive";
  }
  return "";
}

const char* unit_name(Unit unit) {
  return unit == Unit::kLength ? "m" : unit == Unit::kAngle ? "rad" : unit == Unit::kTime ? "s" : "";
}

Json side(const PileSet& set) {
  return {{"path", set.name}, {"scenario", set.scenario}, {"scenario_hash", set.scenario_hash}};
}

Json metric_json(const MetricComparison& m) {
  return {{"name", m.name},
          {"unit", unit_name(m.unit)},
          {"gate", m.rule.gate},
          {"base", m.base},
          {"new", m.fresh},
          {"loss", m.loss},
          {"interval", {m.interval.low, m.interval.high}},
          {"margin", m.rule.margin},
          {"piles_worse", m.worse_piles},
          {"piles_better", m.better_piles},
          {"p", m.p},
          {"p_holm", m.p_holm},
          {"finding", name(m.finding)}};
}

// XML 1.0 has no control characters but tab and line ends, escaped or not.
std::string xml(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') c = ' ';
  return text;
}

struct Case {
  std::string name, failure, skipped, text;
};

std::vector<Case> cases(const Comparison& c) {
  std::vector<Case> all;
  all.push_back({"verdict", c.verdict == Verdict::kWorse ? sentence(c) : "",
                 c.verdict == Verdict::kInconclusive ? sentence(c) : "", sentence(c)});
  all.push_back({"crashes", c.too_many_crashes ? words::crashes(c) : "", "", words::crashes(c)});
  all.push_back({"bits", "", "", words::bits(c)});
  for (const MetricComparison& m : c.metrics) {
    const std::string what = m.label + ": " + words::value(m, m.base) + " -> " + words::value(m, m.fresh) + ", loss " +
                             words::loss(m, m.loss) + " (" + words::loss_interval(m) + "), margin " +
                             words::loss(m, m.rule.margin) + ", p " + words::p_value(m.p) + ", Holm " +
                             words::p_value(m.p_holm);
    const bool failed = m.rule.gate && m.finding == Finding::kWorse && c.verdict == Verdict::kWorse;
    const bool known = m.finding == Finding::kHolds || c.verdict == Verdict::kNoBitChanged || failed;
    all.push_back({m.name, failed ? what : "", known ? "" : words::finding(m), what});
  }
  for (const Flip& flip : c.flips) {
    if (!flip.lost) continue;
    all.push_back({"seed " + std::to_string(flip.seed), "", "a single pile is no verdict",
                   flip.what + " [" + flip.stage + "]\n" + replay_command(c, flip.seed)});
  }
  return all;
}

void print(tinyxml2::XMLPrinter& out, const Case& one) {
  out.OpenElement("testcase");
  out.PushAttribute("classname", "binpick.compare");
  out.PushAttribute("name", xml(one.name).c_str());
  if (!one.failure.empty()) {
    out.OpenElement("failure");
    out.PushAttribute("message", xml(one.failure).c_str());
    out.CloseElement();
  } else if (!one.skipped.empty()) {
    out.OpenElement("skipped");
    out.PushAttribute("message", xml(one.skipped).c_str());
    out.CloseElement();
  }
  if (!one.text.empty()) {
    out.OpenElement("system-out");
    out.PushText(xml(one.text).c_str());
    out.CloseElement();
  }
  out.CloseElement();
}

void print_property(tinyxml2::XMLPrinter& out, const char* key, const std::string& value) {
  out.OpenElement("property");
  out.PushAttribute("name", key);
  out.PushAttribute("value", xml(value).c_str());
  out.CloseElement();
}

}  // namespace

std::string comparison_json(const Comparison& c) {
  Json json;
  json["schema"] = 1;
  json["verdict"] = name(c.verdict);
  json["exit_code"] = exit_code(c);
  json["sentence"] = sentence(c);
  json["base"] = side(c.base);
  json["new"] = side(c.fresh);
  json["pairs"] = c.pairs;
  json["only_base"] = c.only_base;
  json["only_new"] = c.only_fresh;
  json["crashes"] = {{"base", c.base_crashes}, {"new", c.crashes}, {"budget", c.rules.crash_budget}};
  json["bits"] = {{"equal", c.pairs - c.differences.size()},
                  {"different", c.differences.size()},
                  {"different_share", {c.changed_share.low, c.changed_share.high}},
                  {"equal_heaps", c.equal_heaps},
                  {"stages", c.differing_stages}};
  json["bits"]["seeds"] = Json::array();
  for (const BitDifference& d : c.differences) {
    json["bits"]["seeds"].push_back({{"seed", d.seed}, {"turn", d.turn}, {"stage", to_string(d.stage)}});
  }
  json["alpha"] = {{"family", c.rules.alpha}, {"look", c.look.alpha}};
  json["confidence"] = c.look.confidence;
  json["metrics"] = Json::array();
  for (const MetricComparison& m : c.metrics) json["metrics"].push_back(metric_json(m));
  json["flips"] = Json::array();
  for (const Flip& f : c.flips) {
    json["flips"].push_back({{"seed", f.seed},
                             {"lost", f.lost},
                             {"what", f.what},
                             {"stage", f.stage},
                             {"replay", replay_command(c, f.seed)}});
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string comparison_junit(const Comparison& c) {
  const std::vector<Case> all = cases(c);
  std::size_t failures = 0, skipped = 0;
  for (const Case& one : all) {
    failures += one.failure.empty() ? 0 : 1;
    skipped += one.failure.empty() && !one.skipped.empty() ? 1 : 0;
  }
  tinyxml2::XMLPrinter out;
  out.PushHeader(false, true);
  out.OpenElement("testsuites");
  out.OpenElement("testsuite");
  out.PushAttribute("name", xml("binpick " + c.fresh.scenario).c_str());
  out.PushAttribute("tests", std::to_string(all.size()).c_str());
  out.PushAttribute("failures", std::to_string(failures).c_str());
  out.PushAttribute("skipped", std::to_string(skipped).c_str());
  out.OpenElement("properties");
  print_property(out, "seeds", std::to_string(c.pairs));
  print_property(out, "base", c.base.name);
  print_property(out, "new", c.fresh.name);
  print_property(out, "base_scenario_hash", c.base.scenario_hash);
  print_property(out, "new_scenario_hash", c.fresh.scenario_hash);
  out.CloseElement();
  for (const Case& one : all) print(out, one);
  out.CloseElement();
  out.CloseElement();
  return out.CStr();
}

}  // namespace binpick

#include "tools/validate/verdict.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>

namespace binpick {
namespace {

const char* rule_name(Verdict::Rule rule) {
  if (rule == Verdict::Rule::kAbove) return "above";
  return rule == Verdict::Rule::kBelow ? "below" : "within";
}

std::string shown(const char* before, double value, const std::string& unit) {
  char text[64];
  const bool length = unit == "m";
  std::snprintf(text, sizeof text, "%s%.4g%s%s", before, length ? value * 1e3 : value, unit == "1" ? "" : " ",
                length        ? "mm"
                : unit == "1" ? ""
                              : unit.c_str());
  return text;
}

std::string shown_expectation(const Verdict& v) {
  if (v.rule == Verdict::Rule::kWithin) return shown("", v.expected, v.unit);
  return shown(v.rule == Verdict::Rule::kAbove ? "> " : "< ", v.expected, v.unit);
}

std::string shown_tolerance(const Verdict& v) {
  if (v.tolerance == 0) return "-";
  return shown(v.rule == Verdict::Rule::kWithin ? "+-" : "slack ", v.tolerance, v.unit);
}

std::string shown_interval(const Verdict& v) {
  if (v.samples == 0) return "-";
  const double scale = v.unit == "m" ? 1e3 : 1;
  char text[64];
  std::snprintf(text, sizeof text, "%.4g..%.4g (%d)", scale * v.low, scale * v.high, v.samples);
  return text;
}

}  // namespace

bool Verdict::pass() const {
  switch (rule) {
    case Rule::kWithin:
      return std::abs(value - expected) <= tolerance;
    case Rule::kAbove:
      return value > expected - tolerance;
    case Rule::kBelow:
      return value < expected + tolerance;
  }
  return false;
}

bool all_pass(const std::vector<Verdict>& verdicts) {
  return std::all_of(verdicts.begin(), verdicts.end(), [](const Verdict& v) { return v.pass(); });
}

std::string table_of(const std::vector<Verdict>& verdicts) {
  std::size_t width = 4;
  for (const Verdict& v : verdicts) width = std::max(width, v.what.size());
  const int columns = static_cast<int>(width);
  std::string text;
  const auto line = [&](const char* id, const char* what, const std::string& value, const std::string& expected,
                        const std::string& tolerance, const std::string& interval, const char* verdict) {
    std::vector<char> row(width + 160);
    std::snprintf(row.data(), row.size(), "%-5s  %-*s  %12s  %12s  %13s  %22s  %s\n", id, columns, what, value.c_str(),
                  expected.c_str(), tolerance.c_str(), interval.c_str(), verdict);
    text += row.data();
  };
  line("id", "what", "value", "expected", "tolerance", "95 % interval (draws)", "verdict");
  for (const Verdict& v : verdicts)
    line(v.id.c_str(), v.what.c_str(), shown("", v.value, v.unit), shown_expectation(v), shown_tolerance(v),
         shown_interval(v), v.pass() ? "pass" : "FAIL");
  const auto passed = std::count_if(verdicts.begin(), verdicts.end(), [](const Verdict& v) { return v.pass(); });
  return text + std::to_string(passed) + " of " + std::to_string(verdicts.size()) + " pass\n";
}

std::string json_of(const std::vector<Verdict>& verdicts) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const Verdict& v : verdicts) {
    rows.push_back({{"id", v.id},
                    {"what", v.what},
                    {"value", v.value},
                    {"expected", v.expected},
                    {"tolerance", v.tolerance},
                    {"unit", v.unit},
                    {"rule", rule_name(v.rule)},
                    {"pass", v.pass()}});
    if (v.samples > 0) rows.back().update({{"samples", v.samples}, {"low", v.low}, {"high", v.high}});
  }
  return rows.dump(1) + "\n";
}

double rms_standard_error(int pixels, double correlation_length, int images) {
  const double shared = std::max(1.0, 2 * std::numbers::pi * correlation_length * correlation_length);
  return std::sqrt(shared / (2.0 * pixels * images));
}

double widened(double tolerance, double error, double full_error) {
  return tolerance + 3 * std::max(0.0, error - full_error);
}

}  // namespace binpick

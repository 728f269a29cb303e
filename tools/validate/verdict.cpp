#include "tools/validate/verdict.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>

#include "evaluation/statistics.hpp"

namespace binpick {
namespace {

const char* rule_name(Verdict::Rule rule) {
  if (rule == Verdict::Rule::kAbove) return "above";
  if (rule == Verdict::Rule::kReport) return "report";
  return rule == Verdict::Rule::kBelow ? "below" : "within";
}

// What people read: lengths in mm, angles in degrees.
double shown_scale(const std::string& unit) {
  if (unit == "m") return 1e3;
  return unit == "rad" ? 180 / std::numbers::pi : 1;
}

std::string shown_unit(const std::string& unit) {
  if (unit == "1") return "";
  if (unit == "m") return " mm";
  return unit == "rad" ? " deg" : " " + unit;
}

std::string shown(const char* before, double value, const std::string& unit) {
  char text[64];
  std::snprintf(text, sizeof text, "%s%.4g%s", before, value * shown_scale(unit), shown_unit(unit).c_str());
  return text;
}

std::string shown_expectation(const Verdict& v) {
  if (v.rule == Verdict::Rule::kReport) return "-";
  if (v.rule == Verdict::Rule::kWithin) return shown("", v.expected, v.unit);
  return shown(v.rule == Verdict::Rule::kAbove ? "> " : "< ", v.expected, v.unit);
}

std::string shown_tolerance(const Verdict& v) {
  if (v.tolerance == 0 || v.rule == Verdict::Rule::kReport) return "-";
  return shown(v.rule == Verdict::Rule::kWithin ? "+-" : "slack ", v.tolerance, v.unit);
}

std::string shown_interval(const Verdict& v) {
  if (v.samples == 0) return "-";
  const double scale = shown_scale(v.unit);
  char text[64];
  std::snprintf(text, sizeof text, "%.4g..%.4g (%d)", scale * v.low, scale * v.high, v.samples);
  return text;
}

/// Quantile 0.975 of Student's distribution (Abramowitz, Stegun 26.7.5, three terms: 4 % low at 3 degrees of freedom,
/// exact to 0.1 % from 9).
double student(int freedom) {
  constexpr double z = 1.959964;
  const double z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z, n = freedom;
  return z + (z3 + z) / (4 * n) + (5 * z5 + 16 * z3 + 3 * z) / (96 * n * n) +
         (3 * z7 + 19 * z5 + 17 * z3 - 15 * z) / (384 * n * n * n);
}

const char* verdict_of(const Verdict& v) {
  if (!v.pass()) return "FAIL";
  return v.rule == Verdict::Rule::kReport ? "reported" : "pass";
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
    case Rule::kReport:
      return std::isfinite(value);
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
         shown_interval(v), verdict_of(v));
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

Verdict mean_line(Verdict line, const std::vector<double>& values) {
  line.samples = static_cast<int>(values.size());
  line.value = mean(values);
  double squares = 0;
  for (const double v : values) squares += (v - line.value) * (v - line.value);
  const int freedom = line.samples - 1;
  const double half = freedom > 0 ? student(freedom) * std::sqrt(squares / freedom / line.samples) : 0;
  line.low = line.value - half;
  line.high = line.value + half;
  return line;
}

Verdict share_line(Verdict line, std::size_t hits, std::size_t total) {
  line.samples = static_cast<int>(total);
  line.value = total > 0 ? static_cast<double>(hits) / static_cast<double>(total) : std::nan("");
  const Interval interval = wilson_interval(hits, total);
  line.low = interval.low;
  line.high = interval.high;
  return line;
}

double rms_standard_error(int pixels, double correlation_length, int images) {
  const double shared = std::max(1.0, 2 * std::numbers::pi * correlation_length * correlation_length);
  return std::sqrt(shared / (2.0 * pixels * images));
}

double widened(double tolerance, double error, double full_error) {
  return tolerance + 3 * std::max(0.0, error - full_error);
}

}  // namespace binpick

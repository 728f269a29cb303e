// A comparison for people: one sentence, a table with intervals, the flipped seeds with their replay commands.
#include <algorithm>
#include <charconv>
#include <cmath>

#include "evaluation/comparison_words.hpp"
#include "evaluation/report_text.hpp"

namespace binpick {
namespace words {
namespace {

struct Scale {
  double factor;
  const char* unit;
  int digits;
};
Scale scale(const MetricComparison& metric) {
  switch (metric.unit) {
    case Unit::kLength:
      return {text::kToMm, " mm", 3};
    case Unit::kAngle:
      return {text::kToDeg, " deg", 3};
    case Unit::kTime:
      return {1, " s", 3};
    default:
      return {100, " %", 1};
  }
}

}  // namespace

std::string value(const MetricComparison& metric, double value) {
  const Scale s = scale(metric);
  if (std::isinf(value)) return "too many missed";
  return std::isnan(value) ? "-" : text::fixed(s.factor * value, s.digits) + s.unit;
}

std::string loss(const MetricComparison& metric, double value) {
  const Scale s = scale(metric);
  if (std::isnan(value)) return "-";
  if (std::isinf(value)) return value > 0 ? "unbounded" : "-unbounded";
  const double scaled = s.factor * value;
  return (scaled > 0 ? "+" : "") + text::fixed(scaled, s.digits) +
         (metric.unit == Unit::kNone ? " points" : std::string(s.unit));
}

std::string loss_interval(const MetricComparison& metric) {
  return loss(metric, metric.interval.low) + " to " + loss(metric, metric.interval.high);
}

std::string p_value(double p) {
  if (std::isnan(p)) return "-";
  char buffer[40];
  const auto result = p < 1e-3 ? std::to_chars(buffer, buffer + sizeof buffer, p, std::chars_format::scientific, 1)
                               : std::to_chars(buffer, buffer + sizeof buffer, p, std::chars_format::fixed, 3);
  return std::string(buffer, result.ptr);
}

std::string finding(const MetricComparison& metric) {
  const std::string shown = metric.rule.gate ? "" : " (shown only)";
  switch (metric.finding) {
    case Finding::kHolds:
      return "holds" + shown;
    case Finding::kWorse:
      return "WORSE" + shown;
    case Finding::kUnclear:
      return "unclear" + shown;
    case Finding::kNotEstimable:
      return "not estimable" + shown;
  }
  return "";
}

std::string bits(const Comparison& c) {
  if (c.differences.empty()) return "no bit changed in " + std::to_string(c.pairs) + " seeds";
  const BitDifference& first = c.differences.front();
  std::string stages;
  for (const auto& [stage, count] : c.differing_stages) {
    stages += (stages.empty() ? "" : ", ") + stage + " " + std::to_string(count);
  }
  return "bits changed in " + std::to_string(c.differences.size()) + " of " + std::to_string(c.pairs) +
         " seeds, first in seed " + std::to_string(first.seed) + " (" + describe(first) +
         "); first stage that differs: " + stages;
}

std::string crashes(const Comparison& c) {
  if (c.crashes.empty() && c.base_crashes.empty()) return "";
  std::string seeds;
  for (const std::uint64_t seed : c.crashes) seeds += (seeds.empty() ? "" : ", ") + std::to_string(seed);
  return std::to_string(c.crashes.size()) + " trials of the new version crashed" + (seeds.empty() ? "" : ": " + seeds) +
         " (budget " + std::to_string(c.rules.crash_budget) + "); " + std::to_string(c.base_crashes.size()) +
         " of the base; they are in no figure";
}

}  // namespace words

namespace {

using text::Row;

constexpr std::size_t kFlipsShown = 20;

std::string list(const Comparison& c, Finding finding) {
  std::string names;
  for (const MetricComparison& m : c.metrics) {
    if (!m.rule.gate || m.finding != finding) continue;
    names += (names.empty() ? "" : "; ") + m.label + " " + words::value(m, m.base) + " -> " + words::value(m, m.fresh);
    if (finding == Finding::kWorse) {
      names += " (loss " + words::loss_interval(m) + ", Holm p " + words::p_value(m.p_holm) + ")";
    }
  }
  return names;
}

std::string unclear(const Comparison& c) {
  std::string names;
  for (const MetricComparison& m : c.metrics) {
    if (m.rule.gate && m.finding == Finding::kUnclear) names += (names.empty() ? "" : ", ") + m.label;
  }
  return names.empty() ? "there is nothing to judge" : "too few seeds to tell: " + names;
}

std::vector<Row> metric_rows(const Comparison& c) {
  std::vector<Row> rows;
  for (const MetricComparison& m : c.metrics) {
    rows.push_back({m.label, words::value(m, m.base), words::value(m, m.fresh), words::loss(m, m.loss),
                    words::loss_interval(m), words::loss(m, m.rule.margin),
                    std::to_string(m.worse_piles) + " / " + std::to_string(m.better_piles), words::p_value(m.p),
                    words::p_value(m.p_holm), words::finding(m)});
  }
  return rows;
}

// "95 %", "99.75 %": without zeros at the end.
std::string confidence(const Comparison& c) {
  std::string digits = text::fixed(100 * c.look.confidence, 3);
  digits.erase(digits.find_last_not_of('0') + 1);
  if (digits.back() == '.') digits.pop_back();
  return digits + " %";
}

Row head(const Comparison& c) {
  return {"",  "base",     "new",    "loss", confidence(c) + " interval of the loss", "margin", "piles worse / better",
          "p", "p (Holm)", "finding"};
}

// Where every bit is equal there is nothing to test: the values alone.
std::vector<Row> value_rows(const Comparison& c) {
  std::vector<Row> rows;
  for (const MetricComparison& m : c.metrics) rows.push_back({m.label, words::value(m, m.fresh)});
  return rows;
}

std::vector<Row> rows_of(const Comparison& c) {
  return c.verdict == Verdict::kNoBitChanged ? value_rows(c) : metric_rows(c);
}

Row head_of(const Comparison& c) { return c.verdict == Verdict::kNoBitChanged ? Row{"", "both"} : head(c); }

std::vector<std::string> notes(const Comparison& c) {
  std::vector<std::string> lines;
  if (c.base.scenario_hash != c.fresh.scenario_hash) {
    lines.push_back("scenarios differ: " + c.base.scenario + " " + c.base.scenario_hash + ", " + c.fresh.scenario +
                    " " + c.fresh.scenario_hash);
  }
  if (c.base.record_schema != c.fresh.record_schema) {
    lines.push_back("records of schema " + std::to_string(c.base.record_schema) + " and " +
                    std::to_string(c.fresh.record_schema) + ": of their contents only the figures above are compared");
  }
  if (c.equal_heaps < c.pairs) {
    lines.push_back("only " + std::to_string(c.equal_heaps) + " of " + std::to_string(c.pairs) +
                    " seeds start from the same heap: where it differs, pairing by seed brings nothing");
  }
  if (c.only_base + c.only_fresh > 0) {
    lines.push_back("left out: " + std::to_string(c.only_base) + " seeds of the base and " +
                    std::to_string(c.only_fresh) + " of the new version have no partner");
  }
  if (!words::crashes(c).empty()) lines.push_back(words::crashes(c));
  const std::string spent =
      c.look.alpha < c.rules.alpha ? " (of which " + words::p_value(c.look.alpha) + " at this look)" : "";
  lines.push_back("alpha " + words::p_value(c.rules.alpha) + spent + " over all metrics (Holm); the unit is the pile");
  return lines;
}

}  // namespace

std::string sentence(const Comparison& c) {
  const std::string crashed = c.too_many_crashes ? "Crashed: " + words::crashes(c) + ". " : "";
  std::string bits = words::bits(c);
  const std::string where = bits.substr(0, bits.find("; first stage"));
  switch (c.verdict) {
    case Verdict::kNoBitChanged:
      bits[0] = 'N';
      return crashed + bits + ": pass (at " + confidence(c) + " a change can touch at most " +
             text::percent(c.changed_share.high) + " of the piles).";
    case Verdict::kHolds:
      return crashed + "Pass: " + where + ", and no metric is worse by its margin.";
    case Verdict::kWorse:
      return crashed + "Worse: " + list(c, Finding::kWorse) + "; " + where + ".";
    case Verdict::kInconclusive:
      return crashed + "Inconclusive: " + where + "; " + unclear(c) + ".";
  }
  return "";
}

std::string comparison_text(const Comparison& c) {
  std::vector<Row> rows = rows_of(c);
  rows.insert(rows.begin(), head_of(c));
  std::string out = sentence(c) + "\n\n" + text::plain_table(rows) + "\n  " + words::bits(c) + "\n";
  for (const std::string& note : notes(c)) out += "  " + note + "\n";
  if (!c.flips.empty())
    out += "\n  piles whose verdict changed (" + std::to_string(c.flips.size()) + "), losses first:\n";
  for (std::size_t i = 0; i < std::min(c.flips.size(), kFlipsShown); ++i) {
    const Flip& flip = c.flips[i];
    out += "  seed " + std::to_string(flip.seed) + (flip.lost ? " lost: " : " won: ") + flip.what + " [" + flip.stage +
           "]\n    " + replay_command(c, flip.seed) + "\n";
  }
  if (c.flips.size() > kFlipsShown) out += "  and " + std::to_string(c.flips.size() - kFlipsShown) + " more (--json)\n";
  return out;
}

std::string comparison_markdown(const Comparison& c) {
  std::string out = "## binpick: " + text::markdown(c.fresh.scenario) + "\n\n**" + text::markdown(sentence(c)) +
                    "**\n\n" + text::markdown_table(head_of(c), rows_of(c)) + "- " + text::markdown(words::bits(c)) +
                    "\n";
  for (const std::string& note : notes(c)) out += "- " + text::markdown(note) + "\n";
  if (c.flips.empty()) return out;
  std::vector<Row> rows;
  for (std::size_t i = 0; i < std::min(c.flips.size(), kFlipsShown); ++i) {
    const Flip& flip = c.flips[i];
    rows.push_back(
        {std::to_string(flip.seed), flip.lost ? "lost" : "won", flip.what, flip.stage, replay_command(c, flip.seed)});
  }
  return out + "\n### Piles whose verdict changed (" + std::to_string(c.flips.size()) + ", at most " +
         std::to_string(kFlipsShown) + " shown)\n\n" +
         text::markdown_table({"seed", "", "what", "first stage that differs", "replay"}, rows);
}

}  // namespace binpick

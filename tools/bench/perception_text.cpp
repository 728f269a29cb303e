// Figures as text: the table, the JSON rows, the list of failures.
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tools/bench/perception_rows.hpp"

namespace binpick {
namespace {

using Json = nlohmann::ordered_json;
constexpr double kDegrees = 180 / std::numbers::pi;
constexpr int kPixelBands[] = {0, 500, 1000, 2000, 4000};  // the last is open

__attribute__((format(printf, 1, 2))) std::string text(const char* format, ...) {
  char line[512];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(line, sizeof line, format, arguments);
  va_end(arguments);
  return line;
}

std::string percent(const Rate& rate) {
  if (rate.total == 0) return "-";
  return text("%.1f [%.1f-%.1f]", 100 * rate.rate, 100 * rate.interval.low, 100 * rate.interval.high);
}

std::string number(double value, int digits) {
  return std::isnan(value) ? std::string("-") : text("%.*f", digits, value);
}

Json number_json(double value) { return std::isnan(value) ? Json() : Json(value); }

Json rate_json(const Rate& rate, const char* total, const char* hits) {
  return {{total, rate.total},
          {hits, rate.hits},
          {"rate", number_json(rate.rate)},
          {"interval", {rate.interval.low, rate.interval.high}}};
}

Json pose_json(const Pose& X) {
  const Eigen::Vector3d rpy = rpy_of(X.linear());
  return {{"xyz_m", {X.translation().x(), X.translation().y(), X.translation().z()}},
          {"rpy_rad", {rpy.x(), rpy.y(), rpy.z()}}};
}

Json missed_json(const MissedInstance& m) {
  return {{"seed", m.seed},
          {"instance", m.body},
          {"X_CP", pose_json(m.X_CP)},
          {"visible_fraction", m.visible_fraction},
          {"visible_pixels", m.visible_pixels},
          {"ambiguous_view", m.ambiguous_view},
          {"nearest_mssd_m", number_json(m.nearest_mssd)},
          {"nearest_score", number_json(m.nearest_score)}};
}

Json wrong_json(const WrongEstimate& w) {
  return {{"seed", w.seed},
          {"rank", w.rank},
          {"score", w.score},
          {"flagged_ambiguous", w.ambiguous},
          {"ambiguous_view", w.ambiguous_view},
          {"X_CP", pose_json(w.X_CP)},
          {"nearest_instance", w.body ? Json(*w.body) : Json()},
          {"mssd_m", number_json(w.error.mssd)},
          {"translation_m", number_json(w.error.translation)},
          {"rotation_rad", number_json(w.error.rotation)},
          {"visible_fraction", w.visible_fraction},
          {"visible_pixels", w.visible_pixels},
          {"duplicate", w.duplicate}};
}

Json by_pixels_json(const PerceptionRow& row) {
  Json bands = Json::array();
  for (std::size_t b = 0; b < std::size(kPixelBands); ++b) {
    const bool last = b + 1 == std::size(kPixelBands);
    std::size_t visible = 0, found = 0;
    for (const LookScore& look : row.looks)
      for (const auto& [pixels, hit] : look.found_by_pixels) {
        if (pixels < kPixelBands[b] || (!last && pixels >= kPixelBands[b + 1])) continue;
        ++visible;
        found += hit ? 1 : 0;
      }
    bands.push_back({{"from", kPixelBands[b]},
                     {"to", last ? Json() : Json(kPixelBands[b + 1])},
                     {"visible", visible},
                     {"found", found}});
  }
  return bands;
}

/// Everything that counts for precision: [score, right, flagged as ambiguous, inlier fraction, fit rms in m].
Json scored_json(const PerceptionRow& row) {
  Json all = Json::array();
  for (const LookScore& look : row.looks)
    for (const ScoredEstimate& e : look.scored)
      all.push_back({e.score, e.right, e.ambiguous, e.inlier_fraction, e.fit_rms});
  return all;
}

void add_figures(const RowFigures& f, Json& out) {
  out["recall"] = rate_json(f.recall, "visible", "found");
  out["recall_partly_visible"] = rate_json(f.recall_partly, "visible", "found");
  out["recall_tight"] = rate_json(f.recall_tight, "visible", "found");
  out["precision"] = rate_json(f.precision, "counted", "right");
  out["recall_clear_views"] = rate_json(f.recall_clear, "visible", "found");
  out["precision_clear_views"] = rate_json(f.precision_clear, "counted", "right");
  out["precision_unflagged"] = rate_json(f.precision_sure, "counted", "right");
  out["top1"] = rate_json(f.top1, "scenes", "right");
  out["top1_clear_views"] = rate_json(f.top1_clear, "scenes", "right");
  out["first_right"] = rate_json(f.first, "scenes", "right");
  out["translation_median_m"] = number_json(f.translation_median);
  out["translation_p95_m"] = number_json(f.translation_p95);
  out["lateral_median_m"] = number_json(f.lateral_median);
  out["abs_z_median_m"] = number_json(f.abs_z_median);
  out["z_bias_m"] = number_json(f.z_bias);
  out["rotation_median_rad"] = number_json(f.rotation_median);
  out["rotation_p95_rad"] = number_json(f.rotation_p95);
  out["total_ms"] = number_json(f.median.total);
  out["total_p95_ms"] = number_json(f.total_p95);
  out["total_cpu_ms"] = number_json(f.median.cpu);
  out["first_ms"] = number_json(f.median.first);
  out["stage_ms"] = {{"preprocess", number_json(f.median.preprocess)},
                     {"voting", number_json(f.median.voting)},
                     {"verification", number_json(f.median.verification)},
                     {"icp", number_json(f.median.icp)}};
}

/// The row of this peer for the same question.
const PerceptionRow* peer_row(std::span<const PerceptionRow> rows, const PerceptionRow& row, const std::string& peer) {
  for (const PerceptionRow& other : rows)
    if (other.peer && other.type == peer && other.scene == row.scene && other.sensor == row.sensor &&
        other.part == row.part)
      return &other;
  return nullptr;
}

Json ratio_json(std::span<const PerceptionRow> rows, const PerceptionRow& row, const std::string& name) {
  const PerceptionRow* peer = row.peer ? nullptr : peer_row(rows, row, name);
  return peer ? number_json(time_ratio(*peer, row)) : Json();
}

Json row_json(std::span<const PerceptionRow> rows, const PerceptionRow& row) {
  Json out;
  out["part"] = row.part;
  out["sensor"] = row.sensor;
  out["estimator"] = row.contender;
  out["scene"] = row.scene;
  out["scenes"] = row.looks.size();
  out["heaps_left_out"] = row.left_out;
  out["instances"] = row.instances;
  add_figures(figures_of(row), out);
  out["train_ms"] = row.training.ms;
  out["load_ms"] = row.training.load_ms;
  out["table_bytes"] = row.training.table_bytes;
  out["ratio_opencv"] = ratio_json(rows, row, "opencv");
  out["ratio_pcl"] = ratio_json(rows, row, "pcl");
  out["recall_by_pixels"] = by_pixels_json(row);
  out["missed"] = out["wrong"] = Json::array();
  for (const LookScore& look : row.looks) {
    for (const MissedInstance& m : look.missed) out["missed"].push_back(missed_json(m));
    for (const WrongEstimate& w : look.wrong) out["wrong"].push_back(wrong_json(w));
  }
  out["scored"] = scored_json(row);
  out["settings"] = row.settings;
  return out;
}

std::string one_line(std::string yaml) {
  std::string line;
  for (const char c : yaml) line += c == '\n' ? std::string(", ") : std::string(1, c);
  return line.empty() ? line : line.substr(0, line.size() - 2);
}

/// How each peer was set, and how much longer it took, question by question.
std::string peers_of(std::span<const PerceptionRow> rows) {
  std::string out;
  for (const PerceptionRow& peer : rows) {
    if (!peer.peer) continue;
    out += text("%s, %s, %s: settings %s", peer.contender.c_str(), peer.part.c_str(), peer.sensor.c_str(),
                one_line(peer.settings).c_str());
    for (const PerceptionRow& row : rows)
      if (!row.peer && row.scene == peer.scene && row.sensor == peer.sensor && row.part == peer.part)
        out += text("; %.0f x the time of %s", time_ratio(peer, row), row.contender.c_str());
    out += "\n";
  }
  return out;
}

std::string pose_text(const Pose& X) {
  const Eigen::Vector3d p = 1e3 * X.translation(), r = kDegrees * rpy_of(X.linear());
  return text("at (%.0f %.0f %.0f) mm, rpy (%.0f %.0f %.0f) deg", p.x(), p.y(), p.z(), r.x(), r.y(), r.z());
}

std::string line_of(const MissedInstance& m) {
  std::string line = text("seed %llu missed  #%zu visible %.2f, %d px, %s", static_cast<unsigned long long>(m.seed),
                          m.body, m.visible_fraction, m.visible_pixels, pose_text(m.X_CP).c_str());
  if (!std::isnan(m.nearest_mssd))
    line += text("; nearest estimate: mssd %.1f mm, score %.2f", 1e3 * m.nearest_mssd, m.nearest_score);
  return line + (m.ambiguous_view ? "; ambiguous view\n" : "\n");
}

std::string line_of(const WrongEstimate& w) {
  std::string line = text("seed %llu wrong   rank %zu score %.2f%s %s", static_cast<unsigned long long>(w.seed), w.rank,
                          w.score, w.ambiguous ? " flagged" : "", pose_text(w.X_CP).c_str());
  if (w.body)
    line += text("; %s #%zu: mssd %.1f mm, off %.1f mm %.0f deg, visible %.2f, %d px",
                 w.duplicate ? "second of" : "nearest", *w.body, 1e3 * w.error.mssd, 1e3 * w.error.translation,
                 kDegrees * w.error.rotation, w.visible_fraction, w.visible_pixels);
  return line + (w.ambiguous_view ? "; ambiguous view\n" : "\n");
}

}  // namespace

std::string table_of(std::span<const PerceptionRow> rows) {
  std::string out =
      text("%-16s %-32s %-22s %6s %-19s %-19s %-19s %6s %7s %7s %6s %6s %6s %7s %7s %7s %6s %6s  %s\n", "part",
           "sensor", "estimator", "scenes", "recall %", "recall 0.3-0.5 %", "precision %", "top1 %", "t mm", "p95",
           "rot", "p95", "z mm", "ms", "cpu ms", "first", "train", "load", "prep/vote/check/icp ms");
  for (const PerceptionRow& row : rows) {
    const RowFigures f = figures_of(row);
    out += text("%-16s %-32s %-22s %6zu %-19s %-19s %-19s %6s ", row.part.c_str(), row.sensor.c_str(),
                row.contender.c_str(), row.looks.size(), percent(f.recall).c_str(), percent(f.recall_partly).c_str(),
                percent(f.precision).c_str(), number(100 * f.top1.rate, 1).c_str());
    out += text("%7s %7s %6s %6s ", number(1e3 * f.translation_median, 2).c_str(),
                number(1e3 * f.translation_p95, 2).c_str(), number(kDegrees * f.rotation_median, 2).c_str(),
                number(kDegrees * f.rotation_p95, 2).c_str());
    out += text("%6s %7s %7s %7s %6s %6s  ", number(1e3 * f.z_bias, 2).c_str(), number(f.median.total, 0).c_str(),
                number(f.median.cpu, 0).c_str(), number(f.median.first, 0).c_str(), number(row.training.ms, 0).c_str(),
                row.training.load_ms > 0 ? number(row.training.load_ms, 1).c_str() : "-");
    out += text("%.0f/%.0f/%.0f/%.0f\n", f.median.preprocess, f.median.voting, f.median.verification, f.median.icp);
  }
  out += peers_of(rows);
  return out;
}

std::string json_of(std::span<const PerceptionRow> rows) {
  Json json;
  json["rows"] = Json::array();
  for (const PerceptionRow& row : rows) json["rows"].push_back(row_json(rows, row));
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string failures_of(std::span<const PerceptionRow> rows) {
  std::string out;
  for (const PerceptionRow& row : rows) {
    std::string lines;
    for (const LookScore& look : row.looks) {
      for (const MissedInstance& m : look.missed) lines += line_of(m);
      for (const WrongEstimate& w : look.wrong) lines += line_of(w);
    }
    out += text("\n%s, %s, %s:\n", row.part.c_str(), row.sensor.c_str(), row.contender.c_str());
    out += lines.empty() ? "nothing missed, nothing wrong\n" : lines;
  }
  return out;
}

}  // namespace binpick

#include "evaluation/paper_tables.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "evaluation/paper_figures.hpp"
#include "evaluation/report_text.hpp"
#include "evaluation/statistics.hpp"
#include "evaluation/summary.hpp"

namespace binpick {
namespace {

using text::fixed;
using text::Row;
using Values = std::vector<double>;
using Json = nlohmann::ordered_json;

double wrapped(double angle) { return std::remainder(angle, 2 * std::numbers::pi); }

Values axis_of(const std::vector<Eigen::Vector3d>& rows, Eigen::Index axis) {
  Values values;
  for (const Eigen::Vector3d& row : rows) values.push_back(row[axis]);
  return values;
}

Values norms_of(const std::vector<Eigen::Vector3d>& rows) {
  Values values;
  for (const Eigen::Vector3d& row : rows) values.push_back(row.norm());
  return values;
}

std::vector<Eigen::Vector3d> in_si(const paper::Rows3& rows, double per_si) {
  std::vector<Eigen::Vector3d> out;
  for (const auto& row : rows) out.push_back(Eigen::Vector3d(row[0], row[1], row[2]) / per_si);
  return out;
}

/// "2.02 (0.43 - 3.61)": an absolute error is not below 0, whatever Student says.
std::string with_interval(const Values& values, double factor, int digits) {
  if (values.empty()) return "-";
  const Interval interval = student_interval(values);
  const std::string middle = fixed(factor * mean(values), digits);
  if (values.size() < 2) return middle;
  return middle + " (" + fixed(factor * std::max(0.0, interval.low), digits) + " - " +
         fixed(factor * interval.high, digits) + ")";
}

struct Column {
  std::string name;
  std::vector<Eigen::Vector3d> rows;              ///< SI
  std::vector<std::string> missing;               ///< of the poses that have no row, by place
  std::vector<std::optional<std::size_t>> place;  ///< row of each pose, nothing: none
};

/// Table 1 or 2: poses in rows, sources in columns; `axes`: names of the three, and of the distance if it is wanted.
std::string error_table(const std::vector<Column>& columns, double factor, const Row& axes) {
  Row head = {"pose"};
  std::size_t longest = 0;
  for (const Column& column : columns) {
    head.push_back(column.name);
    longest = std::max(longest, column.place.size());
  }
  std::vector<Row> rows;
  for (std::size_t i = 0; i < longest; ++i) {
    rows.push_back({std::to_string(i + 1)});
    for (const Column& column : columns) {
      if (i >= column.place.size())
        rows.back().push_back("");
      else if (!column.place[i])
        rows.back().push_back(column.missing[i]);
      else
        rows.back().push_back(text::triple(column.rows[*column.place[i]], factor, 2));
    }
  }
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    rows.push_back({"mean " + axes[static_cast<std::size_t>(axis)]});
    for (const Column& column : columns) rows.back().push_back(with_interval(axis_of(column.rows, axis), factor, 2));
  }
  if (axes.size() > 3) {
    rows.push_back({"mean " + axes[3]});
    for (const Column& column : columns) rows.back().push_back(with_interval(norms_of(column.rows), factor, 2));
  }
  return text::markdown_table(head, rows);
}

Column paper_column(const std::vector<Eigen::Vector3d>& rows) {
  Column column{"paper", rows, std::vector<std::string>(rows.size()), {}};
  for (std::size_t i = 0; i < rows.size(); ++i) column.place.push_back(i);
  return column;
}

Column column_of(const PaperVerification& verification, bool angles) {
  Column column{text::markdown(verification.name), {}, {}, {}};
  const VerifiedErrors errors = verified_errors(verification.poses);
  column.rows = angles ? errors.rpy : errors.xyz;
  std::size_t next = 0;
  for (const VerifiedPose& pose : verification.poses) {
    column.place.push_back(pose.X_RG_found ? std::optional<std::size_t>(next++) : std::nullopt);
    column.missing.push_back(text::markdown(pose.failure));
  }
  return column;
}

std::string tables_1_and_2(const PaperComparison& ours) {
  std::vector<Column> positions = {paper_column(paper_errors().xyz)};
  std::vector<Column> angles = {paper_column(paper_errors().rpy)};
  for (const PaperVerification& verification : ours.verifications) {
    positions.push_back(column_of(verification, false));
    angles.push_back(column_of(verification, true));
  }
  return "## Table 1: absolute position error, X / Y / Z, mm\n\n" +
         error_table(positions, text::kToMm, {"X", "Y", "Z", "distance"}) +
         "## Table 2: absolute angle error, roll / pitch / yaw, deg\n\n" +
         error_table(angles, text::kToDeg, {"roll", "pitch", "yaw"}) +
         "In brackets: 95 % interval of the mean (Student). The paper's columns are the differences of the coordinates "
         "it prints; its own averages are " +
         fixed(paper::kMeanAbsXyzMm[0], 2) + " / " + fixed(paper::kMeanAbsXyzMm[1], 2) + " / " +
         fixed(paper::kMeanAbsXyzMm[2], 2) + " mm and " + fixed(paper::kMeanAbsRpyDeg[0], 2) + " / " +
         fixed(paper::kMeanAbsRpyDeg[1], 2) + " / " + fixed(paper::kMeanAbsRpyDeg[2], 2) + " deg.\n\n";
}

std::string table_3(const PaperComparison& ours) {
  Row head = {"round", "paper"};
  std::size_t longest = paper::kPlacedOfTen.size();
  for (const PaperRounds& rounds : ours.rounds) {
    head.push_back(text::markdown(rounds.name));
    longest = std::max(longest, rounds.records.size());
  }
  std::vector<Row> rows;
  for (std::size_t i = 0; i < longest; ++i) {
    rows.push_back({std::to_string(i + 1)});
    rows.back().push_back(i < paper::kPlacedOfTen.size() ? std::to_string(paper::kPlacedOfTen[i]) + " / 10" : "");
    for (const PaperRounds& rounds : ours.rounds) {
      const bool has = i < rounds.records.size();
      const TrialRecord record = has ? rounds.records[i] : TrialRecord{};
      rows.back().push_back(!has ? ""
                                 : std::to_string(record.placed) + " / " + std::to_string(record.dropped) + " in " +
                                       std::to_string(record.picks.size()) + " picks");
    }
  }
  Row together = {"together", std::to_string(paper::kPlaced) + " / " + std::to_string(paper::kDropped) + " (" +
                                  text::percent(wilson_interval(paper::kPlaced, paper::kDropped)) + ")"};
  std::string verdicts;
  for (const PaperRounds& rounds : ours.rounds) {
    const CampaignSummary summary = summarise(rounds.records, 0);
    together.push_back(text::ratio(summary.cleared) + " (" + text::percent(summary.cleared.interval) + ")");
    verdicts += "- " + text::markdown(rounds.name + ": " + text::verdict(summary)) + "\n";
  }
  rows.push_back(together);
  return "## Table 3: bearings that came out of the bin\n\n" + text::markdown_table(head, rows) +
         "95 % intervals: Wilson for the paper, bootstrap over whole rounds for ours (Wilson where every round ended "
         "alike). The paper does not say how many picks its tens took.\n\n" +
         verdicts + "\n";
}

/// Means of one round's picks, ms: pre-processing, voting, verification, ICP, robot, total.
std::array<double, 6> times_ms(std::span<const TrialRecord> records) {
  const CampaignSummary s = summarise(records, 0);
  const auto stage = [&](const char* name) { return text::kToMs * s.stages.at(name).mean; };
  const double robot = text::kToMs * s.motion_mean;
  return {stage("preprocess"), stage("voting"), stage("verification"),
          stage("icp"),        robot,           stage("estimate_total") + stage("plan") + robot};
}

std::string table_4(const PaperComparison& ours) {
  std::vector<Row> rows;
  const auto add = [&](const std::string& name, const std::string& round, std::span<const double> ms) {
    Row row = {name, round};
    for (const double value : ms) row.push_back(fixed(value, 0));
    if (ms.size() == 5) row.insert(row.begin() + 4, "in voting");
    rows.push_back(row);
  };
  for (std::size_t i = 0; i < paper::kTimesMs.size(); ++i) add("paper", std::to_string(i + 1), paper::kTimesMs[i]);
  add("paper", "mean as printed", paper::kMeanTimesMs);
  for (const PaperRounds& rounds : ours.rounds) {
    std::array<Values, 6> columns;
    for (std::size_t i = 0; i < rounds.records.size(); ++i) {
      const auto ms = times_ms(std::span(rounds.records).subspan(i, 1));
      add(text::markdown(rounds.name), std::to_string(i + 1), ms);
      for (std::size_t k = 0; k < ms.size(); ++k)
        if (std::isfinite(ms[k])) columns[k].push_back(ms[k]);
    }
    Row row = {text::markdown(rounds.name), "mean (95 %)"};
    for (const Values& values : columns) row.push_back(with_interval(values, 1, 0));
    rows.push_back(row);
  }
  return "## Table 4: time of a pick, ms\n\n" +
         text::markdown_table({"", "round", "pre-processing", "voting", "verification", "ICP", "moving robot", "total"},
                              rows) +
         "Vision and planning are wall times of one thread on the machine that made this page (the paper: Core "
         "i5-2400), the robot's is simulated; the total holds planning too. Means are over the rounds.\n\n";
}

Json interval_json(const Values& values) {
  if (values.empty()) return {{"n", 0}};
  const Interval interval = student_interval(values);
  return {{"n", values.size()}, {"mean", mean(values)}, {"interval", {interval.low, interval.high}}};
}

Json axes_json(const std::vector<Eigen::Vector3d>& rows) {
  Json list = Json::array();
  for (Eigen::Index axis = 0; axis < 3; ++axis) list.push_back(interval_json(axis_of(rows, axis)));
  return list;
}

Json errors_json(const std::vector<Eigen::Vector3d>& xyz, const std::vector<Eigen::Vector3d>& rpy) {
  return {{"abs_xyz_m", axes_json(xyz)}, {"length_m", interval_json(norms_of(xyz))}, {"abs_rpy_rad", axes_json(rpy)}};
}

}  // namespace

VerifiedErrors verified_errors(std::span<const VerifiedPose> poses) {
  VerifiedErrors errors;
  for (const VerifiedPose& pose : poses) {
    if (!pose.X_RG_found) continue;
    errors.xyz.push_back((pose.X_RG_found->translation() - pose.X_RG_taught.translation()).cwiseAbs());
    const Eigen::Vector3d rpy = rpy_of(pose.X_RG_found->linear()) - rpy_of(pose.X_RG_taught.linear());
    errors.rpy.push_back(rpy.unaryExpr([](double angle) { return std::abs(wrapped(angle)); }));
  }
  return errors;
}

VerifiedErrors paper_errors() { return {in_si(paper::kErrorsMm, text::kToMm), in_si(paper::kErrorsDeg, text::kToDeg)}; }

std::string paper_tables(const PaperComparison& ours) {
  std::string page = tables_1_and_2(ours) + table_3(ours) + table_4(ours) + "## The paper's own slips\n\n";
  for (const char* slip : paper::kSlips) page += std::string("- ") + slip + "\n";
  return page;
}

std::string paper_json(const PaperComparison& ours) {
  Json out;
  out["paper"] = errors_json(paper_errors().xyz, paper_errors().rpy);
  out["paper"]["cleared"] = {{"placed", paper::kPlaced}, {"dropped", paper::kDropped}};
  out["verification"] = Json::array();
  for (const PaperVerification& verification : ours.verifications) {
    const VerifiedErrors errors = verified_errors(verification.poses);
    Json one = {{"name", verification.name}, {"poses", verification.poses.size()}};
    one.update(errors_json(errors.xyz, errors.rpy));
    out["verification"].push_back(one);
  }
  out["rounds"] = Json::array();
  for (const PaperRounds& rounds : ours.rounds)
    out["rounds"].push_back(
        {{"name", rounds.name}, {"summary", Json::parse(summary_json(summarise(rounds.records, 0)))}});
  return out.dump(1) + "\n";
}

}  // namespace binpick

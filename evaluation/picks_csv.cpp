// picks.csv: one row per pick, for a spreadsheet. Millimetres, degrees and milliseconds, as the column names say.
#include <cmath>
#include <limits>

#include "core/hash.hpp"
#include "evaluation/report.hpp"
#include "evaluation/report_table.hpp"
#include "evaluation/report_text.hpp"

namespace binpick {
namespace {

using text::fixed;

std::string number(double value, int digits) { return std::isfinite(value) ? fixed(value, digits) : ""; }
std::string number(std::size_t value) { return std::to_string(value); }
std::string optional_number(const std::optional<double>& value, double factor, int digits) {
  return value ? number(factor * *value, digits) : "";
}

struct Column {
  const char* name;
  std::string (*value)(const TrialRecord&, std::size_t index, const PickRecord&);
};

const MatchedEstimate* chosen_of(const PickRecord& pick) {
  for (const MatchedEstimate& estimate : pick.check.estimates) {
    if (pick.chosen && estimate.estimate == *pick.chosen) return &estimate;
  }
  return nullptr;
}

template <double PoseError::*Member>
std::string chosen_error(const PickRecord& pick, double factor) {
  const MatchedEstimate* chosen = chosen_of(pick);
  return chosen ? number(factor * chosen->error.*Member, 3) : "";
}

/// Contacts of arm and tool with bin, tray and table that began; lips may touch.
int collisions_of(const PickRecord& pick) {
  int sum = 0;
  for (const auto& [name, count] : pick.collisions) sum += name.rfind("lip", 0) == 0 ? 0 : count;
  return sum;
}

using T = const TrialRecord&;
using P = const PickRecord&;

constexpr Column kColumns[] = {
    {"scenario", [](T t, std::size_t, P) { return csv_cell(t.scenario); }},
    {"seed", [](T t, std::size_t, P) { return std::to_string(t.seed.key); }},
    {"pick", [](T, std::size_t i, P) { return number(i); }},
    {"outcome", [](T, std::size_t, P p) { return to_string(p.outcome); }},
    {"reason", [](T, std::size_t, P p) { return csv_cell(p.reason); }},
    {"visible", [](T, std::size_t, P p) { return number(p.check.visible); }},
    {"found", [](T, std::size_t, P p) { return number(p.check.found); }},
    {"counted", [](T, std::size_t, P p) { return number(p.check.counted); }},
    {"right", [](T, std::size_t, P p) { return number(p.check.right); }},
    {"chosen", [](T, std::size_t, P p) { return p.chosen ? number(*p.chosen) : std::string(); }},
    {"chosen_right",
     [](T, std::size_t, P p) {
       return std::string(!chosen_of(p) ? "" : chosen_of(p)->right ? "1" : "0");
     }},
    {"chosen_translation_mm",
     [](T, std::size_t, P p) { return chosen_error<&PoseError::translation>(p, text::kToMm); }},
    {"chosen_rotation_deg", [](T, std::size_t, P p) { return chosen_error<&PoseError::rotation>(p, text::kToDeg); }},
    {"chosen_mssd_mm", [](T, std::size_t, P p) { return chosen_error<&PoseError::mssd>(p, text::kToMm); }},
    {"cycle_s", [](T, std::size_t, P p) { return number(p.sim_time, 3); }},
    {"motion_s", [](T, std::size_t, P p) { return number(p.motion_time, 3); }},
    {"place_error_mm", [](T, std::size_t, P p) { return optional_number(p.place_error, text::kToMm, 2); }},
    {"place_rotation_deg", [](T, std::size_t, P p) { return optional_number(p.place_rotation, text::kToDeg, 2); }},
    {"swing_deg", [](T, std::size_t, P p) { return number(text::kToDeg * p.swing, 2); }},
    {"peak_force_n", [](T, std::size_t, P p) { return number(p.peak_force, 2); }},
    {"hold_use", [](T, std::size_t, P p) { return number(p.hold_use, 3); }},
    {"contact_force_n", [](T, std::size_t, P p) { return number(p.contact_force, 2); }},
    {"contact_depth_mm", [](T, std::size_t, P p) { return number(text::kToMm * p.contact_depth, 3); }},
    {"collisions", [](T, std::size_t, P p) { return std::to_string(collisions_of(p)); }},
    {"collision_depth_mm", [](T, std::size_t, P p) { return number(text::kToMm * p.collision_depth, 3); }},
    {"second_look", [](T, std::size_t, P p) { return csv_cell(p.second_look); }},
    {"look_s", [](T, std::size_t, P p) { return number(p.look_time, 3); }},
    {"neighbours_moved", [](T, std::size_t, P p) { return std::to_string(p.neighbours_moved); }},
    {"neighbours_dragged", [](T, std::size_t, P p) { return std::to_string(p.neighbours_dragged); }},
    {"parts_dropped_back", [](T, std::size_t, P p) { return std::to_string(p.parts_dropped_back); }},
    {"parts_lost", [](T, std::size_t, P p) { return std::to_string(p.parts_lost); }},
    {"preprocess_ms", [](T, std::size_t, P p) { return number(text::kToMs * p.wall.preprocess, 1); }},
    {"voting_ms", [](T, std::size_t, P p) { return number(text::kToMs * p.wall.voting, 1); }},
    {"verification_ms", [](T, std::size_t, P p) { return number(text::kToMs * p.wall.verification, 1); }},
    {"icp_ms", [](T, std::size_t, P p) { return number(text::kToMs * p.wall.icp, 1); }},
    {"estimate_ms", [](T, std::size_t, P p) { return number(text::kToMs * p.wall.total, 1); }},
    {"plan_ms", [](T, std::size_t, P p) { return number(text::kToMs * p.plan_wall, 1); }},
    {"frame_hash", [](T, std::size_t, P p) { return hex(p.frame_hash); }},
    {"estimates_hash", [](T, std::size_t, P p) { return hex(p.estimates_hash); }},
    {"world_hash", [](T, std::size_t, P p) { return hex(p.world_hash); }},
};

}  // namespace

std::string picks_csv(std::span<const TrialRecord> records) {
  std::string csv;
  for (const Column& column : kColumns) csv += (csv.empty() ? "" : ",") + std::string(column.name);
  csv += "\n";
  for (const TrialRecord& record : records) {
    for (std::size_t i = 0; i < record.picks.size(); ++i) {
      std::string line;
      for (const Column& column : kColumns) {
        line += (&column == kColumns ? "" : ",") + column.value(record, i, record.picks[i]);
      }
      csv += line + "\n";
    }
  }
  return csv;
}

}  // namespace binpick

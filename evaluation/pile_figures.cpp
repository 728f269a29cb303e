#include "evaluation/pile_figures.hpp"

#include <cmath>
#include <filesystem>

#include "core/error.hpp"
#include "core/file_io.hpp"

namespace binpick {
namespace {

ClusterCount count(std::size_t hits, std::size_t total) {
  return {static_cast<double>(hits), static_cast<double>(total)};
}

void add(ClusterCount& sum, const ClusterCount& other) {
  sum.hits += other.hits;
  sum.total += other.total;
}

double rounded(double value, double per_unit) { return std::round(value * per_unit) / per_unit; }

// The scenario's name and hash say what was asked for, not what came of it: a changed setting changes them always.
std::uint64_t content_hash(TrialRecord record) {
  record.scenario.clear();
  record.scenario_hash.clear();
  return record_hash(record);
}

void add_errors(const PoseCheck& check, PileFigures& pile) {
  pile.missed += check.visible - std::min(check.found, check.visible);
  for (const MatchedEstimate& estimate : check.estimates) {
    if (!estimate.right || estimate.ignored) continue;
    pile.translations.push_back(rounded(estimate.error.translation, 1e7));
    pile.rotations.push_back(rounded(estimate.error.rotation, 1e6));
  }
}

}  // namespace

ClusterCount count_picks(const TrialRecord& record) {
  ClusterCount count;
  for (const PickRecord& pick : record.picks) {
    if (pick.outcome == PickOutcome::kBinEmpty) continue;
    ++count.total;
    if (pick.outcome == PickOutcome::kSucceeded) ++count.hits;
  }
  return count;
}

ClusterCount count_first_look(const TrialRecord& record) {
  if (record.picks.empty()) return {};
  return count(record.picks.front().check.found, record.picks.front().check.visible);
}

bool same_figures(const PileFigures& a, const PileFigures& b) {
  const auto same = [](const ClusterCount& x, const ClusterCount& y) { return x.hits == y.hits && x.total == y.total; };
  return a.crashed == b.crashed && same(a.picks, b.picks) && same(a.cleared, b.cleared) && same(a.recall, b.recall) &&
         same(a.recall_first_look, b.recall_first_look) && same(a.precision, b.precision) &&
         a.first_pick == b.first_pick && a.missed == b.missed && a.translations == b.translations &&
         a.rotations == b.rotations && a.cycles == b.cycles;
}

PileFigures figures_of(const TrialRecord& record) {
  PileFigures pile;
  pile.seed = record.seed.key;
  pile.heap_hash = record.drop_hash;
  pile.content_hash = content_hash(record);
  pile.picks = count_picks(record);
  pile.cleared = {static_cast<double>(record.placed), static_cast<double>(record.dropped)};
  pile.recall_first_look = count_first_look(record);
  if (!record.picks.empty()) pile.first_pick = to_string(record.picks.front().outcome);
  pile.crashed = failure_of(record).has_value();
  for (const PickRecord& pick : record.picks) {
    pile.turns.push_back({pick.frame_hash, pick.estimates_hash, pick.world_hash});
    add(pile.recall, count(pick.check.found, pick.check.visible));
    add(pile.precision, count(pick.check.right, pick.check.counted));
    add_errors(pick.check, pile);
    if (pick.outcome == PickOutcome::kSucceeded) pile.cycles.push_back(rounded(pick.sim_time, 1e6));
  }
  return pile;
}

PileSet pile_set(const std::string& run_folder, std::span<const TrialRecord> records) {
  PileSet set;
  set.name = run_folder;
  set.replay = run_folder + "/scenario.yaml";
  for (const TrialRecord& record : records) {
    if (set.piles.empty()) {
      set.scenario = record.scenario;
      set.scenario_hash = record.scenario_hash;
    } else if (record.scenario_hash != set.scenario_hash) {
      throw SpecError(run_folder + ": seed " + std::to_string(record.seed.key) + " is of another scenario (" +
                      record.scenario_hash + ") than seed " + std::to_string(set.piles.front().seed) + " (" +
                      set.scenario_hash + ")");
    }
    set.piles.push_back(figures_of(record));
  }
  if (set.piles.empty()) throw SpecError(run_folder + ": holds no records");
  return set;
}

PileSet read_piles(const std::string& path) {
  if (!std::filesystem::exists(path)) throw SpecError(path + ": there is neither a run folder nor a baseline file");
  if (!std::filesystem::is_directory(path)) return baseline_from(read_file(path), path);
  if (!std::filesystem::is_directory(path + "/records"))
    throw SpecError(path + ": is not a run folder: no records/ in it");
  return pile_set(path, read_records(path));
}

}  // namespace binpick

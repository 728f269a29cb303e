// What a comparison needs of one trial: the counts of its pile, the errors of its right poses, and the hashes of its
// stages. Small enough to be kept as a baseline, and free of the record's schema. Lengths m, angles rad, times s.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "evaluation/statistics.hpp"
#include "evaluation/trial_record.hpp"

namespace binpick {

/// Hashes of one turn of the loop, in the order in which its stages run.
struct TurnHashes {
  std::uint64_t frame = 0, estimates = 0, world = 0;
  bool operator==(const TurnHashes&) const = default;
};

struct PileFigures {
  std::uint64_t seed = 0;
  bool crashed = false;         ///< an InternalError: of no use as a measurement
  std::uint64_t heap_hash = 0;  ///< before the first look
  std::vector<TurnHashes> turns;
  std::uint64_t content_hash = 0;  ///< of the whole record but wall times and the scenario's name and hash
  ClusterCount picks;              ///< succeeded of attempted
  ClusterCount cleared;            ///< placed of dropped
  ClusterCount recall;             ///< found of visible, over every look
  ClusterCount recall_first_look;
  ClusterCount precision;  ///< right of counted estimates
  std::string first_pick;  ///< outcome of the first turn; empty without one
  std::size_t missed = 0;  ///< visible instances that no right estimate was matched to: errors without bound
  std::vector<double> translations, rotations;  ///< of right estimates that count, to 0.1 um and 1 urad
  std::vector<double> cycles;                   ///< simulated, of succeeded picks, to 1 us
};

/// Everything above but hashes.
bool same_figures(const PileFigures& a, const PileFigures& b);

/// Counts shared with the summary. Attempted: every turn but BinEmpty, whatever ended it.
ClusterCount count_picks(const TrialRecord& record);
ClusterCount count_first_look(const TrialRecord& record);

PileFigures figures_of(const TrialRecord& record);

/// The piles of one version: a run folder, or a baseline file.
struct PileSet {
  std::string name;                   ///< path as given
  std::string replay;                 ///< scene to replay a seed with; empty: unknown
  std::string scenario;               ///< its name
  std::string scenario_hash;          ///< of the expanded scenario
  int record_schema = kRecordSchema;  ///< of the records behind it: another one has other contents
  std::vector<PileFigures> piles;     ///< ascending seeds
};

PileSet pile_set(const std::string& run_folder, std::span<const TrialRecord> records);
/// A run folder or a baseline file. Throws SpecError, AssetError: one line that names file and place.
PileSet read_piles(const std::string& path);

/// Baseline file: one header line, then one line of JSON per seed.
std::string baseline_text(const PileSet& set);
PileSet baseline_from(const std::string& text, const std::string& path);

}  // namespace binpick

// One trial as data: what happened at every pick, in a canonical JSON line. The hashed part is byte-equal for the same
// scenario and seed on any worker count; wall times sit in their own object `wall` and take part in no comparison.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/pick_outcome.hpp"
#include "core/pose_estimate.hpp"
#include "core/random.hpp"
#include "evaluation/matching.hpp"
#include "evaluation/trial_failure.hpp"

namespace binpick {

inline constexpr int kRecordSchema = 4;

/// A part in the bin at a look, in the order of GroundTruth::instances: what recall by visibility and by depth needs.
struct SeenInstance {
  int part = 0;         ///< index into the scenario's parts
  double diameter = 0;  ///< m
  double visible = 0;   ///< fraction
  double height = 0;    ///< m, of its box centre above the bin's floor
};

struct PickRecord {
  PickOutcome outcome = PickOutcome::kNoDetection;
  std::string reason;                      ///< one phrase, e.g. why no candidate survived
  PoseCheck check;                         ///< every estimate of this look against the truth
  std::optional<std::size_t> chosen;       ///< estimate that the plan picked
  std::optional<std::size_t> lifted_body;  ///< heap index of the part that left the bin with the tool
  std::map<std::string, int> rejections;   ///< reason -> number of rejected candidates
  double sim_time = 0;                     ///< s, simulated motion + vacuum + exposure
  double motion_time = 0;                  ///< s of it, moving robot (Table 4)
  std::optional<double> place_error;       ///< m, of the released part's centre against the planned one
  std::optional<double> place_rotation;    ///< rad
  double swing = 0;                        ///< rad, largest tilt of the held part against the tool
  double peak_force = 0;                   ///< N, largest pull seen by the grip
  double hold_use = 0;       ///< largest share of a cup's limits that the load took; a jerk above 1 may be held
  double contact_force = 0;  ///< N, largest by arm, tool or held part on heap, bin, tray or table
  double contact_depth = 0;  ///< m, deepest of those contacts
  std::string contact;       ///< what pushed on what, at the largest force
  std::map<std::string, int> collisions;  ///< arm, tool and lips with bin, tray and table -> contacts that began
  double collision_depth = 0;             ///< m, deepest of arm and tool
  std::string second_look;                ///< why the arm looked again; empty: once was enough
  double look_time = 0;                   ///< s of sim_time that the second look took: motion and exposure
  int neighbours_dragged = 0;             ///< other parts that rose more than 10 mm with the held one
  int parts_dropped_back = 0;             ///< of those, the ones that lie in the bin afterwards
  int parts_lost = 0;                     ///< other parts that left the bin and do not lie in the tray
  int neighbours_moved = 0;               ///< parts that moved by more than 5 mm while the target was lifted
  std::uint64_t frame_hash = 0;
  std::uint64_t estimates_hash = 0;
  std::uint64_t world_hash = 0;    ///< after the pick
  std::vector<SeenInstance> seen;  ///< what lay in the bin, outside the hash; empty in lines of older versions
  StageTimes wall;                 ///< s, outside the hash
  double plan_wall = 0;            ///< s, outside the hash
};

struct TrialRecord {
  int schema = kRecordSchema;
  std::string scenario;
  std::string scenario_hash;
  Seed seed;        ///< the campaign's seed number is seed.key
  int dropped = 0;  ///< parts dropped
  int placed = 0;   ///< parts at rest in the tray at the end
  int escaped = 0;  ///< parts outside the bin before the first pick
  bool settled = true;
  double settle_time = 0;        ///< s simulated until the heap was at rest
  double worst_penetration = 0;  ///< m, deepest contact at rest, of what collides
  double penetration_p99 = 0;    ///< m, of true solids, over the pairs that press on each other; at rest
  double penetration_max = 0;    ///< m
  double woken_energy = 0;       ///< J, largest of a part at the end of the time it was kept awake
  double woken_motion = 0;       ///< m, largest of a part in that time
  double woken_share = 0;        ///< of the parts that moved more than 0.1 mm in it
  /// From where the camera is to where the cell believes it, in the camera's frame: m, and rad as a rotation vector.
  /// Nothing, and no key in the line: the scene's calibration is perfect.
  std::optional<Eigen::Vector3d> calibration_translation, calibration_rotation;
  std::uint64_t drop_hash = 0;
  std::vector<PickRecord> picks;
  std::optional<TrialFailure> failure;  ///< no key in the line: it is a measurement
  std::string error;                    ///< what the failure says
  std::string build;                    ///< hash of the program, outside the record's hash; empty: not known
  int attempts = 1;                     ///< outside the hash; 2: a worker died over it first
  std::string first_failure;            ///< outside the hash: how
  double wall_total = 0;                ///< s, outside the hash
};

/// Why the trial is no measurement; none: it is one.
std::optional<TrialFailure> failure_of(const TrialRecord& record);

/// The hashed part alone, as a JSON line without the newline: byte-equal for the same build, scenario and seed.
std::string canonical_line(const TrialRecord& record);
/// One line without the newline: {"schema":..,...,"hash":"..","build":"..","wall":{..},"sum":".."}. `sum` is of every
/// byte before it, so that a damaged line is told. Doubles read back exactly.
std::string to_json_line(const TrialRecord& record);
/// Throws SpecError naming `place` (file:line).
TrialRecord trial_record_from_json(const std::string& line, const std::string& place);
/// Hash of everything but wall times: what replays are compared by.
std::uint64_t record_hash(const TrialRecord& record);
/// All records of a run folder (records/*.jsonl), sorted by seed. Throws SpecError, AssetError.
std::vector<TrialRecord> read_records(const std::string& run_folder);

}  // namespace binpick

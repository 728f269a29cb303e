// A trial as it can be shown again: where parts and arm were, what the camera saw, what was believed, what was tried.
// Made by a ReplayRecorder while the trial runs; drawn by the page (`binpick report`, `binpick view`) and by
// replay_picture. Metres, radians, seconds of simulated time; poses in W. Format on disk: docs/report.md.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/mesh.hpp"
#include "core/pose.hpp"
#include "evaluation/trial_record.hpp"

namespace binpick {

inline constexpr int kReplaySchema = 1;

/// Poses over time, linear in between (slerp); before the first: not there.
struct PoseTrack {
  std::vector<double> times;
  std::vector<Pose> X;
};
struct JointTrack {
  std::vector<double> times;
  std::vector<Vector6d> q;
};

/// Interpolated, clamped to the last; nothing before the first.
std::optional<Pose> pose_at(const PoseTrack& track, double time);
std::optional<Vector6d> joints_at(const JointTrack& track, double time);
/// Without the samples that lie on the way between their neighbours: within 0.5 mm and 0.01 rad, or 2 mrad of a joint.
PoseTrack thinned(const PoseTrack& track);
JointTrack thinned(const JointTrack& track);

/// The cell for the eye. Links are in the arm's own frames L, what the flange carries in F.
struct ReplayCell {
  struct Item {
    std::string name;  ///< bin, table, tray, tool, camera, cup
    TriangleMesh mesh;
    Pose X = Pose::Identity();  ///< X_WO of what stands still, X_FO of what the flange carries
  };
  struct Joint {
    Pose X_before = Pose::Identity();  ///< of the joint's frame in the link before
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  };
  std::vector<Item> fixed, carried;
  std::vector<TriangleMesh> links;  ///< seven, base first
  std::vector<Joint> joints;        ///< six
  Pose X_WR = Pose::Identity(), X_6F = Pose::Identity();
  std::vector<std::string> part_names;
  std::vector<TriangleMesh> part_meshes_P;
};

struct ReplayEstimate {
  std::size_t part = 0;
  Pose X_WP = Pose::Identity();
  MatchedEstimate match;  ///< score, errors, right or not
  int body = -1;          ///< heap index of its instance; -1: none
};
struct ReplayRejection {
  std::size_t estimate = 0;
  Eigen::Vector3d tip_W = Eigen::Vector3d::Zero(), axis_W = -Eigen::Vector3d::UnitZ();  ///< of the tool at contact
  std::string reason;
};
struct ReplayLook {
  int pick = 0;
  double time = 0;
  Pose X_WC = Pose::Identity();               ///< the (last) camera, as believed
  std::vector<Eigen::Vector3f> cloud_W;       ///< in an order that makes every beginning of it an even choice
  std::vector<ReplayEstimate> estimates;      ///< best first
  std::vector<ReplayRejection> rejected;      ///< the first ones tried
  std::size_t rejected_count = 0;             ///< all of them
  std::vector<std::pair<int, double>> truth;  ///< heap index and visible fraction of what lay in the bin
  std::optional<std::size_t> chosen;          ///< estimate that the plan picks
};
struct ReplayEvent {
  int pick = 0;
  double time = 0;
  std::string what;
};

struct Replay {
  TrialRecord record;
  double duration = 0;
  ReplayCell cell;
  std::vector<std::size_t> part_of_body;  ///< by heap index
  std::vector<PoseTrack> bodies;          ///< by heap index
  JointTrack arm;
  std::vector<ReplayLook> looks;
  std::vector<ReplayEvent> events;
};

/// What the page draws, as JSON text: poses to 0.1 mm, joints to 0.2 mrad, times to 20 ms.
std::string replay_json(const Replay& replay);
/// The cell as JSON text; meshes of at most `triangles` each. The same for every trial of a scenario.
std::string replay_cell_json(const ReplayCell& cell, std::size_t triangles = 2500);

}  // namespace binpick

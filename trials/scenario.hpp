// A scenario: one YAML file = the configuration of every stage. Expanded, validated, hashed. A trial is a pure function
// of (scenario, seed).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/config.hpp"
#include "core/part.hpp"
#include "core/yaml_value.hpp"
#include "perception/pose_estimator.hpp"
#include "robot/cell.hpp"
#include "robot/look_pose.hpp"
#include "robot/plan_pick.hpp"
#include "sim/drop.hpp"
#include "sim/sensor_model.hpp"
#include "sim/world.hpp"
#include "trials/calibration/calibration_config.hpp"
#include "trials/oracle.hpp"
#include "trials/pick_execution.hpp"

namespace binpick {

/// `parts:` item. A single part may be written as `part:` and `count:` at the top of the scene.
struct PartEntry {
  PartSpec spec;
  int count = 10;
  void visit(ConfigVisitor& v);
};

/// `oracles:` stages that are told the truth (oracle_stages.hpp), for the error budget.
struct OracleStages {
  bool segmentation = false;  ///< the first look's pixels of parts are known
  bool planning = false;      ///< plans on exact depth of the heap
  bool seal = false;          ///< every cup that touches a part seals, and holds whatever happens
  bool any() const { return segmentation || planning || seal; }
  void visit(ConfigVisitor& v);
};

/// When a trial ends, and whether the arm moves.
struct TrialConfig {
  int max_picks = 30;
  int failures_in_a_row = 5;
  std::string execute = "always";  ///< always | only_if_right: the check against truth may veto the arm, never steer it
  double exposure = 0.1;           ///< s, added to every cycle
  void visit(ConfigVisitor& v);
  void validate() const;
};

struct Scenario {
  std::string name = "scenario";
  std::vector<PartEntry> parts;
  DropConfig drop;
  SettleConfig settle;
  PhysicsConfig physics;
  Cell cell;                        ///< as it believes itself to be
  CalibrationConfig calibration;    ///< of cell.camera; further cameras stand where the cell believes
  std::string renderer = "osmesa";  ///< what draws the exact frames: a name of renderer_names()
  std::string sensor_type = "disparity";
  std::shared_ptr<SensorModel> sensor;
  std::string estimator_type = "ppf";        ///< a name of the estimator registry, or `oracle`
  std::shared_ptr<PoseEstimator> estimator;  ///< not prepared; null for the oracle
  OracleConfig oracle;
  PlanningConfig planning;
  ExecutionConfig execution;
  SecondLookConfig second_look;
  TrialConfig trial;
  OracleStages oracles;
  std::string file;  ///< where it was read from, for messages; no part of its values

  void visit(ConfigVisitor& v);
  int part_count() const;  ///< parts dropped in one trial
};

/// What the command line or a sweep may set over the scene file.
struct ScenarioOverrides {
  std::string sensor;  ///< NAME or NAME:PRESET; the camera's intrinsics then are the preset's, whatever the scene says
  std::vector<YamlSetting> settings = {};  ///< as if the file had said so
};

/// Reads, expands and validates a scene. Throws SpecError or AssetError in one line.
Scenario read_scenario(const std::string& path, const ScenarioOverrides& overrides = {});

/// Every value, defaults included; paths are relative to `folder`, so that the file replays from there.
std::string expanded_yaml(const Scenario& scenario, const std::string& folder);

/// Hash of the expanded values and of the contents of every file they name; independent of where those files lie.
std::string scenario_hash(const Scenario& scenario);

}  // namespace binpick

// binpick bench perception: heaps of our own physics, one look at each, and every contender's answer to the same look,
// in turn within the same run, so that whatever else the machine does falls on all of them. No time decides anything.
#pragma once

#include <string>
#include <vector>

#include "core/progress.hpp"
#include "tools/bench/perception_contender.hpp"
#include "tools/bench/perception_score.hpp"
#include "tools/bench/perception_view.hpp"

namespace binpick {

struct PerceptionBenchConfig {
  std::vector<std::string> scenes;   ///< scene files
  std::vector<std::string> sensors;  ///< NAME or NAME:PRESET; "": the scene's own
  std::vector<ContenderSpec> contenders;
  std::uint64_t first_seed = 100, last_seed = 110;  ///< the last is not used
  int threads = 2;
  bool ask_first = true;  ///< also for one pickable pose only
  int peer_scenes = 3;    ///< heaps that peers are asked about, the first ones: they take seconds each
  ViewTrouble trouble;
  double part_scale = 1;    ///< of every part, its heap and what is looked for
  double sought_scale = 1;  ///< of the parts that are looked for in the heaps of others, beside part_scale
  std::string cache;        ///< folder of heaps at rest; empty: none
  bool features = false;    ///< keep what the scores are made of
  bool heaps_only = false;  ///< drop and keep the heaps, look at nothing
};

/// Times of one look in ms. Those of the stages are as the estimator reports them.
struct LookTimes {
  double total = 0, cpu = 0;  ///< wall; processor time of all threads
  double first = 0;           ///< asked for one pickable pose only
  double preprocess = 0, voting = 0, verification = 0, icp = 0;
};

/// What an estimate's score was made of, and whether it was right.
struct ScoredFeatures {
  std::uint64_t seed = 0;
  ScoreFeatures features{};
  ScoredEstimate scored;
};

/// One contender's answers to all looks at one kind of part under one sensor.
struct PerceptionRow {
  std::string scene, part, sensor, contender;
  std::string type;           ///< of the contender
  std::string settings;       ///< all of them, YAML
  std::size_t instances = 0;  ///< of the part in a heap
  bool peer = false;
  bool has_first = false;
  Training training;
  std::vector<ScoredFeatures> features;  ///< with PerceptionBenchConfig::features
  std::vector<LookScore> looks;          ///< in the order of the seeds
  std::vector<LookTimes> times;          ///< the same; of the whole result, all kinds of parts together
  std::size_t left_out = 0;              ///< heaps that were not at rest inside the bin
};

/// The scene with parts of another size, whose names say so.
Scenario scaled_scenario(const std::string& file, const std::string& sensor, double part_scale);

std::vector<PerceptionRow> bench_perception(const PerceptionBenchConfig& config, ProgressSink& progress);

/// What --sensor accepts here: a name of `list sensor_presets`; the preset alone, of the disparity model where it has
/// one; gauss_X for gauss_z:sigma_X.
std::string full_sensor_name(const std::string& text);

}  // namespace binpick

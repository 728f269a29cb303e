#include "tools/bench/perception_bench.hpp"

#include <time.h>

#include <algorithm>
#include <chrono>

#include "core/error.hpp"
#include "core/quantity.hpp"
#include "perception/view_ambiguity.hpp"
#include "tools/bench/perception_heaps.hpp"

namespace binpick {
namespace {

struct Clock {
  std::chrono::steady_clock::time_point wall = std::chrono::steady_clock::now();
  double cpu = processor_ms();

  static double processor_ms() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
  }
  double wall_ms() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - wall).count();
  }
};

/// One scene under one sensor: the rows are [contender][part].
class SceneBench {
 public:
  SceneBench(const PerceptionBenchConfig& config, const std::string& file, const std::string& sensor)
      : config_(config), sensor_(sensor), scenario_(scaled_scenario(file, sensor, config.part_scale)) {
    scenario_.estimator = nullptr;  // the contenders bring their own
    scenario_.estimator_type = "oracle";
    context_ = make_trial_context(scenario_);
    choose_sought();
    for (const ContenderSpec& spec : config.contenders) contenders_.emplace_back(spec);
    for (Contender& contender : contenders_) add_rows(contender);
  }

  std::string name() const { return scenario_.name + (sensor_.empty() ? "" : " " + sensor_); }

  void look(std::uint64_t seed, HeapStore& heaps) {
    const SettledHeap& heap = heaps.heap(scenario_, context_, seed);
    if (!heap.usable) {
      for (PerceptionRow& row : rows_) ++row.left_out;
      return;
    }
    if (config_.heaps_only) return;
    const Observation seen = look_at(heap, seed);
    ambiguous_ = ambiguous_instances(seen);
    ++looks_;
    for (std::size_t k = 0; k < contenders_.size(); ++k)  // another one begins each time
      answer((k + seed) % contenders_.size(), seen, seed);
  }

  std::vector<PerceptionRow> take_rows() { return std::move(rows_); }

 private:
  /// Usually the scene's own parts, and their instances are the truth; what else is looked for is not there.
  void choose_sought() {
    sought_ = context_.parts;
    if (config_.trouble.other_part) {
      sought_ = {load_part(*config_.trouble.other_part)};
      context_.checker = std::make_unique<const PoseChecker>(sought_);
    }
    for (const Part& part : sought_) views_.emplace_back(part);
  }

  /// Which instances are seen, by the first camera, so that another pose of the part would look the same?
  std::vector<bool> ambiguous_instances(const Observation& seen) const {
    const Capture& first = seen.captures.front();
    std::vector<bool> ambiguous;
    for (const GroundTruth::Instance& instance : seen.truth.instances)
      ambiguous.push_back(views_[instance.part].ambiguous(seen.truth.X_WC.inverse() * instance.X_WP, first.frame.camera,
                                                          first.frame.noise, &first.exact.depth));
    return ambiguous;
  }

  Observation look_at(const SettledHeap& heap, std::uint64_t seed) {
    CellWorld cell_world(scenario_.cell, scenario_.physics, context_.parts);
    place_heap(config_.trouble.no_parts ? SettledHeap{} : heap, cell_world);
    Observation seen = observe(scenario_, cell_world, context_, Seed{seed}, 0);
    if (config_.trouble.other_part) seen.truth.instances.clear();
    seen.view = troubled(std::move(seen.view), config_.trouble, Seed{seed}.child("trouble"));
    seen.view.threads = config_.threads;
    return seen;
  }

  void add_rows(Contender& contender) {
    const std::vector<Training> training =
        config_.heaps_only ? std::vector<Training>(sought_.size()) : contender.prepare(sought_);
    for (std::size_t p = 0; p < sought_.size(); ++p) {
      PerceptionRow row;
      row.scene = scenario_.name;
      row.part = sought_[p].name;
      row.sensor = sensor_.empty() ? scenario_.sensor_type : sensor_;
      row.contender = contender.name();
      row.type = contender.type();
      row.settings = contender.settings();
      row.instances = nothing_there() ? 0 : static_cast<std::size_t>(scenario_.parts[p].count);
      row.peer = contender.is_peer();
      row.has_first = config_.ask_first && contender.can_stop_early();
      row.training = training[p];
      rows_.push_back(std::move(row));
    }
  }

  bool nothing_there() const { return config_.trouble.no_parts || config_.trouble.other_part; }

  void answer(std::size_t k, const Observation& seen, std::uint64_t seed) {
    const Contender& contender = contenders_[k];
    if (contender.is_peer() && looks_ > config_.peer_scenes) return;
    const Seed estimator_seed = Seed{seed}.child("estimator", 0);
    LookTimes times;
    const Clock clock;
    std::vector<ScoreFeatures> features;
    const EstimateResult result = contender.estimate(seen, estimator_seed, config_.features ? &features : nullptr);
    times.total = clock.wall_ms();
    times.cpu = Clock::processor_ms() - clock.cpu;
    times.preprocess = 1e3 * result.wall.preprocess;
    times.voting = 1e3 * result.wall.voting;
    times.verification = 1e3 * result.wall.verification;
    times.icp = 1e3 * result.wall.icp;
    const std::optional<MatchedEstimate> first = first_pose(contender, seen, estimator_seed, times.first);
    const PoseCheck check = context_.checker->check(result, seen.X_WC_believed, seen.truth);
    const LookJudge judge{seen.truth, result, check, sought_, ambiguous_, seen.X_WC_believed};
    for (std::size_t p = 0; p < sought_.size(); ++p) {
      PerceptionRow& row = rows_[k * sought_.size() + p];
      row.looks.push_back(judge.of_part(p, seed));
      if (first && first_.estimates[first->estimate].part == p) row.looks.back().first_right = first->right;
      for (const ScoredEstimate& e : row.looks.back().scored)
        if (e.estimate < features.size()) row.features.push_back({seed, features[e.estimate], e});
      row.times.push_back(times);
    }
  }

  /// The best answer of a search that may stop at the first pose it is sure of; nothing: it gave none.
  std::optional<MatchedEstimate> first_pose(const Contender& contender, const Observation& seen, Seed seed,
                                            double& ms) {
    if (!config_.ask_first || !contender.can_stop_early()) return std::nullopt;
    const Clock clock;
    first_ = contender.estimate_first(seen, seed);
    ms = clock.wall_ms();
    const PoseCheck check = context_.checker->check(first_, seen.X_WC_believed, seen.truth);
    if (check.estimates.empty()) return std::nullopt;
    return check.estimates.front();
  }

  const PerceptionBenchConfig& config_;
  std::string sensor_;
  Scenario scenario_;
  TrialContext context_;
  std::vector<Part> sought_;
  std::vector<AmbiguousViews> views_;  ///< of the parts sought
  std::vector<bool> ambiguous_;        ///< instances of the present look
  std::vector<Contender> contenders_;
  EstimateResult first_;  ///< of the search for one pose
  int looks_ = 0;
  std::vector<PerceptionRow> rows_;
};

bool holds(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::string full_sensor_name(const std::string& text) {
  if (text.empty() || text.find(':') != std::string::npos || holds(sensor_names(), text)) return text;
  if (text.rfind("gauss_", 0) == 0) return "gauss_z:sigma_" + text.substr(6);
  if (holds(make_sensor("disparity")->presets(), text)) return "disparity:" + text;
  for (const SensorEntry& entry : sensor_registry())
    if (holds(entry.make()->presets(), text)) return entry.name + ":" + text;
  throw SpecError("--sensor " + text + ": neither a sensor nor a preset; `binpick list sensor_presets` names them");
}

Scenario scaled_scenario(const std::string& file, const std::string& sensor, double part_scale) {
  Scenario scenario = read_scenario(file, {sensor});
  if (part_scale == 1) return scenario;
  for (PartEntry& entry : scenario.parts) {
    entry.spec.scale *= part_scale;
    entry.spec.name += " x " + format_double(part_scale);
    entry.spec.validate();
  }
  return scenario;
}

std::vector<PerceptionRow> bench_perception(const PerceptionBenchConfig& config, ProgressSink& progress) {
  HeapStore heaps(config.cache);
  std::vector<PerceptionRow> rows;
  const std::size_t seeds = config.last_seed - config.first_seed;
  const std::size_t total = config.scenes.size() * config.sensors.size() * seeds;
  std::size_t done = 0;
  for (const std::string& file : config.scenes)
    for (const std::string& sensor : config.sensors) {
      SceneBench bench(config, file, full_sensor_name(sensor));
      for (std::uint64_t seed = config.first_seed; seed < config.last_seed; ++seed) {
        bench.look(seed, heaps);
        progress.update(++done, total, bench.name());
      }
      for (PerceptionRow& row : bench.take_rows()) rows.push_back(std::move(row));
    }
  progress.finish();
  return rows;
}

}  // namespace binpick

#include "trials/scenario.hpp"

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/hash.hpp"
#include "core/yaml.hpp"

namespace binpick {
namespace {

// `part:` is a path of a part.yaml or a mapping with the same keys.
void visit_part(ConfigVisitor& v, PartSpec& spec) {
  if (v.reading() && v.is_scalar("part")) {
    std::string path;
    v.path("part", path, "part.yaml");
    spec = read_part_spec(path);
  } else {
    v.section("part", spec, "a path of a part.yaml, or a mapping with its keys");
  }
}

// `cell:` is a path, or a mapping that may start from one with `base:` and override it.
struct CellSection {
  Cell& cell;
  void visit(ConfigVisitor& v) {
    if (v.has("base")) {
      std::string base;
      v.path("base", base, "a cell file whose values the other keys override");
      read_yaml_file(base, [&](ConfigVisitor& file) { cell.visit(file); });
    }
    cell.visit(v);
  }
};

void visit_cell(ConfigVisitor& v, Cell& cell) {
  if (v.reading() && v.is_scalar("cell")) {
    std::string path;
    v.path("cell", path, "cell file");
    read_yaml_file(path, [&](ConfigVisitor& file) { cell.visit(file); });
  } else {
    CellSection section{cell};
    v.section("cell", section, "a path of a cell file, or a mapping: `base:` names a file to start from");
  }
}

// `calibration:` is a word or a mapping. What is perfect is not written, so that older scenes keep their hash.
void visit_calibration(ConfigVisitor& v, CalibrationConfig& config) {
  if (v.reading() && v.is_scalar("calibration")) {
    v.choice("calibration", config.method, {"perfect", "chain", "hand_eye"}, "");
  } else if (v.reading() || !config.perfect()) {
    v.section("calibration", config, "how well the cell knows where its camera is");
  }
  if (!v.has("calibration")) return;
  try {
    config.validate();  // here, where the line is known
  } catch (const SpecError& error) {
    v.fail("calibration", error.what());
  }
}

std::vector<std::string> estimator_choices() {
  std::vector<std::string> names = estimator_names();
  names.push_back("oracle");
  return names;
}

void visit_sensor(ConfigVisitor& v, Scenario& s) {
  if (v.reading()) s.sensor = nullptr;
  v.section_with(
      "sensor",
      [&](ConfigVisitor& in) {
        in.choice("type", s.sensor_type, sensor_names(), "sensor model");
        if (!s.sensor) s.sensor = make_sensor(s.sensor_type);
        s.sensor->visit(in);
      },
      "the depth camera's model");
  if (!s.sensor) s.sensor = make_sensor(s.sensor_type);
  if (!v.has("sensor")) return;
  try {
    s.sensor->validate();  // here, where the line is known
  } catch (const SpecError& error) {
    v.fail("sensor", error.what());
  }
}

void override_sensor(Scenario& s, const std::string& text) {
  const std::size_t colon = text.find(':');
  s.sensor_type = text.substr(0, colon);
  s.sensor = make_sensor(s.sensor_type);
  const std::string preset = colon == std::string::npos ? "" : "preset: '" + text.substr(colon + 1) + "'";
  if (!preset.empty()) read_yaml_text(preset, "--sensor " + text, "", [&](ConfigVisitor& v) { s.sensor->visit(v); });
  s.cell.camera.has_intrinsics = false;
  for (FurtherCamera& camera : s.cell.cameras) camera.has_intrinsics = false;
}

void give_intrinsics(const SensorModel& sensor, CameraMount& camera) {
  if (camera.has_intrinsics) return;
  camera.intrinsics = sensor.default_camera();
  camera.has_intrinsics = true;
}

void visit_estimator(ConfigVisitor& v, Scenario& s) {
  if (v.reading()) s.estimator = nullptr;
  v.section_with(
      "estimator",
      [&](ConfigVisitor& in) {
        in.choice("type", s.estimator_type, estimator_choices(), "pose estimator");
        if (s.estimator_type == "oracle") {
          s.oracle.visit(in);
        } else {
          if (!s.estimator) s.estimator = make_estimator(s.estimator_type);
          s.estimator->visit(in);
        }
      },
      "the pose estimator");
  if (!s.estimator && s.estimator_type != "oracle") s.estimator = make_estimator(s.estimator_type);
}

// `second_look:` is `off` or a mapping. What is not said is on where it helps: with a camera that can be moved, and
// with the estimator whose score is a probability, so that a poor fit can be told.
void visit_second_look(ConfigVisitor& v, Scenario& s) {
  SecondLookConfig& config = s.second_look;
  if (v.reading() && s.estimator_type == "ppf" && s.cell.camera.mount == "flange") config.when = {"poor_fit", "failed"};
  if (v.reading() && v.is_scalar("second_look")) {
    std::string word;
    v.choice("second_look", word, {"off"}, "");
    config.when.clear();
  } else {
    v.section("second_look", config, "a second look before a pick: off, or when and from where");
  }
}

void validate(const Scenario& s) {
  if (s.parts.empty() || s.part_count() == 0) throw SpecError("count: a trial needs at least one part");
  if (s.part_count() > 500) throw SpecError("count: more than 500 parts in one bin are not supported");
  for (const PartEntry& entry : s.parts) {
    if (entry.count < 0) throw SpecError("count: must not be negative");
    entry.spec.validate();
  }
  s.drop.validate();
  s.settle.validate();
  s.physics.validate();
  s.sensor->validate();
  s.estimator ? s.estimator->validate() : s.oracle.validate();
  s.planning.validate();
  s.execution.validate();
  s.second_look.validate();
  if (!s.second_look.when.empty() && s.cell.camera.mount != "flange")
    throw SpecError(
        "second_look.when: the camera is fixed (cell.camera.mount); the arm can move one on the flange only");
  if (s.calibration.by_measurement() && s.cell.camera.mount != "flange")
    throw SpecError("calibration." + s.calibration.method +
                    ": is of a camera on the flange, and this one is fixed (cell.camera.mount); give an offset");
  s.trial.validate();
  if ((s.oracles.segmentation || s.oracles.planning) && s.cell.camera_count() > 1)
    throw SpecError("oracles: segmentation and planning are told of one camera's frame, and the cell has " +
                    std::to_string(s.cell.camera_count()));
}

}  // namespace

void PartEntry::visit(ConfigVisitor& v) {
  visit_part(v, spec);
  v.field("count", count, "how many are dropped");
}

void TrialConfig::visit(ConfigVisitor& v) {
  v.field("max_picks", max_picks, "picks after which a trial ends");
  v.field("failures_in_a_row", failures_in_a_row, "failed picks in a row after which a trial ends");
  v.choice("execute", execute, {"always", "only_if_right"}, "whether a wrong estimate still moves the arm");
  v.field("exposure", exposure, Unit::kTime, "camera time of one look, part of the cycle");
}

void TrialConfig::validate() const {
  if (max_picks < 1) throw SpecError("trial.max_picks: must be at least 1");
  if (failures_in_a_row < 1) throw SpecError("trial.failures_in_a_row: must be at least 1");
  if (!(exposure >= 0)) throw SpecError("trial.exposure: must not be negative");
}

void Scenario::visit(ConfigVisitor& v) {
  v.field("name", name, "shown in records and reports");
  if (v.reading() && v.has("part")) {
    parts.resize(1);
    parts[0].visit(v);
  } else {
    v.list("parts", parts, "[{part, count}]; a single part may be written as `part:` and `count:`");
  }
  v.section("drop", drop, "how parts enter the bin");
  v.section("settle", settle, "when the heap is at rest");
  v.section("physics", physics, "the physics engine");
  visit_cell(v, cell);
  visit_calibration(v, calibration);
  v.choice("renderer", renderer, renderer_names(), "what draws the exact frames; raycast is the slower reference");
  visit_sensor(v, *this);
  visit_estimator(v, *this);
  v.section("planning", planning, "the pick planner");
  v.section("execution", execution, "the executed pick");
  visit_second_look(v, *this);
  v.section("trial", trial, "when a trial ends");
  if (v.reading() || oracles.any()) v.section("oracles", oracles, "stages that are told the truth (binpick budget)");
}

void OracleStages::visit(ConfigVisitor& v) {
  v.field("segmentation", segmentation, "the estimator is told which pixels of the first look show parts");
  v.field("planning", planning, "the planner sees the heap's exact depth");
  v.field("seal", seal, "every cup that touches a part seals, and holds whatever happens");
}

int Scenario::part_count() const {
  int total = 0;
  for (const PartEntry& entry : parts) total += entry.count;
  return total;
}

Scenario read_scenario(const std::string& path, const ScenarioOverrides& overrides) {
  Scenario scenario;
  scenario.file = path;
  read_yaml_file(path, overrides.settings, [&](ConfigVisitor& v) {
    scenario.visit(v);
    if (!overrides.sensor.empty()) override_sensor(scenario, overrides.sensor);
    validate(scenario);
    give_intrinsics(*scenario.sensor, scenario.cell.camera);
    for (FurtherCamera& camera : scenario.cell.cameras) give_intrinsics(*scenario.sensor, camera);
    scenario.cell.finish();
    scenario.cell.validate();
  });
  return scenario;
}

std::string expanded_yaml(const Scenario& scenario, const std::string& folder) {
  Scenario copy = scenario;
  return write_yaml([&](ConfigVisitor& v) { copy.visit(v); }, folder);
}

std::string scenario_hash(const Scenario& scenario) {
  // The name of a file says nothing, its bytes do.
  const auto content = [](std::string& path) {
    if (!path.empty()) path = hex(Hasher().add(read_file(path)).value());
  };
  Scenario copy = scenario;
  for (PartEntry& entry : copy.parts) {
    content(entry.spec.mesh);
    content(entry.spec.envelope);
    content(entry.spec.pieces);
  }
  content(copy.cell.arm_path);
  content(copy.cell.bin.mesh);
  copy.cell.arm_packages.clear();  // where meshes lie says nothing either; they enter below
  const FileNaming by_content = [&](const std::string& path) {
    std::string name = path;
    content(name);
    return name;
  };
  Hasher hasher;
  hasher.add(write_yaml([&](ConfigVisitor& v) { copy.visit(v); }, by_content));
  if (copy.cell.arm)
    for (const std::string& mesh : copy.cell.arm->mesh_files()) hasher.add(read_file(mesh));
  return hex(hasher.value());
}

}  // namespace binpick

// binpick check FILE..: scenes and parts are valid. Loads everything a trial would load and says what it found.

#include <cstdio>
#include <iostream>
#include <numeric>

#include "core/symmetry_detection.hpp"
#include "core/yaml.hpp"
#include "tools/commands.hpp"
#include "trials/scenario.hpp"
#include "trials/trial_context.hpp"

namespace binpick {
namespace {

void print_part(const Part& part) {
  const Eigen::Vector3d size = bounding_box(part.mesh_P).sizes() * 1e3;
  std::printf("  part %s: %.1f x %.1f x %.1f mm, diameter %.1f mm, %.1f g, %zu triangles, %s, symmetry: %s\n",
              part.name.c_str(), size.x(), size.y(), size.z(), part.diameter * 1e3, part.mass.mass * 1e3,
              part.mesh_P.triangles.size(), is_closed(part.mesh_P) ? "closed" : "OPEN",
              describe(part.symmetry).c_str());
  const std::string found = describe(detect_symmetry(part.envelope_P, SymmetrySpec().tolerance));
  if (found != describe(part.symmetry))
    std::printf("  part %s: its mesh shows another symmetry than was stated: %s\n", part.name.c_str(), found.c_str());
}

void check(const std::string& file) {
  PartSpec spec;
  bool is_part = false;
  read_yaml_file(file, [&](ConfigVisitor& v) {
    is_part = v.has("mesh");
    is_part ? spec.visit(v) : Scenario().visit(v);
  });
  if (is_part) {
    const Part part = load_part(spec);
    std::printf("%s\n", file.c_str());
    print_part(part);
    return;
  }
  Scenario scenario = read_scenario(file);
  const TrialContext context = make_trial_context(scenario);
  std::printf("%s\n", file.c_str());
  for (const Part& part : context.parts) print_part(part);
  std::printf("  scene %s: %d parts, sensor %s, estimator %s, arm %s, hash %s\n", scenario.name.c_str(),
              std::accumulate(context.counts.begin(), context.counts.end(), 0), scenario.sensor_type.c_str(),
              scenario.estimator_type.c_str(), scenario.cell.arm->name().c_str(), context.hash.c_str());
}

}  // namespace

Action add_check(CLI::App& app) {
  auto files = std::make_shared<std::vector<std::string>>();
  CLI::App* command = app.add_subcommand("check", "scenes and part files are valid");
  command->add_option("files", *files, "scene or part.yaml files")->required();
  return [files] {
    for (const std::string& file : *files) check(file);
    return 0;
  };
}

}  // namespace binpick

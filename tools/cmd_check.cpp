// binpick check FILE..: scenes and parts are valid. Loads everything a trial would load and says what it found: of a
// scene also how the arm's inverse kinematics are solved, and how much of the bin the tool can work in.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <numeric>

#include "core/error.hpp"
#include "core/symmetry_detection.hpp"
#include "core/yaml.hpp"
#include "robot/numeric_ik.hpp"
#include "tools/commands.hpp"
#include "tools/reach_picture.hpp"
#include "trials/scenario.hpp"
#include "trials/trial_context.hpp"

namespace binpick {
namespace {

/// rad, between the z axes of two poses.
double angle_between_axes(const Pose& X_1, const Pose& X_2) {
  return std::acos(std::clamp(X_1.linear().col(2).dot(X_2.linear().col(2)), -1.0, 1.0));
}

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

/// How the arm is solved, and of a numeric search what it took over the middle of the bin.
void print_arm(const Cell& cell) {
  const Arm& arm = *cell.arm;
  std::printf("  arm %s, flange '%s', inverse kinematics ", arm.name().c_str(), arm.flange_name().c_str());
  if (arm.opw()) {
    std::printf("in closed form%s\n", arm.opw_is_exact() ? "" : ", polished (the file's angles are rounded)");
  } else {
    const Pose X_WG = pose_from(rotation_with_z(-Eigen::Vector3d::UnitZ()), cell.X_WB * Eigen::Vector3d(0, 0, 0.05));
    const Pose X_RF = cell.X_WR.inverse() * X_WG * cell.gripper->X_FG().inverse();
    const NumericBranches found = arm.numeric().branches(X_RF, cell.q_home);
    std::printf("numeric (%s)%s; over the bin %zu branches, %d of %d starts converged\n", arm.why_numeric().c_str(),
                arm.numeric().has_parallel_axes() ? ", from the closed form of three parallel axes" : "",
                found.q.size(), found.converged, found.restarts);
  }
  const Vector6d q = cell.q_home;
  const Vector6d turned = q + 0.5 * Vector6d::Unit(5);
  const double off = angle_between_axes(arm.forward(q), arm.forward(turned));
  if (off > 0.01)
    std::printf("  arm %s: the z axis of '%s' does not point along the last axis; should arm_tip be another link?\n",
                arm.name().c_str(), arm.flange_name().c_str());
}

void print_reach(const Scenario& scenario, const std::string& png) {
  const ReachMap map = reach_map(scenario.cell);
  std::printf("  reach: %s\n", reach_text(map).c_str());
  if (png.empty()) return;
  write_png(png, reach_picture(map, scenario.cell, scenario.name + ": " + scenario.cell.arm->name()));
  std::printf("  reach: picture in %s\n", png.c_str());
}

void check(const std::string& file, const std::string& png) {
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
    if (!png.empty()) throw SpecError("--png: " + file + " is a part; only a scene has a reach to be drawn");
    return;
  }
  Scenario scenario = read_scenario(file);
  const TrialContext context = make_trial_context(scenario);
  std::printf("%s\n", file.c_str());
  for (const Part& part : context.parts) print_part(part);
  std::printf("  scene %s: %d parts, sensor %s, estimator %s, arm %s, hash %s\n", scenario.name.c_str(),
              std::accumulate(context.counts.begin(), context.counts.end(), 0), scenario.sensor_type.c_str(),
              scenario.estimator_type.c_str(), scenario.cell.arm->name().c_str(), context.hash.c_str());
  print_arm(scenario.cell);
  print_reach(scenario, png);
}

}  // namespace

Action add_check(CLI::App& app) {
  auto files = std::make_shared<std::vector<std::string>>();
  CLI::App* command = app.add_subcommand("check", "scenes and part files are valid");
  command->add_option("files", *files, "scene or part.yaml files")->required();
  auto png = std::make_shared<std::string>();
  command->add_option("--png", *png, "file for a picture of the bin's reachability; one scene only");
  return [files, png] {
    if (!png->empty() && files->size() != 1)
      throw SpecError("--png: takes one scene, not " + std::to_string(files->size()));
    for (const std::string& file : *files) check(file, *png);
    return 0;
  };
}

}  // namespace binpick

// The executed pick with the paper's bearing and hand-made plans, so that what is expected is known beforehand.
#include "trials/pick_execution.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "core/yaml.hpp"
#include "robot/inverse_kinematics.hpp"
#include "sim/collision_shape.hpp"
#include "trials/arm_run.hpp"

namespace binpick {
namespace {

const std::string kAssets = std::string(BINPICK_SOURCE_DIR) + "/assets/";

Cell load_cell(const std::string& name, const std::string& gripper) {
  Cell cell;
  read_yaml_file(kAssets + "cells/" + name, [&](ConfigVisitor& v) { cell.visit(v); });
  if (!gripper.empty())
    read_yaml_text("arm: ../arms/mz07.urdf\ngripper: " + gripper, "test", kAssets + "cells",
                   [&](ConfigVisitor& v) { cell.visit(v); });
  cell.finish();
  return cell;
}

const Part& bearing() {
  static const Part part = load_part(read_part_spec(kAssets + "parts/bearing_6914/part.yaml"));
  return part;
}

/// Tool straight down over p_W.
Pose down_at(const Eigen::Vector3d& p_W) {
  return pose_from(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()).toRotationMatrix(), p_W);
}

/// A flat box of 50 x 50 x 16 mm.
Part plate_of(double friction) {
  Part made;
  made.name = "plate";
  made.friction = friction;
  made.mesh_P = mesh_of(Primitive::box({0.05, 0.05, 0.016}));
  made.envelope_P = made.mesh_P;
  made.pieces_P = {made.mesh_P};
  made.density = 1000;
  made.mass = mass_properties(made.mesh_P, made.density);
  made.diameter = mesh_diameter(made.mesh_P);
  return made;
}

const Part& plate() {
  static const Part part = plate_of(0.4);
  return part;
}

/// The bearing's tool with one more setting for each cup.
std::string three_cups(const std::string& more) {
  std::string cups;
  for (int k = 0; k < 3; ++k) {
    const double angle = 2 * std::numbers::pi * k / 3;
    cups += (k ? ", {" : "{") + more + ", pose: {xyz: [" + std::to_string(0.0425 * std::cos(angle)) + ", " +
            std::to_string(0.0425 * std::sin(angle)) + ", 0]}}";
  }
  return "{type: suction, cups: [" + cups + "]}";
}

struct Site {
  /// `gripper`: YAML of another tool, or empty for the cell's own.
  explicit Site(const std::string& cell_name, const std::string& gripper = "", const Part& part_ = bearing())
      : part(part_), cell(load_cell(cell_name, gripper)), cell_world(cell, PhysicsConfig{}, {&part_, 1}) {
    shape = collision_shape(part);
  }
  /// A bearing lying flat, its mass centre over p_B of the bin floor.
  void lay(const Eigen::Vector3d& p_B) {
    const Pose X_WP = cell.X_WB * Pose(Eigen::Translation3d(p_B + Eigen::Vector3d(0, 0, 0.008)));
    drop.bodies.push_back(cell_world.world().add_free(part, shape, X_WP));
    drop.parts.push_back(0);
  }
  void start() {
    settle(cell_world.world(), SettleConfig{});
    cell_world.set_heap(drop);
  }
  Vector6d joints_for(const Pose& X_WG, const Vector6d& near) const {
    const Pose X_RF = cell.X_WR.inverse() * X_WG * cell.gripper->X_FG().inverse();
    const auto solutions = inverse_kinematics(*cell.arm, X_RF, near);
    EXPECT_FALSE(solutions.empty());
    return solutions.empty() ? near : solutions.front();
  }
  JointTrajectory straight(const Vector6d& from, const Pose& X_WG) const {
    return linear_move(*cell.arm, from, cell.X_WR.inverse() * X_WG * cell.gripper->X_FG().inverse(), cell.motion);
  }
  /// Down on `contact_W` (lips pressed by 2 mm), straight up, to the tray (its middle + slot_T) and back.
  PickPlan plan_at(const Eigen::Vector3d& contact_W, double height = 0.35,
                   const Eigen::Vector3d& slot_T = Eigen::Vector3d::Zero()) const {
    PickPlan plan;
    plan.X_WG = down_at(contact_W);
    const Eigen::Vector3d up(0, 0, height), press(0, 0, -0.002);
    const Vector6d above = joints_for(down_at(contact_W + up), cell.q_look);
    const JointTrajectory down = straight(above, down_at(contact_W + press));
    plan.approach = joined(joint_move(*cell.arm, cell.q_look, above, cell.motion), down);
    plan.lift = straight(down.q.back(), down_at(contact_W + up));
    const Eigen::Vector3d slot = cell.tray.X_WT.translation() + slot_T + Eigen::Vector3d(0, 0, 0.016 + 0.01);
    const Vector6d over = joints_for(down_at(slot + Eigen::Vector3d(0, 0, 0.15)), above);
    const JointTrajectory lower = straight(over, down_at(slot));
    plan.place = joined(joint_move(*cell.arm, plan.lift.q.back(), over, cell.motion), lower);
    plan.back = joined(straight(lower.q.back(), down_at(slot + Eigen::Vector3d(0, 0, 0.15))),
                       joint_move(*cell.arm, over, cell.q_look, cell.motion));
    plan.X_WP_place = Pose(Eigen::Translation3d(slot - Eigen::Vector3d(0, 0, 0.008)));
    return plan;
  }
  const Part& part;
  Cell cell;
  CellWorld cell_world;
  CollisionShape shape;
  DropResult drop;
};

TEST(PickExecution, AFlatBearingIsPlacedInTheTray) {
  Site site("mz07_three_cups.yaml");
  site.lay({0.02, -0.05, 0});
  site.start();
  const Eigen::Vector3d top = site.cell_world.box_center(0) + Eigen::Vector3d(0, 0, 0.008);
  std::vector<std::string> moments;
  const ExecutionResult result = execute_pick(site.cell_world, site.plan_at(top), ExecutionConfig{},
                                              [&](const char* moment, const CellWorld&) { moments.push_back(moment); });
  EXPECT_EQ(to_string(result.outcome), to_string(PickOutcome::kSucceeded)) << result.reason;
  EXPECT_EQ(moments, (std::vector<std::string>{"held", "lifted", "released"}));
  ASSERT_TRUE(result.place_error.has_value());
  EXPECT_LT(*result.place_error, 0.002);
  EXPECT_LT(*result.place_rotation, 0.01);
  EXPECT_EQ(result.lifted, 0u);
  EXPECT_TRUE(site.cell_world.in_tray(0));
  EXPECT_FALSE(site.cell_world.in_bin(0));
  EXPECT_LT(result.swing, 0.1);
  const double weight = bearing().mass.mass * 9.81, full = site.cell.gripper->cups()[0].limits().pull;
  EXPECT_GT(result.hold_use, weight / (3 * full));  // at rest; acceleration and the plungers' jerk come on top
  EXPECT_EQ((site.cell_world.joints() - site.cell.q_look).norm(), 0);
}

TEST(PickExecution, TwoAndFourCupsCarryTheBearingToo) {
  for (const auto& [cell, gripper] : {std::pair<std::string, std::string>{"mz07_four_cups.yaml", ""},
                                      {"mz07_three_cups.yaml", "{type: suction, preset: two_cups}"},
                                      {"mz07_three_cups.yaml", "{type: suction, preset: four_cups}"}}) {
    Site site(cell, gripper);
    site.lay({0.02, -0.05, 0});
    site.start();
    const Eigen::Vector3d top = site.cell_world.box_center(0) + Eigen::Vector3d(0, 0, 0.008);
    const ExecutionResult result = execute_pick(site.cell_world, site.plan_at(top), ExecutionConfig{});
    EXPECT_EQ(to_string(result.outcome), to_string(PickOutcome::kSucceeded)) << cell << gripper << result.reason;
  }
}

/// The first that happened, and a cell that is ready for the next pick.
void expect_ended(const Site& site, const ExecutionResult& result, PickOutcome outcome) {
  EXPECT_EQ(to_string(result.outcome), to_string(outcome)) << result.reason;
  EXPECT_FALSE(result.reason.empty());
  EXPECT_LT((site.cell_world.joints() - site.cell.q_look).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_FALSE(site.cell_world.hold().holds_any());
  for (std::size_t c = 0; c < site.cell_world.hold().cups().size(); ++c) {
    const Pose X_WU = site.cell.tip_pose(site.cell.q_look) * site.cell.gripper->cups()[c].X_GU;
    EXPECT_LT(distance_between(site.cell_world.hold().X_WU(c), X_WU), 1e-3) << "lip " << c;
  }
}

Eigen::Vector3d top_of(const Site& site, std::size_t i) {
  return site.cell_world.box_center(i) + Eigen::Vector3d(0, 0, 0.008);
}

TEST(PickExecution, TwoPicksInARowLeaveTheThirdPartAlone) {
  Site site("mz07_three_cups.yaml");
  for (const double y : {-0.12, 0.0, 0.12}) site.lay({0, y, 0});
  site.start();
  const Eigen::Vector3d third = site.cell_world.box_center(2);
  const ExecutionResult first = execute_pick(site.cell_world, site.plan_at(top_of(site, 0)), ExecutionConfig{});
  PickPlan plan = site.plan_at(top_of(site, 1), 0.35, {0.12, 0, 0});
  const ExecutionResult second = execute_pick(site.cell_world, plan, ExecutionConfig{});
  EXPECT_EQ(first.outcome, PickOutcome::kSucceeded) << first.reason;
  EXPECT_EQ(second.outcome, PickOutcome::kSucceeded) << second.reason;
  EXPECT_EQ(second.neighbours_moved, 0);
  EXPECT_EQ(second.neighbours_dragged, 0);
  EXPECT_EQ(second.parts_lost, 0);
  EXPECT_TRUE(site.cell_world.in_tray(0) && site.cell_world.in_tray(1));
  EXPECT_LT((site.cell_world.box_center(2) - third).norm(), 1e-4);
}

TEST(PickExecution, SamePlanGivesTheSameBits) {
  std::vector<std::uint64_t> hashes;
  for (int run = 0; run < 2; ++run) {
    Site site("mz07_three_cups.yaml");
    site.lay({0.02, -0.05, 0});
    site.start();
    execute_pick(site.cell_world, site.plan_at(top_of(site, 0)), ExecutionConfig{});
    hashes.push_back(site.cell_world.world().state_hash());
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(PickExecution, AnIdealSealHoldsWhereALipLeaksAndNotWhereNothingIs) {
  ExecutionConfig ideal;
  ideal.ideal_seal = true;
  for (const Eigen::Vector3d& off : {Eigen::Vector3d(0.004, 0, 0), Eigen::Vector3d(0, 0, 0.03)}) {
    Site site("mz07_three_cups.yaml");
    site.lay({0, 0, 0});
    site.start();
    const ExecutionResult result = execute_pick(site.cell_world, site.plan_at(top_of(site, 0) + off), ideal);
    if (off.z() > 0) {
      expect_ended(site, result, PickOutcome::kNoSeal);
      EXPECT_NE(result.reason.find("touches no part"), std::string::npos) << result.reason;
    } else {
      EXPECT_EQ(result.outcome, PickOutcome::kSucceeded) << result.reason;
    }
  }
}

TEST(PickExecution, SealHasTheBudgetOfTheLand) {
  // A 10 mm lip on a 15 mm land: 2.5 mm to either side (physical_models B1).
  for (const double offset : {0.0015, 0.0040}) {
    Site site("mz07_three_cups.yaml");
    site.lay({0, 0, 0});
    site.start();
    const Eigen::Vector3d aside(offset, 0, 0);
    const ExecutionResult result =
        execute_pick(site.cell_world, site.plan_at(top_of(site, 0) + aside), ExecutionConfig{});
    if (offset < 0.0025) {
      EXPECT_EQ(result.outcome, PickOutcome::kSucceeded) << result.reason;
    } else {
      expect_ended(site, result, PickOutcome::kNoSeal);
      EXPECT_TRUE(site.cell_world.in_bin(0));
      EXPECT_FALSE(result.lifted.has_value());
    }
  }
}

TEST(PickExecution, OneCupOnTheLandPeelsDuringTheLift) {
  Site site("mz07_three_cups.yaml", "{type: suction, cups: [{radius: 6 mm, lip_compliance: 0.5 mm}]}");
  site.lay({0, 0, 0});
  site.start();
  const Eigen::Vector3d land(0.0425, 0, 0);
  const ExecutionResult result = execute_pick(site.cell_world, site.plan_at(top_of(site, 0) + land), ExecutionConfig{});
  expect_ended(site, result, PickOutcome::kPulledOff);
  EXPECT_NE(result.reason.find("peel"), std::string::npos);
  EXPECT_EQ(result.lifted, 0u);
  EXPECT_TRUE(site.cell_world.in_bin(0));
}

TEST(PickExecution, SlipperyLipsLoseThePartOnTheWay) {
  Site site("mz07_three_cups.yaml", three_cups("friction: 0.06"));
  site.lay({0, 0, 0});
  site.start();
  const ExecutionResult result = execute_pick(site.cell_world, site.plan_at(top_of(site, 0)), ExecutionConfig{});
  const bool back = site.cell_world.in_bin(0);
  expect_ended(site, result, back ? PickOutcome::kDroppedInBin : PickOutcome::kLostInTransit);
  EXPECT_NE(result.reason.find("transit"), std::string::npos);
}

TEST(PickExecution, AToolInTheBinsWallIsBlocked) {
  Site site("mz07_one_cup.yaml", "{type: suction, preset: one_cup, stem_radius: 30 mm}");
  site.lay({0, 0, 0});
  site.start();
  const Eigen::Vector3d wall = site.cell.X_WB * Eigen::Vector3d(site.cell.bin.inner_size.x() / 2 - 0.02, 0, 0.02);
  const ExecutionResult result = execute_pick(site.cell_world, site.plan_at(wall), ExecutionConfig{});
  expect_ended(site, result, PickOutcome::kPathBlocked);
  EXPECT_NE(result.reason.find("bin"), std::string::npos);
  EXPECT_GE(result.collisions.at("tool in the bin"), 1);
  EXPECT_GT(result.collision_depth, 0.002);  // where the arm stopped
}

TEST(PickExecution, AContactOnTheUnwatchedWayBackIsLogged) {
  Site site("mz07_three_cups.yaml");
  site.lay({0.02, -0.05, 0});
  site.start();
  PickPlan plan = site.plan_at(top_of(site, 0));
  const ExecutionResult clean = execute_pick(site.cell_world, plan, ExecutionConfig{});
  EXPECT_EQ(clean.outcome, PickOutcome::kSucceeded) << clean.reason;
  EXPECT_TRUE(clean.collisions.empty()) << clean.collisions.begin()->first;
  // The same again with nothing to lift but a way back that dips into the table beside the tray.
  const Eigen::Vector3d beside = site.cell.X_WB * Eigen::Vector3d(0, 0.33, 0.15);
  const Vector6d over = site.joints_for(down_at(beside), site.cell.q_look);
  const JointTrajectory down = site.straight(over, down_at(beside - Eigen::Vector3d(0, 0, 0.21)));
  ASSERT_FALSE(down.empty());
  plan = PickPlan{};
  plan.approach = joint_move(*site.cell.arm, site.cell.q_look, over, site.cell.motion);
  plan.lift = {{0}, {over}};
  plan.back = joined(down, site.straight(down.q.back(), down_at(beside)));
  site.cell_world.jump_to(site.cell.q_look);
  ArmRun arm(site.cell_world, ExecutionConfig{});
  EXPECT_TRUE(arm.follow(plan.approach, ArmRun::Watch::kCollisions));
  EXPECT_TRUE(arm.collisions().empty());
  EXPECT_TRUE(arm.follow(plan.back, ArmRun::Watch::kNothing));
  EXPECT_FALSE(arm.blocked());
  ASSERT_FALSE(arm.collisions().empty());
  EXPECT_EQ(arm.collisions().at("tool in the table"), 1);
  EXPECT_GT(arm.collision_depth(), 0.001);
}

TEST(PickExecution, TheCameraOnTheFlangeCollidesToo) {
  Site site("mz07_three_cups.yaml");
  site.lay({0, 0, 0});
  site.start();
  // Flange turned so that the camera, 140 mm beside the tool, hangs over the tray's side; down until its front meets
  // the table while the tool stays above it.
  Pose X_WF = site.cell.X_WR * site.cell.arm->forward(site.cell.q_look);
  const Eigen::Vector3d p_WC = X_WF * site.cell.camera.pose.translation();
  EXPECT_TRUE(site.cell_world.cell_contacts().empty());
  // A box at the camera's place would be met by nothing else: the tool's own boxes are 100 mm away.
  const BodyId probe = site.cell_world.world().add_fixed(
      std::vector<Primitive>{Primitive::box({0.02, 0.02, 0.02}, Pose(Eigen::Translation3d(p_WC)))}, Pose::Identity(),
      {});
  EXPECT_GT(site.cell_world.world().overlap(site.cell_world.tool_body, probe), 0.001);
}

TEST(PickExecution, PressingFarBeyondTheSurfaceStopsTheArm) {
  Site site("mz07_three_cups.yaml");
  site.lay({0, 0, 0});
  site.start();
  const Eigen::Vector3d deep(0, 0, -0.025);  // the plungers' stroke is 20 mm
  const ExecutionResult result = execute_pick(site.cell_world, site.plan_at(top_of(site, 0) + deep), ExecutionConfig{});
  expect_ended(site, result, PickOutcome::kProtectiveStop);
  EXPECT_GT(result.peak_force, ExecutionConfig{}.protective_force);
}

TEST(PickExecution, AHeldPartPushedIntoTheTrayStopsTheArm) {
  Site site("mz07_three_cups.yaml");
  site.lay({0, 0, 0});
  site.start();
  const Eigen::Vector3d below(0, 0, -0.050);  // 10 mm of air, 20 mm of plunger, then nothing gives
  const PickPlan plan = site.plan_at(top_of(site, 0), 0.35, below);
  const ExecutionResult result = execute_pick(site.cell_world, plan, ExecutionConfig{});
  expect_ended(site, result, PickOutcome::kProtectiveStop);
  EXPECT_NE(result.reason.find("held part on the tray"), std::string::npos) << result.reason;
  EXPECT_EQ(result.contact, "held part on the tray");
  EXPECT_GT(result.contact_force, ExecutionConfig{}.protective_force);
}

TEST(PickExecution, APlaceBesideTheTrayIsWrong) {
  Site site("mz07_three_cups.yaml");
  site.lay({0, 0, 0});
  site.start();
  const PickPlan plan = site.plan_at(top_of(site, 0), 0.35, {0.36, 0.02, 0});
  expect_ended(site, execute_pick(site.cell_world, plan, ExecutionConfig{}), PickOutcome::kWrongPlace);
}

TEST(PickExecution, TwoPartsAtOnceAreADoublePick) {
  // Three cups, one of them over a neighbour: plates side by side, each held by what seals on it.
  Site site("mz07_one_cup.yaml",
            "{type: suction, cups: [{pose: {xyz: [-30 mm, 0, 0]}, radius: 8 mm}, "
            "{pose: {xyz: [30 mm, 0, 0]}, radius: 8 mm}]}",
            plate());
  site.lay({-0.03, 0, 0});
  site.lay({0.03, 0, 0});
  site.start();
  const Eigen::Vector3d top = (site.cell_world.box_center(0) + site.cell_world.box_center(1)) / 2;
  const ExecutionResult result =
      execute_pick(site.cell_world, site.plan_at(top + Eigen::Vector3d(0, 0, 0.008)), ExecutionConfig{});
  expect_ended(site, result, PickOutcome::kDoublePick);
  EXPECT_EQ(result.neighbours_dragged, 1);
  EXPECT_EQ(result.parts_dropped_back, 0);
}

/// One plate lies across another's edge; a cup lifts the lower one where it is free.
ExecutionResult lift_from_below(const Part& part, double overlap, Eigen::Vector3d* other_at) {
  Site site("mz07_one_cup.yaml", "{type: suction, cups: [{radius: 8 mm}]}", part);
  site.lay({0, 0, 0});
  site.lay({0.05 - overlap, 0, 0.0161});
  site.start();
  const Eigen::Vector3d contact = site.cell_world.box_center(0) + Eigen::Vector3d(-0.015, 0, 0.008);
  const ExecutionResult result = execute_pick(site.cell_world, site.plan_at(contact), ExecutionConfig{});
  *other_at = site.cell.X_WB.inverse() * site.cell_world.box_center(1);
  return result;
}

TEST(PickExecution, WhatSlidesOffTheLiftedPartIsDroppedBack) {
  Eigen::Vector3d other_B;
  const ExecutionResult result = lift_from_below(plate_of(0.3), 0.026, &other_B);
  EXPECT_EQ(result.outcome, PickOutcome::kSucceeded) << result.reason;
  EXPECT_EQ(result.neighbours_dragged, 1);
  EXPECT_EQ(result.parts_dropped_back, 1);
  EXPECT_EQ(result.parts_lost, 0);
  EXPECT_NEAR(other_B.z(), 0.008, 0.5e-3) << "it lies flat on the bin's floor";
}

TEST(PickExecution, WhatRidesAlongAndFallsOnTheTableIsLost) {
  Eigen::Vector3d other_B;
  const ExecutionResult result = lift_from_below(plate_of(2.0), 0.029, &other_B);
  EXPECT_EQ(result.outcome, PickOutcome::kDoublePick);
  EXPECT_EQ(result.neighbours_dragged, 1);
  EXPECT_EQ(result.parts_dropped_back, 0);
  EXPECT_EQ(result.parts_lost, 1);
  EXPECT_GT(other_B.head<2>().cwiseAbs().cwiseQuotient(Eigen::Vector2d(0.2, 0.15)).maxCoeff(), 1) << "outside the bin";
}

}  // namespace
}  // namespace binpick

// Shared by the robot tests: the repository's arm and cells.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "core/random.hpp"
#include "core/yaml.hpp"
#include "robot/cell.hpp"

namespace binpick::testing_robot {

inline std::string asset(const std::string& path) { return std::string(BINPICK_SOURCE_DIR) + "/assets/" + path; }

inline Arm mz07() { return Arm::load(asset("arms/mz07.urdf")); }

inline Cell cell_named(const std::string& name) {
  Cell cell = read_config_file<Cell>(asset("cells/" + name + ".yaml"));
  cell.finish();
  return cell;
}

/// A cell of every arm in assets/arms, each with a tool that holds a bearing.
inline const auto kCellOfEveryArm =
    testing::Values("mz07_three_cups", "ur5e", "kr6_r900", "lrmate_200id", "tx2_60l", "irb1200_5_90");

inline Vector6d random_joints(const Arm& arm, Rng rng) {
  Vector6d q;
  for (int i = 0; i < 6; ++i) {
    const JointLimits& limits = arm.limits()[static_cast<std::size_t>(i)];
    q[i] = rng.uniform(limits.lower, limits.upper);
  }
  return q;
}

inline double largest_difference(const Pose& X_1, const Pose& X_2) {
  return (X_1.matrix() - X_2.matrix()).cwiseAbs().maxCoeff();
}

}  // namespace binpick::testing_robot

// Shared by the tests of arms of several makes: the six arms, and ways to compare joint positions.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <algorithm>
#include <fstream>
#include <iterator>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "robot/inverse_kinematics.hpp"
#include "robot_fixture.hpp"

namespace binpick::testing_robot {

constexpr double kPi = std::numbers::pi;

struct ForeignArm {
  const char* file;
  const char* tip;
  bool closed_form, exact;
};
inline std::ostream& operator<<(std::ostream& out, const ForeignArm& arm) { return out << arm.file; }

inline const ForeignArm kArms[] = {
    {"mz07.urdf", "flange", true, true},        {"kr6_r900.urdf", "tool0", true, true},
    {"lrmate_200id.urdf", "tool0", true, true}, {"irb1200_description/urdf/irb1200_5_90.urdf", "tool0", true, true},
    {"tx2_60l.urdf", "link_6", true, false},    {"ur5e.urdf", "tool0", false, false}};

inline std::string text_of(const std::string& file) {
  std::ostringstream buffer;
  buffer << std::ifstream(file).rdbuf();
  return buffer.str();
}

/// Largest difference of two joint positions, whole turns ignored.
inline double turned_difference(const Vector6d& a, const Vector6d& b) {
  double most = 0;
  for (int i = 0; i < 6; ++i) most = std::max(most, std::abs(std::remainder(a[i] - b[i], 2 * kPi)));
  return most;
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

/// Smallest singular value of the Jacobian (m and rad per rad), by differences: a pose rounded by e moves the joints by
/// up to e over this.
inline double least_gain(const Arm& arm, const Vector6d& q) {
  constexpr double kStep = 1e-6;
  Matrix6d J;
  for (int i = 0; i < 6; ++i) {
    Vector6d before = q, after = q;
    before[i] -= kStep, after[i] += kStep;
    const Pose X_1 = arm.forward(before), X_2 = arm.forward(after);
    J.col(i) << (X_2.translation() - X_1.translation()) / (2 * kStep),
        log_so3(X_2.linear() * X_1.linear().transpose()) / (2 * kStep);
  }
  return J.jacobiSvd().singularValues()[5];
}

inline std::vector<ForeignArm> closed_form_arms() {
  std::vector<ForeignArm> arms;
  std::copy_if(std::begin(kArms), std::end(kArms), std::back_inserter(arms),
               [](const ForeignArm& arm) { return arm.closed_form; });
  return arms;
}

/// One test for each of the arms.
class EveryArm : public testing::TestWithParam<ForeignArm> {
 protected:
  Arm arm = Arm::load(asset(std::string("arms/") + GetParam().file));
};

}  // namespace binpick::testing_robot

// The paper's tables beside ours: wrapped angles, poses that were not recognised, intervals, the paper's slips.
#include "evaluation/paper_tables.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "evaluation/statistics.hpp"
#include "tests/evaluation/example_records.hpp"

namespace binpick {
namespace {

using testing::HasSubstr;

constexpr double kDegree = std::numbers::pi / 180;

VerifiedPose verified(double yaw_taught, double yaw_found, const Eigen::Vector3d& shift) {
  VerifiedPose pose;
  pose.X_RG_taught = pose_from_xyz_rpy({0.5, 0.1, 0.05}, {0, 0, yaw_taught});
  pose.X_RG_found = pose_from_xyz_rpy(Eigen::Vector3d(0.5, 0.1, 0.05) + shift, {0, 0, yaw_found});
  return pose;
}

TEST(PaperTables, ErrorsAreAbsolutePerAxisAndAnglesWrap) {
  const std::vector<VerifiedPose> poses = {verified(179 * kDegree, -178 * kDegree, {1e-3, -2e-3, 3e-3})};
  const VerifiedErrors errors = verified_errors(poses);
  ASSERT_EQ(errors.xyz.size(), 1u);
  EXPECT_LT((errors.xyz[0] - Eigen::Vector3d(1e-3, 2e-3, 3e-3)).norm(), 1e-12);
  EXPECT_LT((errors.rpy[0] - Eigen::Vector3d(0, 0, 3 * kDegree)).norm(), 1e-9);
}

TEST(PaperTables, ThePapersRowsGiveItsAveragesWhereItsArithmeticHolds) {
  // physical_models, section 0: 2.02 / 0.73 / 2.08 mm and 0.47 / 0.40 / 0.84 deg, where 0.61 mm and 0.87 deg are
  // printed.
  const VerifiedErrors paper = paper_errors();
  Eigen::Vector3d xyz = Eigen::Vector3d::Zero(), rpy = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < 5; ++i) xyz += 1e3 * paper.xyz.at(i) / 5, rpy += paper.rpy.at(i) / kDegree / 5;
  EXPECT_LT((xyz - Eigen::Vector3d(2.02, 0.73, 2.08)).cwiseAbs().maxCoeff(), 0.0051);
  EXPECT_LT((rpy - Eigen::Vector3d(0.47, 0.40, 0.84)).cwiseAbs().maxCoeff(), 0.0051);
}

TEST(PaperTables, APartThatIsNotRecognisedSaysSoAndCountsInNoMean) {
  PaperComparison ours;
  ours.verifications = {{"ours", {verified(0, 0, {0.001, 0, 0}), {}, verified(0, 0, {0.003, 0, 0})}}};
  ours.verifications[0].poses[1].failure = "not recognised";
  const std::string page = paper_tables(ours);
  EXPECT_THAT(page, HasSubstr("| 2 | 3.49 / 0.08 / 4.33 | not recognised |"));
  EXPECT_THAT(page, HasSubstr("| 3 | 0.85 / 0.28 / 0.40 | 3.00 / 0.00 / 0.00 |"));
  EXPECT_THAT(page, HasSubstr("2.00 (0.00 - 14.71)"));  // 2 +- 12.706 mm: two values, cut off at 0
  const nlohmann::json json = nlohmann::json::parse(paper_json(ours));
  EXPECT_EQ(json.at("verification").at(0).at("poses"), 3);
  EXPECT_EQ(json.at("verification").at(0).at("abs_xyz_m").at(0).at("n"), 2);
  EXPECT_NEAR(json.at("verification").at(0).at("abs_xyz_m").at(0).at("mean").get<double>(), 0.002, 1e-12);
}

TEST(PaperTables, RoundsStandBesideThePapersAndItsSlipsAreNamed) {
  using examples::pick;
  PaperComparison ours;
  ours.rounds = {{"ours", {examples::trial(5000, {pick(PickOutcome::kSucceeded, 4, 3)})}}};
  const std::string page = paper_tables(ours);
  EXPECT_THAT(page, HasSubstr("| 1 | 10 / 10 | 1 / 10 in 1 picks |"));
  EXPECT_THAT(page, HasSubstr("48 / 50 (86.5 - 98.9 %)"));
  EXPECT_THAT(page, HasSubstr("| paper | 3 | 427 | 3706 | in voting | 299 | 8658 | 13090 |"));
  for (const char* slip : {"2.64 mm, not the 2.04", "0.47, not the 0.87", "484 / 3680 / 292 / 8567 / 13023"})
    EXPECT_THAT(page, HasSubstr(slip));
}

TEST(Statistics, StudentsIntervalOfAMean) {
  const std::vector<double> values = {1, 2, 3, 4, 5};  // s = sqrt(2.5), t(0.975, 4) = 2.776
  EXPECT_NEAR(student_interval(values).low, 3 - 2.7764451 * std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(student_interval(values).high, 3 + 2.7764451 * std::sqrt(0.5), 1e-6);
  EXPECT_TRUE(std::isinf(student_interval(std::vector<double>{1}).high));
}

}  // namespace
}  // namespace binpick

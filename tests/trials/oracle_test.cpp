#include "trials/oracle.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "core/primitive.hpp"

namespace binpick {
namespace {

Part box_part() {
  Part part;
  part.mesh_P = mesh_of(Primitive::box({0.06, 0.04, 0.02}, Pose(Eigen::Translation3d(0.5, 0, 0))));
  part.box_center_P = {0.5, 0, 0};
  part.diameter = 0.075;
  return part;
}

GroundTruth truth_of(int count) {
  GroundTruth truth;
  truth.X_WC = pose_from_xyz_rpy({0.1, 0.2, 0.6}, {3.0, 0.1, 0.2});
  for (int i = 0; i < count; ++i)
    truth.instances.push_back(
        {0, std::size_t(i), pose_from_xyz_rpy({0.1 * i, 0, 0}, {0.1 * i, 0, 1}), (i + 1.0) / count, 100});
  return truth;
}

TEST(Oracle, WithoutErrorItIsTheTruthInTheCameraFrame) {
  const std::vector<Part> parts = {box_part()};
  const GroundTruth truth = truth_of(5);
  const EstimateResult found = oracle_estimate(truth, parts, {}, Seed{1});
  ASSERT_EQ(found.estimates.size(), 4u);  // the one that is visible 0.2 is not reported
  EXPECT_EQ(found.status, EstimateStatus::kFound);
  for (std::size_t i = 0; i < 4; ++i) {
    const Pose X_WP = truth.X_WC * found.estimates[i].X_CP;
    EXPECT_LT((X_WP.matrix() - truth.instances[4 - i].X_WP.matrix()).cwiseAbs().maxCoeff(), 1e-12) << i;
  }
}

TEST(Oracle, TheErrorHasTheStatedSizeAtThePartsMiddle) {
  const std::vector<Part> parts = {box_part()};
  const GroundTruth truth = truth_of(1);
  OracleConfig config;
  config.translation_error = 0.003;
  config.rotation_error = 0.02;
  double square = 0, angle_square = 0;
  const int n = 4000;
  for (int k = 0; k < n; ++k) {
    const EstimateResult found = oracle_estimate(truth, parts, config, Seed{5}.child("draw", std::uint64_t(k)));
    const Pose X_WP = truth.X_WC * found.estimates.at(0).X_CP;
    square += (X_WP * parts[0].box_center_P - truth.instances[0].X_WP * parts[0].box_center_P).squaredNorm();
    angle_square += std::pow(angle_between(X_WP.linear(), truth.instances[0].X_WP.linear()), 2);
  }
  // Chi-square with 3 degrees: mean 3 sigma^2, standard deviation sqrt(6) sigma^2.
  EXPECT_NEAR(square / n / 9e-6, 3, 5 * std::sqrt(6.0 / n) + 0.01);
  EXPECT_NEAR(angle_square / n / 4e-4, 3, 5 * std::sqrt(6.0 / n) + 0.01);
}

TEST(Oracle, NothingVisibleIsNothingFound) {
  EXPECT_EQ(oracle_estimate(GroundTruth{}, {}, {}, Seed{1}).status, EstimateStatus::kNothingFound);
}

TEST(Oracle, RefusesNonsense) {
  OracleConfig config;
  config.translation_error = -1;
  EXPECT_THROW(config.validate(), SpecError);
}

}  // namespace
}  // namespace binpick

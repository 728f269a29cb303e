// Every registered metric: zero on the truth and on its symmetric twins, growing with the error, blind to the frame.
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "evaluation/metric.hpp"
#include "tests/evaluation/example_parts.hpp"

namespace binpick {
namespace {

class MetricContract : public testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<Metric> metric_ = make_metric(GetParam());
  Seed seed_ = Seed{20261124}.child("metric contract");
};

TEST_P(MetricContract, ZeroOnTruthAndItsTwins) {
  const std::vector<Part> parts = examples::all();
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const ScoringModel model(parts[k]);
    for (std::uint64_t i = 0; i < 40; ++i) {
      Rng rng = seed_.child("twins", k).rng().at(i);
      const Pose X_true = examples::random_pose(rng);
      EXPECT_NEAR(metric_->error(X_true, X_true, model), 0, 1e-9) << parts[k].name << ", item " << i;
      const Pose X_twin = X_true * examples::random_member(parts[k].symmetry, rng);
      EXPECT_NEAR(metric_->error(X_twin, X_true, model), 0, 1e-7) << parts[k].name << ", item " << i;
    }
  }
}

// Shifted and tilted by k steps: no metric may fall from step to step, and the last must be well above the first.
TEST_P(MetricContract, GrowsWithTheError) {
  for (const Part& part : {examples::box(), examples::disc(), examples::shaft(), examples::bracket()}) {
    const ScoringModel model(part);
    for (std::uint64_t i = 0; i < 20; ++i) {
      Rng rng = seed_.child("grows").rng().at(i);
      const Pose X_true = examples::random_pose(rng);
      const Eigen::Vector3d shift = 0.001 * rng.unit_vector();
      const Eigen::Vector3d across(rng.uniform(-1, 1), 1, 0);  // tilts the axis of the round ones
      double last = 0, first = 0;
      for (int step = 1; step <= 8; ++step) {
        Pose X_est = X_true * examples::turn(part.box_center_P, across, 0.01 * step);
        X_est.translation() += step * shift;
        const double error = metric_->error(X_est, X_true, model);
        EXPECT_GT(error, last) << part.name << ", item " << i << ", step " << step;
        if (step == 1) first = error;
        last = error;
      }
      EXPECT_GT(last, 4 * first) << part.name << ", item " << i;
    }
  }
}

TEST_P(MetricContract, SameInEveryFrame) {
  const std::vector<Part> parts = examples::all();
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const ScoringModel model(parts[k]);
    for (std::uint64_t i = 0; i < 20; ++i) {
      Rng rng = seed_.child("frames", k).rng().at(i);
      const Pose X_true = examples::random_pose(rng), X_AW = examples::random_pose(rng);
      const Pose X_est = X_true * examples::turn(parts[k].box_center_P, rng.unit_vector(), 0.2) *
                         examples::moved_to(0.002, 0.001, -0.003);
      const double error = metric_->error(X_est, X_true, model);
      EXPECT_NEAR(metric_->error(X_AW * X_est, X_AW * X_true, model), error, 3e-7) << parts[k].name << ", item " << i;
    }
  }
}

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const MetricEntry& entry : metric_registry()) all.push_back(entry.name);
  return all;
}
INSTANTIATE_TEST_SUITE_P(Registry, MetricContract, testing::ValuesIn(names()),
                         [](const auto& entry) { return entry.param; });

TEST(MetricRegistry, UnknownNameNamesTheNearest) {
  try {
    make_metric("msd");
    FAIL() << "accepted";
  } catch (const SpecError& error) {
    EXPECT_NE(std::string(error.what()).find("mssd"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace binpick

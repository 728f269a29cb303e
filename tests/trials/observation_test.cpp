// A second camera adds to the view and changes nothing about the first.

#include "trials/observation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace binpick {
namespace {

struct Look {
  Scenario scenario;
  TrialContext context;
  Observation seen;
};

std::unique_ptr<Look> look_at(const std::string& name, double shift = 0) {
  auto look = std::make_unique<Look>();
  look->scenario = read_scenario(std::string(BINPICK_SOURCE_DIR) + "/scenes/" + name + ".yaml");
  look->scenario.parts[0].count = 4;
  for (FurtherCamera& camera : look->scenario.cell.cameras) camera.pose.translation().y() += shift;
  look->context = make_trial_context(look->scenario);
  CellWorld cell_world(look->scenario.cell, look->scenario.physics, look->context.parts);
  drop_heap(look->scenario, look->context, Seed{12}, cell_world);
  look->seen = observe(look->scenario, cell_world, look->context, Seed{12}, 0);
  return look;
}

bool same_bits(const Image<float>& a, const Image<float>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](float x, float y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

TEST(TwoCameras, TheFirstSeesWhatItSeesAlone) {
  const auto one = look_at("bearing_bin"), two = look_at("bearing_bin_two_cameras");
  ASSERT_EQ(one->seen.captures.size(), 1u);
  ASSERT_EQ(two->seen.captures.size(), 2u);
  EXPECT_EQ(one->seen.frame_hash, frame_hash(one->seen.captures[0].frame));
  EXPECT_TRUE(std::holds_alternative<DepthFrame>(one->seen.view.seen));
  EXPECT_TRUE(same_bits(one->seen.captures[0].frame.depth, two->seen.captures[0].frame.depth));
  EXPECT_FALSE(same_bits(two->seen.captures[0].frame.depth, two->seen.captures[1].frame.depth));
  ASSERT_TRUE(std::holds_alternative<PointCloud>(two->seen.view.seen));
  const PointCloud& cloud = std::get<PointCloud>(two->seen.view.seen);
  std::size_t returns = 0;
  for (const Capture& capture : two->seen.captures)
    returns += static_cast<std::size_t>(std::count_if(capture.frame.depth.begin(), capture.frame.depth.end(),
                                                      [](float z) { return std::isfinite(z); }));
  EXPECT_EQ(cloud.size(), returns);
  EXPECT_TRUE(cloud.has_normals());
  for (std::size_t i = 0; i < one->seen.truth.instances.size(); ++i)
    EXPECT_GE(two->seen.truth.instances[i].visible_fraction, one->seen.truth.instances[i].visible_fraction);
}

TEST(TwoCameras, TheHashCoversBothFrames) {
  const auto here = look_at("bearing_bin_two_cameras"), again = look_at("bearing_bin_two_cameras"),
             moved = look_at("bearing_bin_two_cameras", 0.02);
  EXPECT_EQ(here->seen.frame_hash, again->seen.frame_hash);
  EXPECT_NE(here->seen.frame_hash, moved->seen.frame_hash);
  EXPECT_NE(here->seen.frame_hash, frame_hash(here->seen.captures[0].frame));
}

TEST(TwoCameras, TheEstimatorFindsThePartsInTheirCloud) {
  const auto two = look_at("bearing_bin_two_cameras");
  const EstimateResult found = two->scenario.estimator->estimate(two->seen.view, Seed{1});
  const PoseCheck check = two->context.checker->check(found, two->seen.X_WC_believed, two->seen.truth);
  ASSERT_GE(check.visible, 3u);
  EXPECT_EQ(check.found, check.visible);
  EXPECT_EQ(check.right, check.counted);
}

}  // namespace
}  // namespace binpick

// How many parts a fill level means.
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"
#include "trials/trial_context.hpp"

namespace binpick {
namespace {

Scenario scene(double fill) {
  Scenario scenario = read_scenario(std::string(BINPICK_SOURCE_DIR) + "/scenes/bearing_bin_oracle.yaml");
  scenario.drop.fill = fill;
  return scenario;
}

TEST(Fill, IsTheShareOfTheBinsVolumeThatThePartsAre) {
  Scenario scenario = scene(0.05);
  scenario.cell.bin.inner_size = {0.4, 0.3, 0.2};  // 24 l; a bearing is pi (50^2 - 35^2) 16 mm^3 = 64.09 cm^3
  EXPECT_EQ(make_trial_context(scenario).counts, std::vector<int>{static_cast<int>(std::lround(1200 / 64.09))});
}

TEST(Fill, WithoutItTheCountsStand) {
  Scenario scenario = scene(0);
  EXPECT_EQ(make_trial_context(scenario).counts, std::vector<int>{scenario.parts[0].count});
}

TEST(Fill, CountsSayTheMix) {
  Scenario scenario = scene(0.1);
  scenario.cell.bin.inner_size = {0.4, 0.3, 0.2};
  scenario.parts.push_back(scenario.parts[0]);
  scenario.parts[0].count = 1;
  scenario.parts[1].count = 3;
  const std::vector<int> counts = make_trial_context(scenario).counts;
  ASSERT_EQ(counts.size(), 2u);
  EXPECT_EQ(counts[0], static_cast<int>(std::lround(2400 / 64.09 / 4)));
  EXPECT_EQ(counts[1], static_cast<int>(std::lround(2400 / 64.09 * 3 / 4)));
}

TEST(Fill, TooLittleAndTooMuchAreRefused) {
  Scenario scenario = scene(1e-6);
  EXPECT_THROW(make_trial_context(scenario), SpecError);
  scenario = scene(0.5);
  scenario.cell.bin.inner_size = {1, 1, 1};  // 7800 bearings
  EXPECT_THROW(make_trial_context(scenario), SpecError);
}

}  // namespace
}  // namespace binpick

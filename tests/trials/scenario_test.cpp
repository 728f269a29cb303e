#include "trials/scenario.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/yaml.hpp"

namespace binpick {
namespace {

namespace fs = std::filesystem;

const std::string kScenes = std::string(BINPICK_SOURCE_DIR) + "/scenes/";

class ScenarioFiles : public testing::TestWithParam<const char*> {};

TEST_P(ScenarioFiles, TheExpandedFileReplays) {
  const Scenario scenario = read_scenario(kScenes + GetParam());
  const fs::path folder = fs::temp_directory_path() / ("binpick_scenario_" + std::to_string(::getpid()));
  make_folder(folder.string());
  const std::string text = expanded_yaml(scenario, folder.string());
  write_file((folder / "scenario.yaml").string(), text);
  const Scenario again = read_scenario((folder / "scenario.yaml").string());
  EXPECT_EQ(expanded_yaml(again, folder.string()), text);
  EXPECT_EQ(scenario_hash(again), scenario_hash(scenario));
  fs::remove_all(folder);
}

INSTANTIATE_TEST_SUITE_P(Shipped, ScenarioFiles,
                         testing::Values("bearing_bin.yaml", "bearing_bin_matt.yaml", "bearing_bin_oracle.yaml",
                                         "bearing_bin_two_cameras.yaml", "bracket_bin.yaml", "tee_bin.yaml"));

TEST(Scenario, SensorOverrideIsTheSensorThatTheFileWouldName) {
  Scenario scenario = read_scenario(kScenes + "bearing_bin.yaml", {"disparity:d415_1280"});
  EXPECT_EQ(scenario.cell.camera.intrinsics.width, 1280);
  EXPECT_EQ(scenario.sensor->z_min(), 0.402);
  Scenario named = read_scenario(kScenes + "bearing_bin.yaml");
  EXPECT_NE(scenario_hash(scenario), scenario_hash(named));
  const Scenario same = read_scenario(kScenes + "bearing_bin.yaml", {"disparity:d435_848"});
  EXPECT_EQ(scenario_hash(same), scenario_hash(named));
  EXPECT_THROW(read_scenario(kScenes + "bearing_bin.yaml", {"disparity:d436"}), SpecError);
  EXPECT_THROW(read_scenario(kScenes + "bearing_bin.yaml", {":d435_848"}), SpecError);
}

TEST(Scenario, EveryValueIsInTheHash) {
  Scenario scenario = read_scenario(kScenes + "bearing_bin.yaml");
  const std::string before = scenario_hash(scenario);
  scenario.drop.height += 1e-9;
  EXPECT_NE(scenario_hash(scenario), before);
  scenario = read_scenario(kScenes + "bearing_bin.yaml");
  scenario.parts[0].count = 9;
  EXPECT_NE(scenario_hash(scenario), before);
}

}  // namespace
}  // namespace binpick

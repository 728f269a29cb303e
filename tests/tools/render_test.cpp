// binpick render: the files agree with each other, with the trial's record, and show what lies in the bin.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "core/file_io.hpp"
#include "core/image_io.hpp"
#include "tests/tools/run_program.hpp"

namespace binpick {
namespace {

using testing::HasSubstr;

/// The value of a key at the start of a line of render.yaml.
std::string value_of(const std::string& yaml, const std::string& key) {
  const std::size_t at = yaml.find("\n" + key + ": ");
  if (at == std::string::npos) return "";
  const std::size_t from = at + key.size() + 3;
  return yaml.substr(from, yaml.find('\n', from) - from);
}

class Render : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder();
    const std::string root = BINPICK_SOURCE_DIR;
    write_file(scene(), "part: " + root + "/assets/parts/tee/part.yaml\ncount: 5\ncell: " + root +
                            "/assets/cells/mz07_one_cup.yaml\nestimator: {type: oracle}\ntrial: {max_picks: 1}\n");
    run_ = new ProgramRun(run_program("render " + scene() + " --seed 4 --out " + folder_->path("look")));
    ASSERT_EQ(run_->code, 0) << run_->err;
  }
  static void TearDownTestSuite() {
    delete run_;
    delete folder_;
  }
  static std::string scene() { return folder_->path("scene.yaml"); }
  static std::string file(const std::string& name) { return folder_->path("look/" + name); }
  static std::string yaml() { return read_file(file("render.yaml")); }
  static TemporaryFolder* folder_;
  static ProgramRun* run_;
};
TemporaryFolder* Render::folder_ = nullptr;
ProgramRun* Render::run_ = nullptr;

TEST_F(Render, TheFrameIsTheTrialsFirstLook) {
  const ProgramRun trial = run_program("trial " + scene() + " --seed 4");
  ASSERT_EQ(trial.code, 0) << trial.err;
  const nlohmann::json record = nlohmann::json::parse(trial.out);
  EXPECT_EQ(value_of(yaml(), "frame_hash"), record["picks"][0]["frame_hash"].get<std::string>());
  EXPECT_EQ(value_of(yaml(), "scenario_hash"), record["scenario_hash"].get<std::string>());
  const std::string other = folder_->path("other");
  ASSERT_EQ(run_program("render " + scene() + " --seed 5 --out " + other).code, 0);
  EXPECT_NE(value_of(yaml(), "frame_hash"), value_of(read_file(other + "/render.yaml"), "frame_hash"));
}

TEST_F(Render, TheSameAgain) {
  const std::string again = folder_->path("again");
  ASSERT_EQ(run_program("render " + scene() + " --seed 4 --out " + again).code, 0);
  for (const char* name :
       {"depth_mm.png", "depth.tiff", "ids.png", "noise.png", "preview.png", "shaded.png", "cloud.ply", "render.yaml"})
    EXPECT_EQ(read_file(file(name)), read_file(again + "/" + name)) << name;
}

TEST_F(Render, ThePngHoldsTheTiffInCounts) {
  const Image<float> depth = read_tiff(file("depth.tiff"));
  const Image<std::uint16_t> counts = read_png16(file("depth_mm.png"));
  ASSERT_EQ(counts.size(), depth.size());
  EXPECT_EQ(std::stod(value_of(yaml(), "depth_step")), 1e-4);  // nothing in this cell is farther than 6.5 m
  std::size_t returns = 0;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    ASSERT_EQ(counts[i] == 0, std::isnan(depth[i]));
    if (counts[i] == 0) continue;
    ++returns;
    ASSERT_NEAR(counts[i] * 1e-4, depth[i], 0.5e-4 + 1e-7);
  }
  EXPECT_NEAR(std::stod(value_of(yaml(), "returns")), double(returns) / double(depth.size()), 1e-12);
  EXPECT_THAT(read_file(file("cloud.ply")), HasSubstr("element vertex " + std::to_string(returns) + "\n"));
}

TEST_F(Render, EveryLabelIsInTheLegendAndEveryPartIsThere) {
  const Image<std::uint16_t> ids = read_png16(file("ids.png"));
  const std::set<std::uint16_t> seen(ids.begin(), ids.end());
  for (const std::uint16_t label : seen) EXPECT_THAT(yaml(), HasSubstr("value: " + std::to_string(label) + "\n"));
  for (std::uint16_t part = 1; part <= 5; ++part)
    EXPECT_TRUE(seen.count(part)) << part;  // T-pieces side by side: seed 4 hides none
  EXPECT_TRUE(seen.count(1000));
  EXPECT_THAT(yaml(), HasSubstr("name: bin\n"));
}

TEST_F(Render, AnotherSensorSeesTheSameHeap) {
  const std::string ideal = folder_->path("ideal");
  ASSERT_EQ(run_program("render " + scene() + " --seed 4 --sensor ideal --grey --out " + ideal).code, 0);
  EXPECT_THAT(read_file(ideal + "/grey.png").substr(1, 3), testing::StrEq("PNG"));
  EXPECT_EQ(read_file(ideal + "/ids.png"), read_file(file("ids.png")));
  const Image<float> exact = read_tiff(ideal + "/depth.tiff"), seen = read_tiff(file("depth.tiff"));
  ASSERT_EQ(exact.size(), seen.size());
  std::vector<float> errors;
  for (std::size_t i = 0; i < exact.size(); ++i)
    if (std::isfinite(exact[i]) && std::isfinite(seen[i])) errors.push_back(std::abs(exact[i] - seen[i]));
  ASSERT_GT(errors.size(), exact.size() / 2);
  std::nth_element(errors.begin(), errors.begin() + errors.size() / 2, errors.end());
  EXPECT_GT(errors[errors.size() / 2], 1e-4);  // noise there is
  EXPECT_LT(errors[errors.size() / 2], 4e-3);  // but of this heap: 0.08 px at 0.6 m are 1.3 mm
}

}  // namespace
}  // namespace binpick

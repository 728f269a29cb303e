// binpick part: figures of a box known on paper, the picture, and what a user can get wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/file_io.hpp"
#include "core/mesh_io.hpp"
#include "core/primitive.hpp"
#include "tests/tools/run_program.hpp"

namespace binpick {
namespace {

using testing::HasSubstr;

class PartCommand : public testing::Test {
 protected:
  PartCommand() {
    TriangleMesh box = mesh_of(Primitive::box({0.03, 0.03, 0.0432}));
    write_stl(folder_.path("box.stl"), box);
    box.triangles.pop_back();
    write_stl(folder_.path("open.stl"), box);
  }
  void expect_refused(const std::string& arguments, const std::string& said, int code = 2) {
    const ProgramRun run = run_program("part " + arguments);
    EXPECT_EQ(run.code, code) << arguments;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_THAT(run.err, HasSubstr(said));
  }
  TemporaryFolder folder_;
};

TEST_F(PartCommand, SaysWhatABoxIs) {
  const std::string json_file = folder_.path("box.json"), png_file = folder_.path("box.png");
  const ProgramRun run =
      run_program("part " + folder_.path("box.stl") + " --density 2000 --json " + json_file + " --png " + png_file);
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("30.0 x 30.0 x 43.2 mm"));
  const auto json = nlohmann::json::parse(read_file(json_file));
  EXPECT_NEAR(json["mass"]["mass_kg"], 0.03 * 0.03 * 0.0432 * 2000, 1e-8);
  EXPECT_NEAR(json["mesh"]["diameter_m"], std::sqrt(2 * 0.03 * 0.03 + 0.0432 * 0.0432), 1e-8);
  EXPECT_EQ(json["pieces"]["count"], 1);
  EXPECT_NEAR(json["pieces"]["volume_error"], 0, 1e-9);
  EXPECT_NEAR(json["pieces"]["hausdorff_m"], 0, 1e-9);
  // Square ends, 1.44 times as long: P(on an end) = (2 / pi) asin(1 / (1 + 1.44^2)).
  ASSERT_EQ(json["stable_poses"].size(), 2u);
  EXPECT_NEAR(json["stable_poses"][1]["probability"], 2 / std::numbers::pi * std::asin(1 / (1 + 1.44 * 1.44)), 1e-6);
  EXPECT_EQ(json["symmetry"]["axes"].size(), 5u);
  EXPECT_EQ(json["symmetry"]["axes"][0]["order"], 4);
  EXPECT_GT(std::filesystem::file_size(png_file), 20000u);
  EXPECT_EQ(read_file(png_file).substr(1, 3), "PNG");
}

TEST_F(PartCommand, TakesAFolderAndItsFileAlike) {
  const std::string folder = std::string(BINPICK_SOURCE_DIR) + "/assets/parts/tee";
  const ProgramRun by_folder = run_program("part " + folder), by_file = run_program("part " + folder + "/part.yaml");
  EXPECT_EQ(by_folder.code, 0) << by_folder.err;
  EXPECT_EQ(by_folder.out, by_file.out);
  EXPECT_THAT(by_folder.out, HasSubstr("half turns about (0 1 0)"));
}

TEST_F(PartCommand, AnOpenMeshNeedsItsMass) {
  expect_refused(folder_.path("open.stl"), "open.stl: the mesh is not closed");
  const ProgramRun run = run_program("part " + folder_.path("open.stl") + " --mass 0.1");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("OPEN"));
  EXPECT_THAT(run.out, HasSubstr("100.0 g"));
}

TEST_F(PartCommand, BadInputIsOneLine) {
  expect_refused(folder_.path("no_such.stl"), "no_such.stl");
  expect_refused(folder_.path("no_such/part.yaml"), "part.yaml");
  expect_refused(folder_.path(), "part.yaml");  // a folder without one
  write_file(folder_.path("text.txt"), "solid\n");
  expect_refused(folder_.path("text.txt"), "text.txt");
  expect_refused(folder_.path("box.stl") + " --density heavy", "heavy");
  expect_refused(std::string(BINPICK_SOURCE_DIR) + "/assets/parts/tee --mass 0.1", "part.yaml");
  expect_refused(folder_.path("box.stl") + " --json " + folder_.path("no/such/folder.json"), "folder.json", 6);
}

}  // namespace
}  // namespace binpick

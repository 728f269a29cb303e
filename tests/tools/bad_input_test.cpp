// What a user can get wrong: one clear line that names file and place, the exit code, and nothing written.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "core/file_io.hpp"
#include "core/mesh_io.hpp"
#include "core/primitive.hpp"
#include "tests/tools/run_program.hpp"

namespace binpick {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const std::string kRoot = BINPICK_SOURCE_DIR;

std::string scene(const std::string& part, const std::string& more = "") {
  return "name: test\n" + part + "cell: " + kRoot + "/assets/cells/mz07_one_cup.yaml\n" + more;
}

const std::string kBox = "part: {mesh: box.stl, density: 2700}\n";

struct BadScene {
  const char* name;
  std::string text;
  std::vector<const char*> said;
};

void PrintTo(const BadScene& bad, std::ostream* stream) { *stream << bad.name; }

class BadSceneTest : public testing::TestWithParam<BadScene> {
 protected:
  BadSceneTest() {
    const TriangleMesh box = mesh_of(Primitive::box({0.06, 0.04, 0.02}));
    write_stl(folder_.path("box.stl"), box);
    const std::string stl = read_file(folder_.path("box.stl"));
    write_file(folder_.path("empty.stl"), "");
    write_file(folder_.path("short.stl"), stl.substr(0, stl.size() - 30));
    std::string nan = stl;
    for (int i = 0; i < 4; ++i) nan[static_cast<std::size_t>(84 + 12 + i)] = '\xff';
    write_file(folder_.path("nan.stl"), nan);
    std::string lying = stl;
    lying[80] = 100;
    write_file(folder_.path("lying.stl"), lying);
    write_stl(folder_.path("metres.stl"), mesh_of(Primitive::box({0.06e-3, 0.04e-3, 0.02e-3})));
    TriangleMesh open = box;
    open.triangles.pop_back();
    write_stl(folder_.path("open.stl"), open);
    write_file(folder_.path("broken.step"), "ISO-10303-21;\nHEADER;\n");
  }
  TemporaryFolder folder_;
};

TEST_P(BadSceneTest, IsOneLineExitTwoAndNothingWritten) {
  write_file(folder_.path("scene.yaml"), GetParam().text);
  const std::string file = folder_.path("scene.yaml"), out = " --out " + folder_.path("run");
  for (const std::string& command : {"check " + file, "trial " + file + " --seed 1" + out,
                                     "campaign " + file + " --seeds 1:3" + out, "render " + file + " --seed 1" + out}) {
    const ProgramRun run = run_program(command);
    EXPECT_EQ(run.code, 2) << run.err;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    for (const char* part : GetParam().said) EXPECT_THAT(run.err, HasSubstr(part));
    EXPECT_TRUE(run.out.empty());
    EXPECT_FALSE(fs::exists(folder_.path("run")));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Table, BadSceneTest,
    testing::Values(
        BadScene{"unknown key", scene(kBox, "drop:\n  heihgt: 0.3\n"), {"scene.yaml:5", "drop.heihgt", "drop.height"}},
        BadScene{"unknown sensor", scene(kBox, "sensor: {type: disparty}\n"), {"scene.yaml:4", "disparity"}},
        BadScene{"unknown preset",
                 scene(kBox, "sensor: {type: disparity, preset: d435}\n"),
                 {"scene.yaml:4: sensor.preset", "did you mean d435_848?"}},
        BadScene{"misspelt preset",
                 scene(kBox, "sensor:\n  type: gauss_z\n  preset: azure_kinetc\n"),
                 {"scene.yaml:6: sensor.preset", "did you mean azure_kinect?"}},
        BadScene{"preset of another model",
                 scene(kBox, "sensor: {type: active_stereo, preset: kinect_v1}\n"),
                 {"scene.yaml:4: sensor.preset", "d435_848"}},
        BadScene{"near beyond far",
                 scene(kBox, "sensor: {type: disparity, z_min: 2 m, z_max: 1 m}\n"),
                 {"scene.yaml:4: sensor", "z_min 2 m and z_max 1 m"}},
        BadScene{"near beyond the preset's far",
                 scene(kBox, "sensor: {type: gauss_z, preset: zivid_2, z_min: 1.6}\n"),
                 {"scene.yaml:4: sensor", "z_min 1.6 m and z_max 1.5 m"}},
        BadScene{"near and far the same",
                 scene(kBox, "sensor: {type: ideal, z_min: 1, z_max: 1}\n"),
                 {"scene.yaml:4: sensor", "z_min 1 m and z_max 1 m"}},
        BadScene{"negative noise",
                 scene(kBox, "sensor: {type: disparity, subpixel_noise: -1}\n"),
                 {"scene.yaml:4: sensor", "subpixel_noise is -1"}},
        BadScene{"noise that is not a number",
                 scene(kBox, "sensor: {type: disparity, subpixel_noise: .nan}\n"),
                 {"scene.yaml:4: sensor.subpixel_noise", "not a finite number"}},
        BadScene{"zero resolution",
                 kBox + "cell: {base: " + kRoot +
                     "/assets/cells/mz07_one_cup.yaml, camera: {intrinsics: {width: 0, height: 480}}}\n",
                 {"scene.yaml", "cell.camera", "width and height"}},
        BadScene{
            "negative focal length",
            kBox + "cell: {base: " + kRoot + "/assets/cells/mz07_one_cup.yaml, camera: {intrinsics: {fx: -400}}}\n",
            {"scene.yaml", "cell.camera", "fx and fy must be positive"}},
        BadScene{"unknown estimator", scene(kBox, "estimator: {type: papr_ppf}\n"), {"estimator.type", "paper_ppf"}},
        BadScene{"zero parts", scene(kBox + "count: 0\n"), {"scene.yaml", "count", "at least one part"}},
        BadScene{"negative parts", scene(kBox + "count: -3\n"), {"scene.yaml", "count"}},
        BadScene{"no part", scene(""), {"scene.yaml", "part"}},
        BadScene{"missing mesh", scene("part: {mesh: no.stl}\n"), {"no.stl", "No such file"}},
        BadScene{"mesh is a folder", scene("part: {mesh: .}\n"), {"is not a regular file"}},
        BadScene{"empty mesh", scene("part: {mesh: empty.stl}\n"), {"empty.stl"}},
        BadScene{"truncated mesh", scene("part: {mesh: short.stl}\n"), {"short.stl"}},
        BadScene{"NaN in the mesh", scene("part: {mesh: nan.stl}\n"), {"nan.stl"}},
        BadScene{"lying count", scene("part: {mesh: lying.stl}\n"), {"lying.stl"}},
        BadScene{"metres read as mm", scene("part: {mesh: metres.stl}\n"), {"metres.stl", "unit"}},
        BadScene{"open mesh without mass", scene("part: {mesh: open.stl}\n"), {"open.stl", "mass"}},
        BadScene{"broken STEP", scene("part: {mesh: broken.step}\n"), {"broken.step"}},
        BadScene{"unknown format", scene("part: {mesh: scene.yaml}\n"), {"scene.yaml"}},
        BadScene{"unknown unit", scene("part: {mesh: box.stl, unit: furlong}\n"), {"unit"}},
        BadScene{"missing part.yaml", scene("part: nowhere/part.yaml\n"), {"nowhere/part.yaml"}},
        BadScene{"bin smaller than the part",
                 "part: {mesh: box.stl}\ncell: {base: " + kRoot +
                     "/assets/cells/mz07_one_cup.yaml, bin: {inner_size: [30 mm, 30 mm, 50 mm]}}\n",
                 {"scene.yaml", "bin", "part"}},
        BadScene{"unreachable tray",
                 "part: {mesh: box.stl}\ncell: {base: " + kRoot +
                     "/assets/cells/mz07_one_cup.yaml, tray: {pose: {xyz: [3, 0, 0]}}}\n",
                 {"tray", "reach"}},
        BadScene{"camera inside a wall",
                 "part: {mesh: box.stl}\ncell: {base: " + kRoot +
                     "/assets/cells/mz07_one_cup.yaml, look: {joints: [0, 0, 0, 0, 90 deg, 0]}, "
                     "camera: {mount: fixed, pose: {xyz: [647 mm, 0, 100 mm]}}}\n",
                 {"scene.yaml", "cell.camera.pose", "inside a wall"}},
        BadScene{"folding lens",
                 "part: {mesh: box.stl}\ncell: {base: " + kRoot +
                     "/assets/cells/mz07_one_cup.yaml, camera: {lens: {k1: -0.8}}}\n",
                 {"scene.yaml", "cell.camera", "folds at radius"}},
        BadScene{"missing arm",
                 "part: {mesh: box.stl}\ncell: {base: " + kRoot + "/assets/cells/mz07_one_cup.yaml, arm: no.urdf}\n",
                 {"no.urdf"}},
        BadScene{"wrong unit of a value", scene(kBox, "drop: {height: 3 kg}\n"), {"scene.yaml:4", "drop.height", "kg"}},
        BadScene{"not YAML", "part: [\n", {"scene.yaml"}}, BadScene{"empty file", "", {"scene.yaml", "empty"}}));

TEST(BadUsage, EndsWithTwo) {
  for (const char* arguments :
       {"", "trail", "trial", "trial x.yaml", "trial x.yaml --seed -1", "trial x.yaml --seed a",
        "campaign x.yaml --seeds 5:3 --out y", "campaign x.yaml --seeds 5 --out y",
        "campaign x.yaml --seeds 0:2 --out y --workers 0", "report /nonexistent", "trial /nonexistent.yaml --seed 1",
        "render x.yaml --seed 1", "render /nonexistent.yaml --seed 1 --out y", "list sensor"}) {
    const ProgramRun run = run_program(arguments);
    EXPECT_EQ(run.code, 2) << arguments << "\n" << run.err;
    EXPECT_FALSE(run.err.empty()) << arguments;
  }
}

class Storage : public testing::Test {
 protected:
  Storage() {
    write_stl(folder_.path("box.stl"), mesh_of(Primitive::box({0.06, 0.04, 0.02})));
    write_file(folder_.path("scene.yaml"), scene(kBox + "count: 1\n", "estimator: {type: oracle}\n"));
  }
  TemporaryFolder folder_;
};

// A file-size limit makes every write fail as a full disk does. It holds for the program alone: what it says leaves
// through a pipe.
TEST_F(Storage, AFullDiskEndsWithSix) {
  for (const std::string command : {"trial", "campaign", "render"}) {
    const std::string seeds = command == "campaign" ? " --seeds 1:3" : " --seed 1";
    const ProgramRun run = run_program(command + " " + folder_.path("scene.yaml") + seeds + " --out " +
                                           folder_.path("run_" + command) + ") 2>&1 | cat >&2; exit ${PIPESTATUS[0]}",
                                       "(ulimit -f 0");
    EXPECT_EQ(run.code, 6) << command << "\n" << run.err;
    EXPECT_THAT(run.err, HasSubstr("run_" + command)) << "the message names the file";
  }
}

TEST_F(Storage, AFullDeviceOnStandardOutputEndsWithSix) {
  EXPECT_EQ(run_program("trial " + folder_.path("scene.yaml") + " --seed 1 >/dev/full").code, 6);
}

TEST_F(Storage, AFolderThatCannotBeMadeEndsWithSix) {
  EXPECT_EQ(run_program("render " + folder_.path("scene.yaml") + " --seed 1 --out " + folder_.path("box.stl/run")).code,
            6);
  EXPECT_EQ(run_program("trial " + folder_.path("scene.yaml") + " --seed 1 --out " + folder_.path("box.stl/run")).code,
            6);
  EXPECT_EQ(
      run_program("campaign " + folder_.path("scene.yaml") + " --seeds 1:2 --out " + folder_.path("box.stl/run")).code,
      6);
}

TEST(BadValidate, IsOneLineAndItsExitCode) {
  const TemporaryFolder folder;
  write_file(folder.path("file"), "");
  const struct {
    std::string arguments;
    int code;
    const char* said;
  } cases[] = {{"validate", 2, "subject"},
               {"validate sensor", 2, "sensor"},
               {"validate sensors --seeds 3", 2, "A:B"},
               {"validate sensors --seeds 0:2000", 2, "1000"},
               {"validate sensors --threads 0", 2, "threads"},
               {"validate sensors --quick --json " + folder.path("file/v.json"), 6, "file/v.json"},
               {"validate sensors --quick --json " + folder.path("no/v.json"), 6, "no/v.json"},
               {"validate sensors --quick --plots " + folder.path("file/plots"), 6, "file/plots"}};
  for (const auto& c : cases) {
    const ProgramRun run = run_program(c.arguments);
    EXPECT_EQ(run.code, c.code) << c.arguments << "\n" << run.err;
    EXPECT_THAT(run.err, HasSubstr(c.said)) << c.arguments;
    EXPECT_TRUE(run.out.empty()) << c.arguments;
    if (c.code == 6) {
      EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    }
  }
}

}  // namespace
}  // namespace binpick

// What a user can get wrong with a frame of his own: one clear line, exit code 2, nothing printed.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/file_io.hpp"
#include "core/image_io.hpp"
#include "core/mesh_io.hpp"
#include "core/primitive.hpp"
#include "tests/tools/run_program.hpp"

namespace binpick {
namespace {

using testing::HasSubstr;

const std::string kBearing = BINPICK_SOURCE_DIR "/assets/parts/bearing_6914/part.yaml";

class BadFrameInput : public testing::Test {
 protected:
  BadFrameInput() {
    write_file(bad_.path("camera.yaml"), "width: 32\nheight: 32\nfx: 40\nfy: 40\ncx: 15.5\ncy: 15.5\n");
    write_file(bad_.path("bin.yaml"), "bin: {inner_size: [60 mm, 50 mm, 40 mm]}\nX_CB: {xyz: [0, 0, 0.5]}\n");
    write_png16(bad_.path("depth.png"), Image<std::uint16_t>(32, 32, 500));
  }
  void expect_said(const std::string& arguments, const std::vector<const char*>& said) {
    const ProgramRun run = run_program("estimate " + arguments);
    EXPECT_EQ(run.code, 2) << arguments << "\n" << run.err;
    for (const char* word : said) EXPECT_THAT(run.err, HasSubstr(word)) << arguments;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_TRUE(run.out.empty());
  }
  std::string image() const { return " --depth " + bad_.path("depth.png") + " --camera " + bad_.path("camera.yaml"); }
  std::string cloud(const std::string& name, const std::string& text) const {
    write_file(bad_.path(name), text);
    return "--part " + kBearing + " --cloud " + bad_.path(name);
  }
  TemporaryFolder bad_;
};

TEST_F(BadFrameInput, WhatIsAskedForMustMakeSense) {
  const std::string part = "--part " + kBearing;
  expect_said("", {"--part"});
  expect_said(part, {"--depth or --cloud"});
  expect_said(part + image() + " --cloud x.ply", {"--depth or --cloud"});
  expect_said(part + " --depth " + bad_.path("depth.png"), {"--camera"});
  expect_said("somewhere " + part + image(), {"somewhere", "recorded frame"});
  expect_said(part + image() + " --noise 5", {"noise"});
  expect_said(part + image() + " --estimator pfp", {"pfp", "ppf"});
  expect_said(part + image() + " --estimator external", {"estimator.command"});
}

TEST_F(BadFrameInput, FilesAreRefusedByName) {
  const std::string part = "--part " + kBearing;
  expect_said("--part nowhere.stl" + image(), {"nowhere.stl"});
  expect_said("--part " + bad_.path("depth.png") + image(), {"depth.png"});
  expect_said(part + " --depth nowhere.png --camera " + bad_.path("camera.yaml"), {"nowhere.png"});
  expect_said(part + " --depth " + bad_.path("depth.png") + " --camera nowhere.yaml", {"nowhere.yaml"});
  expect_said(part + image() + " --bin nowhere.yaml", {"nowhere.yaml"});
  write_file(bad_.path("depth.jpg"), "x");
  expect_said(part + " --depth " + bad_.path("depth.jpg") + " --camera " + bad_.path("camera.yaml"),
              {"depth.jpg", ".png"});
  write_file(bad_.path("empty.png"), "");
  expect_said(part + " --depth " + bad_.path("empty.png") + " --camera " + bad_.path("camera.yaml"), {"empty.png"});
  write_png8(bad_.path("grey.png"), Image<std::uint8_t>(32, 32, 100));
  expect_said(part + " --depth " + bad_.path("grey.png") + " --camera " + bad_.path("camera.yaml"),
              {"grey.png", "16-bit"});
  write_png16(bad_.path("small.png"), Image<std::uint16_t>(16, 32, 500));
  expect_said(part + " --depth " + bad_.path("small.png") + " --camera " + bad_.path("camera.yaml"),
              {"small.png", "16 x 32", "32 x 32"});
  write_file(bad_.path("camera.yaml"), "width: 32\nheight: 32\nfx: 40\ncx: 15.5\ncy: 15.5\n");
  expect_said(part + image(), {"camera.yaml", "fy", "is needed"});
  write_file(bad_.path("camera.yaml"), "width: 0\nheight: 32\nfx: 40\nfy: 40\ncx: 15.5\ncy: 15.5\n");
  expect_said(part + image(), {"camera.yaml", "width and height"});
}

TEST_F(BadFrameInput, MeshesThatCannotBeMeant) {
  write_stl(bad_.path("large.stl"), mesh_of(Primitive::box({0.2, 0.1, 0.1})));
  expect_said("--part " + bad_.path("large.stl") + image() + " --bin " + bad_.path("bin.yaml"),
              {"large.stl", "245 mm across", "88 mm"});
  TriangleMesh open = mesh_of(Primitive::box({0.04, 0.03, 0.02}));
  open.triangles.pop_back();
  write_stl(bad_.path("open.stl"), open);
  expect_said("--part " + bad_.path("open.stl") + image(), {"open.stl", "mass"});
}

TEST_F(BadFrameInput, CloudsThatCannotBeMeant) {
  const std::string ply = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n";
  const std::string pcd =
      "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\n"
      "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 1\n";
  expect_said("--part " + kBearing + " --cloud nowhere.pcd", {"nowhere.pcd"});
  expect_said(cloud("nan.ply", ply + "property float z\nend_header\nnan 0 1\n"), {"nan.ply:8", "not a finite number"});
  expect_said(cloud("flat.ply", ply + "end_header\n0 0\n"), {"flat.ply", "lack x, y or z"});
  expect_said(cloud("millimetres.ply", ply + "property float z\nend_header\n0 0 4000\n"), {"clouds are in metres"});
  expect_said(cloud("cut.pcd", pcd), {"cut.pcd", "PCD"});
  expect_said(cloud("millimetres.pcd", pcd + "DATA ascii\n0 0 4000\n"), {"millimetres.pcd", "metres"});
  expect_said(cloud("cloud.txt", "0 0 1\n"), {"cloud.txt", ".ply and .pcd"});
}

TEST(BadFrame, IsOneLineAndExitTwo) {
  const TemporaryFolder bad;
  const auto expect_said = [&](const std::string& said) {
    const ProgramRun run = run_program("estimate " + bad.path());
    EXPECT_EQ(run.code, 2) << run.err;
    EXPECT_THAT(run.err, HasSubstr(said));
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_TRUE(run.out.empty());
  };
  expect_said("request.yaml");
  write_file(bad.path("request.yaml"), "camera: {width: 848}\nparts: []\n");
  expect_said("at least one part");
  const std::string part = "parts: [{part: " + std::string(BINPICK_SOURCE_DIR) + "/assets/parts/tee/part.yaml}]\n";
  write_file(bad.path("request.yaml"), part);
  expect_said("depth.tiff");
  write_tiff(bad.path("depth.tiff"), Image<float>(32, 32, 0.6f));
  expect_said("32 x 32");
  write_file(bad.path("depth.tiff"), "II*");
  expect_said("depth.tiff");
  write_file(bad.path("request.yaml"), part + "seed: -1\n");
  expect_said("seed");
}

}  // namespace
}  // namespace binpick

// The perception library without the simulator: a recorded frame gives the poses that the trial had.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/file_io.hpp"
#include "core/image_io.hpp"
#include "core/quantity.hpp"
#include "core/yaml.hpp"
#include "perception/cloud_io.hpp"
#include "perception/frame_request.hpp"
#include "tests/tools/run_program.hpp"

namespace binpick {
namespace {

using testing::HasSubstr;

class Estimate : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder();
    const std::string root = BINPICK_SOURCE_DIR;
    write_file(folder_->path("scene.yaml"), "part: " + root + "/assets/parts/bearing_6914/part.yaml\ncount: 4\ncell: " +
                                                root + "/assets/cells/mz07_three_cups.yaml\ntrial: {max_picks: 1}\n");
    run_ =
        new ProgramRun(run_program("trial " + folder_->path("scene.yaml") + " --seed 3 --out " + folder_->path("run")));
  }
  static void TearDownTestSuite() {
    delete run_;
    delete folder_;
  }
  static std::string frame() { return folder_->path("run/artifacts/seed-3/00_frame"); }
  static std::string request() { return read_file(frame() + "/request.yaml"); }
  static TemporaryFolder* folder_;
  static ProgramRun* run_;
};
TemporaryFolder* Estimate::folder_ = nullptr;
ProgramRun* Estimate::run_ = nullptr;

TEST_F(Estimate, ARecordedFrameGivesTheTrialsPoses) {
  ASSERT_EQ(run_->code, 0) << run_->err;
  const ProgramRun estimate = run_program("estimate " + frame());
  ASSERT_EQ(estimate.code, 0) << estimate.err;
  EXPECT_EQ(estimate.out, read_file(frame() + "/estimates.csv"));
  EXPECT_GE(std::count(estimate.out.begin(), estimate.out.end(), '\n'), 2);
}

using Json = nlohmann::json;

const std::string kBearing = BINPICK_SOURCE_DIR "/assets/parts/bearing_6914/part.yaml";

/// The recorded frame as a real camera would deliver it: image, camera.yaml, bin.yaml, cloud.
class RealFrame : public Estimate {
 protected:
  RealFrame() : recorded_(read_frame_folder(frame())) {
    const auto& seen = std::get<DepthFrame>(recorded_.view.seen);
    write_tiff(real_.path("depth.tiff"), seen.depth);
    Image<std::uint16_t> steps(seen.depth.width(), seen.depth.height(), 0);
    for (std::size_t i = 0; i < steps.size(); ++i)
      if (std::isfinite(seen.depth[i])) steps[i] = static_cast<std::uint16_t>(std::lround(seen.depth[i] / kStep));
    write_png16(real_.path("depth.png"), steps);
    PinholeCamera camera = seen.camera;
    StatedNoise noise = seen.noise;
    write_file(real_.path("camera.yaml"), write_yaml([&](ConfigVisitor& v) {
                 camera.visit(v);
                 double step = kStep;
                 v.field("depth_scale", step, Unit::kLength, "");
                 visit_noise(v, noise);
               }));
    BinSpec bin = recorded_.request.bin;
    Pose X_CB = recorded_.request.X_CB;
    write_file(real_.path("bin.yaml"), write_yaml([&](ConfigVisitor& v) {
                 v.section("bin", bin, "");
                 v.field("X_CB", X_CB, "");
               }));
    write_cloud_ply(real_.path("cloud.ply"), unproject(seen), "frame C, metres");
    noise_ = "--noise " + format_double(noise.constant) + "," + format_double(noise.linear) + "," +
             format_double(noise.quadratic) + "," + format_double(noise.fattening_px);
  }

  std::string options(const std::string& image) const {
    return "estimate --part " + kBearing + " --bin " + real_.path("bin.yaml") +
           (image == "cloud.ply" ? " --cloud " + real_.path(image) + " " + noise_
                                 : " --depth " + real_.path(image) + " --camera " + real_.path("camera.yaml"));
  }
  /// The recorded poses, best first.
  std::vector<PoseEstimate> expected() const {
    const std::vector<Part> parts = {load_part(read_part_spec(kBearing))};
    return read_estimates_csv(frame() + "/estimates.csv", parts);
  }
  static Eigen::Vector3d place_of(const Json& estimate) {
    const Json& X = estimate["X_CP"];
    return {X[3].get<double>(), X[7].get<double>(), X[11].get<double>()};
  }

  static constexpr double kStep = 1e-4;  // m
  RecordedFrame recorded_;
  TemporaryFolder real_;
  std::string noise_;
};

TEST_F(RealFrame, AnImageGivesTheRecordedPosesAsJsonAndAPicture) {
  const ProgramRun run = run_program(options("depth.tiff") + " --overlay " + real_.path("found.png"));
  ASSERT_EQ(run.code, 0) << run.err;
  const Json json = Json::parse(run.out);
  EXPECT_EQ(json["schema"], 1);
  EXPECT_EQ(json["status"], "found");
  EXPECT_EQ(json["parts"][0]["name"], "bearing_6914");
  const std::vector<PoseEstimate> wanted = expected();
  ASSERT_EQ(json["estimates"].size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const Json& e = json["estimates"][i];
    EXPECT_EQ(e["score"], wanted[i].score);
    EXPECT_EQ(e["name"], "bearing_6914");
    EXPECT_EQ(e["ambiguous"].is_boolean(), true);
    ASSERT_EQ(e["X_CP"].size(), 16u);
    ASSERT_EQ(e["covariance"].size(), 36u);
    for (int k = 0; k < 16; ++k)  // the bin's pose went through text: nothing of it may be lost
      EXPECT_NEAR(e["X_CP"][k].get<double>(), wanted[i].X_CP.matrix()(k / 4, k % 4), 1e-9);
  }
  EXPECT_GT(read_file(real_.path("found.png")).size(), 1000u);
}

TEST_F(RealFrame, StepsAndCloudsGiveTheSamePartsToAMillimetre) {
  const std::vector<PoseEstimate> wanted = expected();
  for (const std::string image : {"depth.png", "cloud.ply"}) {
    const ProgramRun run = run_program(options(image) + " --json " + real_.path("found.json"));
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_TRUE(run.out.empty());
    const Json json = Json::parse(read_file(real_.path("found.json")));
    EXPECT_EQ(json["estimates"].size(), wanted.size()) << image;
    for (const PoseEstimate& e : wanted) {
      double nearest = 1;
      for (const Json& other : json["estimates"])
        nearest = std::min(nearest, (place_of(other) - e.X_CP.translation()).norm());
      EXPECT_LT(nearest, 1e-3) << image;
    }
  }
}

TEST_F(RealFrame, ABareMeshIsAPart) {
  const ProgramRun run =
      run_program("estimate --part " BINPICK_SOURCE_DIR "/assets/parts/tee/tee.stl --part " + kBearing + " --depth " +
                  real_.path("depth.tiff") + " --camera " + real_.path("camera.yaml") + " --bin " +
                  real_.path("bin.yaml") + " --seed 5 --estimator paper_ppf");
  ASSERT_EQ(run.code, 0) << run.err;
  const Json json = Json::parse(run.out);
  EXPECT_EQ(json["parts"][0]["name"], "tee");
  EXPECT_EQ(json["seed"], 5);
  EXPECT_EQ(json["estimator"], "paper_ppf");
  for (const Json& e : json["estimates"]) EXPECT_EQ(e["part"], 1);
}

TEST_F(RealFrame, AFrameThatHoldsNothingSaysWhy) {
  const auto& seen = std::get<DepthFrame>(recorded_.view.seen);
  const auto expect_nothing = [&](const std::string& arguments, const std::string& why) {
    const ProgramRun run = run_program(arguments);
    EXPECT_EQ(run.code, 0) << run.err;
    const Json json = Json::parse(run.out);
    EXPECT_EQ(json["status"], "nothing_found");
    EXPECT_TRUE(json["estimates"].empty());
    EXPECT_THAT(json["message"].get<std::string>(), HasSubstr(why));
    EXPECT_THAT(run.err, HasSubstr(why));
  };
  write_png16(real_.path("depth.png"), Image<std::uint16_t>(seen.depth.width(), seen.depth.height(), 0));
  expect_nothing(options("depth.png"), "no depth");
  write_file(real_.path("nan.pcd"),
             "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\n"
             "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ascii\nnan nan nan\nnan nan nan\n");
  expect_nothing("estimate --part " + kBearing + " --cloud " + real_.path("nan.pcd"), "no depth in view");
  PointCloud three;
  three.points = {{0, 0, 0.5}, {0.01, 0, 0.5}, {0, 0.01, 0.5}};
  write_cloud_ply(real_.path("three.ply"), three, "frame C, metres");
  expect_nothing("estimate --part " + kBearing + " --cloud " + real_.path("three.ply"), "only 3 points");
  PointCloud behind;
  behind.points = {{0, 0, -0.5}, {0.01, 0, -0.5}};
  write_cloud_ply(real_.path("behind.ply"), behind, "frame C, metres");
  expect_nothing("estimate --part " + kBearing + " --cloud " + real_.path("behind.ply"), "no depth in view");
}

}  // namespace
}  // namespace binpick

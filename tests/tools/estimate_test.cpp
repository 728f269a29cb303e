// The perception library without the simulator: a recorded frame gives the poses that the trial had.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/file_io.hpp"
#include "core/image_io.hpp"
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

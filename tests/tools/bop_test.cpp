// binpick bop as users call it: scores on standard output, figures as JSON, what is wrong in one line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/file_io.hpp"
#include "tests/evaluation/bop_dataset.hpp"
#include "tests/tools/run_program.hpp"

namespace binpick {
namespace {

using testing::HasSubstr;

class Bop : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder();
    examples::write_dataset(set());
  }
  static void TearDownTestSuite() { delete folder_; }
  static std::string set() { return folder_->path("set"); }
  static std::string csv() { return folder_->path("results.csv"); }
  static TemporaryFolder* folder_;
};
TemporaryFolder* Bop::folder_ = nullptr;

// 5 mm pass the thresholds of 6 .. 20 mm, eight of ten, whatever the symmetry.
TEST_F(Bop, TheTruthTurnedByItsSymmetriesAndShifted) {
  const ProgramRun truth = run_program("bop truth " + set() + " --seed 3 --twins --shift 0.005 --out " + csv());
  ASSERT_EQ(truth.code, 0) << truth.err;
  const std::string json = folder_->path("scores.json");
  const ProgramRun score = run_program("bop score " + set() + " " + csv() + " --json " + json);
  ASSERT_EQ(score.code, 0) << score.err;
  EXPECT_THAT(score.out, HasSubstr("AP_MSSD at 2 .. 20 mm 80.00 %"));
  EXPECT_NEAR(nlohmann::json::parse(read_file(json))["bop25_mAP_mm"].get<double>(), 0.8, 1e-12);
}

TEST_F(Bop, WhatIsWrongIsOneLineWithItsPlace) {
  write_file(csv(), "scene_id,im_id,obj_id,score,R,t,time\n0,4,1,0.5,1 0 0 0 1 0 0 0 1,1 2\n");
  ProgramRun run = run_program("bop score " + set() + " " + csv());
  EXPECT_EQ(run.code, 2);
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(run.err, "error: " + csv() + ":2: has 6 fields, not 7 (scene_id,im_id,obj_id,score,R,t,time)\n");
  run = run_program("bop export " + set() + " --out " + folder_->path("x"));
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.err, HasSubstr("is not a run folder"));
}

}  // namespace
}  // namespace binpick

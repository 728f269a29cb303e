// Tables of poses: what is written reads back, damaged tables are refused by line.
#include "perception/estimates_csv.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "core/random.hpp"
#include "tests/core/temp_folder.hpp"
#include "tests/perception/example_parts.hpp"

namespace binpick {
namespace {

using testing::HasSubstr;

const std::string kHead = "part,score,r11,r12,r13,r21,r22,r23,r31,r32,r33,tx,ty,tz\n";

std::vector<PoseEstimate> read(const std::string& text) {
  const TempFolder folder;
  const std::vector<Part> parts = {testing_scene::ring_part(), testing_scene::ring_part()};
  return read_estimates_csv(folder.put("estimates.csv", text), parts);
}

TEST(EstimatesCsv, WhatIsWrittenReadsBack) {
  EstimateResult result;
  for (std::uint64_t k = 0; k < 20; ++k) {
    Rng rng = Seed{k}.child("test/csv").rng();
    PoseEstimate e;
    e.part = k % 2;
    e.score = 1 - static_cast<double>(k) / 40;
    e.fit_rms = 1e-4 * static_cast<double>(k);
    e.inlier_fraction = 0.5;
    e.X_CP = pose_from(rng.rotation().toRotationMatrix(), rng.unit_vector());
    result.estimates.push_back(e);
  }
  const std::vector<PoseEstimate> back = read(estimates_csv(result));
  ASSERT_EQ(back.size(), result.estimates.size());
  for (std::size_t i = 0; i < back.size(); ++i) {
    EXPECT_EQ(back[i].part, result.estimates[i].part);
    EXPECT_EQ(back[i].score, result.estimates[i].score);
    EXPECT_EQ(back[i].fit_rms, result.estimates[i].fit_rms);
    EXPECT_EQ(back[i].X_CP.matrix(), result.estimates[i].X_CP.matrix());
  }
}

TEST(EstimatesCsv, AnyOrderOfColumnsAndRowsAndSixDigits) {
  const auto found = read(
      "tz,ty,tx,score,part,r11,r12,r13,r21,r22,r23,r31,r32,r33,ambiguous,sigma_t,sigma_r\n"
      "0.6,0.1,0.2,0.25,1,1,0,0,0,1,0,0,0,1,1,0.003,0.1\r\n"
      "0.5, 0, 0, 0.75, 0, 0.707107, -0.707107, 0, 0.707107, 0.707107, 0, 0, 0, 1, 0, 0.001, 0.01\n\n");
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].score, 0.75);
  EXPECT_TRUE(is_rigid(found[0].X_CP));
  EXPECT_NEAR(found[0].X_CP.linear()(0, 0), std::sqrt(0.5), 1e-6);
  EXPECT_TRUE(found[1].ambiguous);
  EXPECT_EQ(found[1].part, 1u);
  EXPECT_EQ(found[1].X_CP.translation(), Eigen::Vector3d(0.2, 0.1, 0.6));
  EXPECT_NEAR(found[1].covariance(0, 0), 9e-6, 1e-12);
  EXPECT_NEAR(found[1].covariance(3, 3), 0.01, 1e-12);
  EXPECT_GT(found[1].covariance(5, 5), 1);  // a ring's turn about its axis
}

TEST(EstimatesCsv, NoRowsIsAnAnswer) { EXPECT_TRUE(read(kHead).empty()); }

TEST(BadEstimatesCsv, SaysWhatIsWrong) {
  const std::string identity = "1,0,0,0,1,0,0,0,1";
  const std::pair<std::string, const char*> cases[] = {
      {"", "is empty"},
      {"part,score\n", "column r11 is missing"},
      {"part,scor\n", "'scor' is not a column"},
      {"part,part\n", "stands twice"},
      {"part,sc\x1b[2Jore\n", "'sc?[2Jore' is not a column"},
      {kHead + "0,0.5," + identity + ",0,0\n", ":2: has 13 values for 14 columns"},
      {kHead + "2,0.5," + identity + ",0,0,1\n", "part 2 is none of the 2 parts"},
      {kHead + "-1,0.5," + identity + ",0,0,1\n", "part -1"},
      {kHead + "0.5,0.5," + identity + ",0,0,1\n", "part 0.5"},
      {kHead + "0,1.5," + identity + ",0,0,1\n", "score 1.5"},
      {kHead + "0,nan," + identity + ",0,0,1\n", "score: 'nan' is not a finite number"},
      {kHead + "0,0.5," + identity + ",inf,0,1\n", "tx: 'inf'"},
      {kHead + "0,0.5," + identity + ",,0,1\n", "tx: ''"},
      {kHead + "0,0.5," + identity + ",1x,0,1\n", "tx: '1x'"},
      {kHead + "0,0.5,1,0,0,0,1,0,0,0,-1,0,0,1\n", "not a rotation"},
      {kHead + "0,0.5,2,0,0,0,1,0,0,0,1,0,0,1\n", "not a rotation"},
      {kHead + "0,0.5,0,0,0,0,0,0,0,0,0,0,0,1\n", "not a rotation"},
      {kHead + "0,0.5," + identity + ",0,0,1\n0,0.5," + identity + ",0,0,600\n", ":3: a translation beyond 100 m"},
      {kHead + "0,0.5," + identity + ",0,0,1\n\n0,0.5," + identity + ",0,0,6\n", ":3: has 1 values"},
  };
  for (const auto& [text, said] : cases) {
    try {
      read(text);
      ADD_FAILURE() << text;
    } catch (const AssetError& error) {
      EXPECT_THAT(error.what(), HasSubstr(said)) << text;
      EXPECT_THAT(error.what(), HasSubstr("estimates.csv"));
    }
  }
}

}  // namespace
}  // namespace binpick

// BOP's results file: what is written reads back, what is wrong is refused with file and line.
#include "evaluation/bop_results.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "tests/evaluation/bop_dataset.hpp"

namespace binpick {
namespace {

using testing::HasSubstr;

class BopCsv : public testing::Test {
 protected:
  std::string refusal(const std::string& text) {
    write_file(path_, text);
    try {
      read_bop_results(path_);
    } catch (const AssetError& error) {
      return error.what();
    }
    return "accepted";
  }
  examples::Folder folder_{"bop_csv"};
  std::string path_ = folder_.path("results.csv");
};

constexpr char kHead[] = "scene_id,im_id,obj_id,score,R,t,time\n";
constexpr char kRow[] = "1,2,3,0.5,1 0 0 0 1 0 0 0 1,10 20 -30.5,0.25\n";

TEST_F(BopCsv, OneRow) {
  write_file(path_, std::string(kHead) + kRow);
  const std::vector<BopEstimate> read = read_bop_results(path_);
  ASSERT_EQ(read.size(), 1u);
  EXPECT_EQ(read[0].scene, 1);
  EXPECT_EQ(read[0].image, 2);
  EXPECT_EQ(read[0].object, 3);
  EXPECT_EQ(read[0].score, 0.5);
  EXPECT_LT((read[0].X_CO.translation() - Eigen::Vector3d(0.01, 0.02, -0.0305)).norm(), 1e-15);
  EXPECT_EQ(read[0].time, 0.25);
}

TEST_F(BopCsv, WhatIsWrittenReadsBack) {
  std::vector<BopEstimate> written;
  Rng rng = Seed{3}.rng();
  for (int k = 0; k < 50; ++k)
    written.push_back({k / 7, k / 3, k, rng.normal(), examples::random_pose(rng), 0.001 * (k / 3)});
  write_file(path_, bop_results_csv(written));
  const std::vector<BopEstimate> read = read_bop_results(path_);
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t k = 0; k < read.size(); ++k) {
    EXPECT_EQ(read[k].object, written[k].object);
    EXPECT_EQ(read[k].score, written[k].score);
    EXPECT_LT((read[k].X_CO.matrix() - written[k].X_CO.matrix()).cwiseAbs().maxCoeff(), 1e-15);
  }
}

TEST_F(BopCsv, SmallFreedoms) {
  EXPECT_EQ(refusal(kRow), "accepted");  // no header
  EXPECT_EQ(refusal(std::string(kHead) + "1,2,3,.5,1  0 0 0 1 0 0 0 1, 1 2 3 ,-1\r\n\n"), "accepted");
  EXPECT_EQ(refusal(kHead), "accepted");                                                  // nothing was found
  EXPECT_EQ(refusal("1,2,3,1e-3,0.999999 0 0 0 1 0 0 0 1.000001,1 2 3,-1"), "accepted");  // a few digits only
}

TEST_F(BopCsv, WhatIsWrongIsNamedWithItsLine) {
  const auto second = [&](const std::string& row) { return refusal(std::string(kHead) + kRow + row); };
  EXPECT_THAT(second("1,2,3\n"), HasSubstr(path_ + ":3: has 3 fields, not 7"));
  EXPECT_THAT(second("1,2,-3,0.5,1 0 0 0 1 0 0 0 1,1 2 3,0.25\n"), HasSubstr(":3: obj_id: '-3' is not a whole number"));
  EXPECT_THAT(second("1,2,3,nan,1 0 0 0 1 0 0 0 1,1 2 3,0.25\n"), HasSubstr(":3: score: 'nan' is not a finite"));
  EXPECT_THAT(second("1,2,3,0.5,1 0 0 0 1 0 0 0,1 2 3,0.25\n"), HasSubstr(":3: R: holds 8 numbers, not 9"));
  EXPECT_THAT(second("1,2,3,0.5,1 0 0 0 1 0 0 0 -1,1 2 3,0.25\n"), HasSubstr(":3: R: is no rotation"));
  EXPECT_THAT(second("1,2,3,0.5,1 0 0 0 1 0 0 0 1,1 2 x,0.25\n"), HasSubstr(":3: t: 'x' is not a finite number"));
  EXPECT_THAT(second("1,2,3,0.5,1 0 0 0 1 0 0 0 1,1 2 3,0.26\n"), HasSubstr(":3: time: another one than in line 2"));
  EXPECT_THAT(second("\n" + std::string(kRow)), HasSubstr(":3: has 1 fields"));  // a hole in the file
  EXPECT_THAT(second("99999999999,2,3,0.5,1 0 0 0 1 0 0 0 1,1 2 3,0.25\n"), HasSubstr(":3: scene_id"));
}

}  // namespace
}  // namespace binpick

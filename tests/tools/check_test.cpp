// binpick check: what it says of a scene's arm, and the picture of its reach; why a pick was not planned; what planning
// costs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/file_io.hpp"
#include "tests/tools/run_program.hpp"

namespace binpick {
namespace {

using testing::HasSubstr;

class Check : public testing::Test {
 protected:
  std::string scene(const std::string& cell) const {
    const std::string root = BINPICK_SOURCE_DIR, file = folder_.path(cell + ".yaml");
    write_file(file, "part: " + root + "/assets/parts/bearing_6914/part.yaml\ncount: 1\ncell: " + root +
                         "/assets/cells/" + cell + ".yaml\nsensor: {type: ideal}\nestimator: {type: oracle}\n");
    return file;
  }
  TemporaryFolder folder_;
};

TEST_F(Check, SaysHowTheArmIsSolvedAndDrawsItsReach) {
  const ProgramRun ur = run_program("check " + scene("ur5e") + " --png " + folder_.path("reach.png"));
  ASSERT_EQ(ur.code, 0) << ur.err;
  EXPECT_THAT(ur.out, HasSubstr("numeric (axes of joints 3 and 4 are not perpendicular)"));
  EXPECT_THAT(ur.out, HasSubstr("over the bin 8 branches"));
  EXPECT_THAT(ur.out, HasSubstr("% within reach"));
  EXPECT_EQ(read_file(folder_.path("reach.png")).substr(1, 3), "PNG");
  const ProgramRun kuka = run_program("check " + scene("kr6_r900"));
  EXPECT_THAT(kuka.out, HasSubstr("inverse kinematics in closed form\n"));
}

TEST_F(Check, APictureIsOfOneScene) {
  const std::string part = std::string(BINPICK_SOURCE_DIR) + "/assets/parts/tee/part.yaml";
  EXPECT_EQ(run_program("check " + part + " --png " + folder_.path("a.png")).code, 2);
  const ProgramRun two = run_program("check " + part + " " + part + " --png " + folder_.path("a.png"));
  EXPECT_EQ(two.code, 2);
  EXPECT_THAT(two.err, HasSubstr("--png: takes one scene, not 2"));
}

TEST_F(Check, TheBenchOfPlanningCountsEveryLook) {
  const std::string json = folder_.path("plan.json");
  const ProgramRun run = run_program("bench planning " + scene("kr6_r900") + " --seeds 11:13 --picks 1 --json " + json);
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("2 looks, "));
  const auto rows = nlohmann::json::parse(read_file(json)).at("rows");
  ASSERT_EQ(rows.size(), 2u);
  for (const auto& row : rows) {
    EXPECT_GT(row.at("plan_cpu_ms").get<double>(), 0);
    EXPECT_EQ(row.at("estimates"), 1);
    EXPECT_EQ(row.at("planned").get<bool>(), row.at("reason").get<std::string>().empty());
  }
}

TEST_F(Check, ATrialWithoutAPlanSaysWhy) {
  const std::string file = folder_.path("shut.yaml"), root = BINPICK_SOURCE_DIR;
  write_file(file, "part: " + root + "/assets/parts/bearing_6914/part.yaml\ncount: 1\ncell: " + root +
                       "/assets/cells/mz07_one_cup.yaml\nsensor: {type: ideal}\nestimator: {type: oracle}\n"
                       "trial: {max_picks: 1}\n");
  const ProgramRun run = run_program("trial " + file + " --seed 11");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("pick 0: no reachable pick"));
}

}  // namespace
}  // namespace binpick

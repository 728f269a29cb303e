// `binpick budget` as a user runs it: tables in the folder, every row a run of its own, nothing run twice.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/file_io.hpp"
#include "tests/tools/run_program.hpp"

namespace binpick {
namespace {

using ::testing::HasSubstr;

TEST(BudgetRun, WritesItsTablesAndRunsNothingTwice) {
  const TemporaryFolder folder;
  const std::string root = BINPICK_SOURCE_DIR;
  write_file(folder.path("scene.yaml"),
             "part: " + root + "/assets/parts/bearing_6914/part.yaml\ncount: 2\ncell: " + root +
                 "/assets/cells/mz07_three_cups.yaml\nestimator: {type: oracle}\n" + "trial: {max_picks: 1}\n");
  const std::string budget = "budget " + folder.path("scene.yaml") + " --seeds 5000:5001 --no-stages --rotation " +
                             "20deg --translation 30mm --out " + folder.path("out");
  const ProgramRun run = run_program(budget);
  ASSERT_EQ(run.code, 0) << run.err;
  const auto json = nlohmann::json::parse(read_file(folder.path("out/budget.json")));
  ASSERT_EQ(json.at("translation").size(), 2u);
  EXPECT_EQ(json.at("translation")[0].at("picks").at("hits"), 1);
  EXPECT_EQ(json.at("translation")[1].at("picks").at("hits"), 0) << "30 mm off no cup seals";
  EXPECT_LT(json.at("bearable_translation").get<double>(), 0.03);
  EXPECT_TRUE(json.at("stages").empty());
  EXPECT_THAT(read_file(folder.path("out/budget.md")), HasSubstr("30.0 mm"));
  const std::string records = folder.path("out/errors/cells/none/records/records.jsonl"), before = read_file(records);
  const ProgramRun again = run_program(budget);
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(again.out, run.out);
  EXPECT_EQ(read_file(records), before);
  EXPECT_EQ(run_program(budget + " --translation=-1mm").code, 2);
}

}  // namespace
}  // namespace binpick

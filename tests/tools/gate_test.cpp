// `binpick gate` end to end on a small scene: a baseline is made, an equal version passes, a departure is named.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/file_io.hpp"
#include "tests/tools/few_parts.hpp"
#include "tests/tools/run_program.hpp"

namespace binpick {
namespace {

using testing::HasSubstr;

TEST(GateProgram, BaselineEqualAndChanged) {
  const TemporaryFolder folder;
  const std::string scene = folder.path("scene.yaml"), baseline = folder.path("base.jsonl");
  write_file(scene, scene_text(2) + "trial: {max_picks: 1}\n");
  const ProgramRun made = run_program("gate " + scene + " --baseline " + baseline + " --renew --seeds 40:43");
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.out, HasSubstr("3 piles of few_parts"));

  const ProgramRun same = run_program("gate " + scene + " --baseline " + baseline + " --block 2 --out " +
                                      folder.path("run") + " --json " + folder.path("g.json"));
  EXPECT_EQ(same.code, 0) << same.err;
  EXPECT_THAT(same.out, HasSubstr("No bit changed in 3 seeds"));
  const auto json = nlohmann::json::parse(read_file(folder.path("g.json")));
  EXPECT_EQ(json.at("verdict"), "no_bit_changed");
  EXPECT_EQ(json.at("gate").at("looks"), 2);

  // A baseline of another version: one frame of seed 41 was different.
  std::string text = read_file(baseline);
  const std::size_t frame = text.find("\"frame\":\"", text.find("\"seed\":41")) + 9;
  text[frame] = text[frame] == '0' ? '1' : '0';
  write_file(folder.path("other.jsonl"), text);
  const ProgramRun other = run_program("compare " + folder.path("other.jsonl") + " " + folder.path("run"));
  EXPECT_EQ(other.code, 3) << other.err;  // three seeds tell nothing
  EXPECT_THAT(other.out, HasSubstr("first in seed 41 (turn 0: frame)"));

  // The run folder holds records, of which build nobody knows.
  const ProgramRun again = run_program("gate " + scene + " --baseline " + baseline + " --out " + folder.path("run"));
  EXPECT_EQ(again.code, 2);
  EXPECT_THAT(again.err, HasSubstr("run: holds records already"));
}

TEST(GateProgram, BadInputIsOneLine) {
  const TemporaryFolder folder;
  const std::string scene = folder.path("scene.yaml");
  write_file(scene, scene_text(2));
  const std::string pile =
      R"("crashed":false,"heap":"0000000000000000","turns":[],"content":"0000000000000000","picks":[1,1],"cleared":[1,1],"recall":[1,1],)"
      R"("recall_first_look":[1,1],"precision":[1,1],"first_pick":"","missed":0,"translations":[],"rotations":[],"cycles":[]})";
  write_file(folder.path("gap.jsonl"),
             R"({"binpick_baseline":1,"scenario":"a","scenario_hash":"b","record_schema":4,"piles":2})"
             "\n{\"seed\":3," +
                 pile + "\n{\"seed\":5," + pile + "\n");
  const std::pair<std::string, std::string> cases[] = {
      {" --baseline " + folder.path("none.jsonl"), "none.jsonl: there is neither a run folder nor a baseline file"},
      {" --baseline " + folder.path("gap.jsonl"), "gap.jsonl: seed 4 is missing"},
      {" --baseline " + scene, "scene.yaml:1: is not a JSON record"},
      {" --baseline x --renew", "--renew and --seeds A:B go together"},
      {" --baseline x --seeds 1:2", "--renew and --seeds A:B go together"},
  };
  for (const auto& [arguments, message] : cases) {
    const ProgramRun run = run_program("gate " + scene + arguments);
    EXPECT_EQ(run.code, 2) << arguments;
    EXPECT_THAT(run.err, HasSubstr(message));
  }
}

}  // namespace
}  // namespace binpick

// `binpick compare` as a user meets it: exit codes, files for CI, and one clear line for what is not a run.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/file_io.hpp"
#include "evaluation/trial_record.hpp"
#include "tests/tools/run_program.hpp"

namespace binpick {
namespace {

using testing::HasSubstr;

// One pick a pile: those of the first `failed` seeds fail.
std::string records_text(std::uint64_t seeds, std::uint64_t failed) {
  std::string text;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    TrialRecord record;
    record.scenario = "made_up";
    record.scenario_hash = "00000000000000aa";
    record.seed = Seed{seed};
    record.dropped = 1;
    PickRecord& pick = record.picks.emplace_back();
    pick.outcome = seed < failed ? PickOutcome::kSlipped : PickOutcome::kSucceeded;
    record.placed = seed < failed ? 0 : 1;
    pick.world_hash = record.placed;
    text += to_json_line(record) + "\n";
  }
  return text;
}

std::string run_folder(const TemporaryFolder& folder, const std::string& name, const std::string& records) {
  make_folder(folder.path(name) + "/records");
  write_file(folder.path(name) + "/records/records.jsonl", records);
  return folder.path(name);
}

TEST(CompareProgram, VerdictsAndFiles) {
  const TemporaryFolder folder;
  const std::string good = run_folder(folder, "good", records_text(40, 0)),
                    bad = run_folder(folder, "bad", records_text(40, 20));
  const ProgramRun same = run_program("compare --bits " + good + " " + good);
  EXPECT_EQ(same.code, 0) << same.err;
  EXPECT_THAT(same.out, HasSubstr("No bit changed in 40 seeds"));
  const ProgramRun worse = run_program("compare " + good + " " + bad + " --json " + folder.path("c.json") +
                                       " --junit " + folder.path("c.xml") + " --markdown " + folder.path("c.md"));
  EXPECT_EQ(worse.code, 1) << worse.err;
  EXPECT_THAT(worse.out, HasSubstr("first in seed 0 (turn 0: pick)"));
  EXPECT_THAT(worse.out, HasSubstr("binpick trial " + bad + "/scenario.yaml --seed 0"));
  EXPECT_EQ(nlohmann::json::parse(read_file(folder.path("c.json"))).at("exit_code"), 1);
  EXPECT_THAT(read_file(folder.path("c.xml")), HasSubstr("<failure"));
  EXPECT_THAT(read_file(folder.path("c.md")), HasSubstr("WORSE"));
  EXPECT_EQ(run_program("compare --bits " + good + " " + bad).code, 7);
  EXPECT_EQ(run_program("compare " + good + " " + run_folder(folder, "few", records_text(10, 1))).code, 3);
}

TEST(CompareProgram, WhatIsNoRunIsToldInOneLine) {
  const TemporaryFolder folder;
  const std::string good = run_folder(folder, "good", records_text(5, 0));
  const std::string text = records_text(5, 0);
  std::string altered = text;
  altered.replace(altered.find("\"placed\":1"), 10, "\"placed\":0");
  make_folder(folder.path("bare"));
  write_file(folder.path("margins.yaml"), "pick: {margin: 0.1}\n");
  write_file(folder.path("image.png"), "\x89PNG\r\n\x1a\n");
  const std::pair<std::string, std::string> cases[] = {
      {good + " " + folder.path("nowhere"), "nowhere: there is neither a run folder nor a baseline file"},
      {good + " " + folder.path("bare"), "bare: is not a run folder"},
      {good + " " + run_folder(folder, "empty", ""), "empty: holds no records"},
      {good + " " + run_folder(folder, "torn", text.substr(0, text.size() - 9)),
       "records.jsonl:5: the last line is incomplete"},
      {good + " " + run_folder(folder, "altered", altered), "records.jsonl:1: hash: does not fit the values"},
      {good + " " + run_folder(folder, "noise", "noise\n"), "records.jsonl:1: is not a JSON record"},
      {folder.path("image.png") + " " + good, "image.png:1: is not a JSON record"},
      {good + " " + good + " --margins " + folder.path("margins.yaml"),
       "margins.yaml:1: pick: unknown key, did you mean picks?"},
  };
  for (const auto& [arguments, message] : cases) {
    const ProgramRun run = run_program("compare " + arguments);
    EXPECT_EQ(run.code, 2) << arguments;
    EXPECT_THAT(run.err, HasSubstr(message));
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_EQ(run.out, "");
  }
  const ProgramRun nowhere =
      run_program("compare " + good + " " + good + " --json " + folder.path("no_such_folder/c.json"));
  EXPECT_EQ(nowhere.code, 6) << nowhere.err;
}

}  // namespace
}  // namespace binpick

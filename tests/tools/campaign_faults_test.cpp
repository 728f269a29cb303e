// What a campaign makes of workers that die, hang, fill their memory or answer nonsense, of its own death, and of a
// disk that is full.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/file_io.hpp"
#include "tests/tools/run_program.hpp"

namespace binpick {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

const std::string kRoot = BINPICK_SOURCE_DIR;

std::string tiny_scene(const TemporaryFolder& folder) {
  write_file(folder.path("scene.yaml"),
             "name: tiny\npart: " + kRoot + "/assets/parts/bearing_6914/part.yaml\ncount: 2\ncell: " + kRoot +
                 "/assets/cells/mz07_three_cups.yaml\nestimator: {type: oracle}\ntrial: {max_picks: 1}\n");
  return folder.path("scene.yaml");
}

std::map<std::uint64_t, json> by_seed(const std::string& file) {
  std::map<std::uint64_t, json> records;
  std::istringstream lines(read_file(file));
  for (std::string line; std::getline(lines, line);) {
    const json record = json::parse(line);
    EXPECT_TRUE(records.emplace(record.at("seed"), record).second) << "recorded twice: " << record.at("seed");
  }
  return records;
}

TEST(CampaignFaults, EachHasItsOwnClassAndTheOthersAreUntouched) {
  const TemporaryFolder folder;
  const std::string campaign = "campaign " + tiny_scene(folder) + " --seeds 1:13 --workers 2 --pictured -1 --out ";
  ASSERT_EQ(run_program(campaign + folder.path("sound")).code, 0);
  const ProgramRun run = run_program(campaign + folder.path("run") +
                                     " --timeout 20 --memory 1000 --plant "
                                     "segfault:2,abort:3,hang:4,leak:5,exit:6,garbage:7,once-segfault:8,once-exit:9");
  EXPECT_EQ(run.code, 5) << run.err;
  const auto sound = by_seed(folder.path("sound/canonical.jsonl"));
  const auto faulty = by_seed(folder.path("run/canonical.jsonl")),
             full = by_seed(folder.path("run/records/records.jsonl"));
  ASSERT_EQ(faulty.size(), 12u);
  const std::map<std::uint64_t, std::pair<std::string, std::string>> expected = {
      {2, {"Crash", "signal 11"}},    {3, {"Crash", "signal 6"}},    {4, {"Timeout", "20 s"}},
      {5, {"OutOfMemory", "memory"}}, {6, {"Crash", "exit code 0"}}, {7, {"Crash", "no record"}}};
  for (const auto& [seed, record] : faulty) {
    const auto planted = expected.find(seed);
    if (planted == expected.end()) {
      EXPECT_EQ(record, sound.at(seed)) << seed;
      continue;
    }
    EXPECT_EQ(record.at("failure"), planted->second.first) << seed;
    EXPECT_THAT(std::string(record.at("error")), HasSubstr(planted->second.second));
    EXPECT_TRUE(record.at("picks").empty()) << "no failed pick";
    EXPECT_EQ(full.at(seed).at("attempts"), 2);
  }
  EXPECT_EQ(full.at(8).at("attempts"), 2);
  EXPECT_THAT(std::string(full.at(8).at("first_failure")), HasSubstr("signal 11"));
  const json summary = json::parse(read_file(folder.path("run/summary.json")));
  EXPECT_EQ(summary.at("failed"), 6);
  EXPECT_EQ(summary.at("failure_seeds").at("Crash"), json({2, 3, 6, 7}));
  EXPECT_EQ(summary.at("repeated_seeds"), json({2, 3, 4, 5, 6, 7, 8, 9}));
  EXPECT_EQ(summary.at("picks").at("attempted"), 6) << "of the trials that are measurements";
  EXPECT_THAT(run.out, HasSubstr("OutOfMemory"));
  EXPECT_THAT(read_file(folder.path("run/report.html")), HasSubstr("binpick trial scenario.yaml --seed 4"));
}

TEST(CampaignFaults, KilledAgainAndAgainNothingIsLostDoubledOrChanged) {
  const TemporaryFolder folder;
  const ProgramRun run =
      run_program("--version && bash " + kRoot + "/tests/tools/kill_campaign.sh " BINPICK_PROGRAM " " +
                  tiny_scene(folder) + " 1:25 10 " + folder.path() + " 3");
  EXPECT_EQ(run.code, 0) << run.out << run.err;
  EXPECT_THAT(run.out, HasSubstr("byte-equal"));
}

TEST(CampaignFaults, AFullDiskEndsItAndTheRestIsDoneLater) {
  const TemporaryFolder folder;
  const std::string campaign = "campaign " + tiny_scene(folder) + " --seeds 1:9 --pictured -1 --out ";
  ASSERT_EQ(run_program(campaign + folder.path("whole")).code, 0);
  const std::size_t bytes = read_file(folder.path("whole/records/records.jsonl")).size();
  // A file-size limit stands in for the disk; blocks of 1024 bytes.
  const ProgramRun full = run_program(campaign + folder.path("run"), "ulimit -f " + std::to_string(bytes / 2 / 1024));
  EXPECT_EQ(full.code, 6) << full.err;
  EXPECT_THAT(full.err, HasSubstr("records.jsonl"));
  const ProgramRun rest = run_program(campaign + folder.path("run"));
  EXPECT_EQ(rest.code, 0) << rest.err;
  EXPECT_THAT(rest.err, HasSubstr("torn"));
  EXPECT_EQ(read_file(folder.path("run/canonical.jsonl")), read_file(folder.path("whole/canonical.jsonl")));
}

// Errors that a failing or read-only disk gives, put between the program and the kernel by bad_disk.c. (A write that
// fails: the full disk above.)
TEST(CampaignFaults, ADiskThatFailsEndsItAndTheRestIsDoneLater) {
  const TemporaryFolder folder;
  const std::string campaign = "campaign " + tiny_scene(folder) + " --seeds 1:5 --pictured -1 --out ";
  ASSERT_EQ(run_program(campaign + folder.path("whole")).code, 0);
  const std::map<std::string, std::string> plans = {{"fsync:5:3:records.jsonl", "Input/output error"},
                                                    {"open:30:3:records.jsonl", "Read-only file system"}};
  for (const auto& [plan, words] : plans) {
    const std::string run = folder.path("run_" + plan.substr(0, 4));
    const ProgramRun bad = run_program(campaign + run, "export LD_PRELOAD=" BINPICK_BAD_DISK " BAD_DISK=" + plan);
    EXPECT_EQ(bad.code, 6) << plan << "\n" << bad.err;
    EXPECT_THAT(bad.err, HasSubstr("records.jsonl")) << plan;
    EXPECT_THAT(bad.err, HasSubstr(words)) << plan;
    EXPECT_LT(by_seed(run + "/records/records.jsonl").size(), 4u) << plan;
    const ProgramRun rest = run_program(campaign + run);
    EXPECT_EQ(rest.code, 0) << plan << "\n" << rest.err;
    EXPECT_EQ(read_file(run + "/canonical.jsonl"), read_file(folder.path("whole/canonical.jsonl"))) << plan;
  }
}

// Workers that lose 240 MB with every trial are replaced before they reach 1000 MB: no trial pays for it.
TEST(CampaignFaults, WhatLeaksSlowlyIsReplacedBetweenTrials) {
  const TemporaryFolder folder;
  const std::string campaign = "campaign " + tiny_scene(folder) + " --seeds 1:6 --pictured -1 --memory 1000 --out ";
  ASSERT_EQ(run_program(campaign + folder.path("sound")).code, 0);
  const ProgramRun run = run_program(campaign + folder.path("run") + " --plant drip:1,drip:2,drip:3,drip:4,drip:5");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(read_file(folder.path("run/canonical.jsonl")), read_file(folder.path("sound/canonical.jsonl")));
  for (const auto& [seed, record] : by_seed(folder.path("run/records/records.jsonl")))
    EXPECT_EQ(record.value("attempts", 1), 1) << seed;
}

TEST(CampaignFaults, ASceneWhoseWorkersNeverComeUpIsGivenUp) {
  const TemporaryFolder folder;
  const ProgramRun run =
      run_program("campaign " + tiny_scene(folder) + " --seeds 1:3 --memory 100 --out " + folder.path("run") +
                  "; code=$?; [ -e " + folder.path("run") + " ] && exit 99; exit $code");
  EXPECT_EQ(run.code, 5) << run.err;
  EXPECT_THAT(run.err, HasSubstr("no worker comes up: more than 100 MB of memory"));
}

}  // namespace
}  // namespace binpick

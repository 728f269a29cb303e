// Sweeps through the program: run, stopped and completed, spread over shards and merged.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/file_io.hpp"
#include "core/image_io.hpp"
#include "tests/tools/run_program.hpp"
#include "tools/sweep_picture.hpp"
#include "trials/run_merge.hpp"

namespace binpick {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

const std::string kRoot = BINPICK_SOURCE_DIR;

/// Two tools, two heights, two seeds: eight trials of two bearings and one pick, with poses from the truth.
std::string small_sweep(const TemporaryFolder& folder, const std::string& seeds = "1:3") {
  write_file(folder.path("scene.yaml"), "name: small\npart: " + kRoot +
                                            "/assets/parts/bearing_6914/part.yaml\ncount: 2\ncell: " + kRoot +
                                            "/assets/cells/mz07_three_cups.yaml\nsensor: {type: ideal}\n" +
                                            "estimator: {type: oracle}\ntrial: {max_picks: 1}\n");
  write_file(folder.path("sweep.yaml"),
             "name: small\nbase: scene.yaml\nseeds: " + seeds +
                 "\nfactors:\n  height: {field: 'cell.look.camera.xyz[2]', levels: {500 mm: 505 mm, 600 mm: 605 mm}}\n"
                 "  cell.gripper.preset: [three_cups, four_cups]\n");
  return folder.path("sweep.yaml");
}

std::string canonical_of(const std::string& sweep) {
  std::string all;
  for (const json& cell : json::parse(read_file(sweep + "/sweep.json")).at("cells"))
    all += read_file(sweep + "/" + cell.at("folder").get<std::string>() + "/canonical.jsonl");
  return all;
}

TEST(Sweep, IsCompletedWhereItWasStoppedAndMergedFromShards) {
  const TemporaryFolder folder;
  const std::string sweep = small_sweep(folder), whole = folder.path("whole");
  const ProgramRun list = run_program("sweep " + sweep + " --list");
  EXPECT_EQ(list.code, 0) << list.err;
  EXPECT_THAT(list.out, HasSubstr("4 cells x 2 seeds = 8 trials"));

  const ProgramRun run = run_program("sweep " + sweep + " --out " + whole + " --json " + folder.path("figures.json"));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("Best cell: "));
  const json figures = json::parse(read_file(folder.path("figures.json")));
  EXPECT_EQ(figures.at("schema"), 1);
  EXPECT_EQ(figures.at("seeds"), json({1, 3}));
  for (const json& cell : figures.at("cells")) EXPECT_EQ(cell.at("trials"), 2);
  const std::string picture = figures.at("heat_maps").at(0).at("picture");
  for (const std::string& file : {std::string("report.html"), std::string("sweep.md"), std::string("cells.csv"),
                                  std::string("factors.csv"), picture})
    EXPECT_TRUE(fs::exists(whole + "/" + file)) << file;
  // A cell is an ordinary run.
  const std::string cell = whole + "/" + figures.at("cells").at(3).at("folder").get<std::string>();
  EXPECT_EQ(run_program("verify " + cell + " --sample 1").code, 0);

  // What is gone is run again, and nothing else.
  const std::string before = canonical_of(whole),
                    kept = read_file(whole + "/cells/500_mm-three_cups/records/records.jsonl");
  fs::remove_all(cell);
  ASSERT_EQ(run_program("sweep " + sweep + " --out " + whole).code, 0);
  EXPECT_EQ(canonical_of(whole), before);
  EXPECT_EQ(read_file(whole + "/cells/500_mm-three_cups/records/records.jsonl"), kept);

  std::string shards;
  for (const char* shard : {"1", "2", "3"}) {
    const std::string out = folder.path(std::string("part") + shard);
    ASSERT_EQ(run_program("sweep " + sweep + " --shard " + shard + "/3 --out " + out).code, 0);
    shards = " " + out + shards;
  }
  const ProgramRun merged = run_program("merge" + shards + " --out " + folder.path("merged"));
  EXPECT_EQ(merged.code, 0) << merged.err;
  EXPECT_EQ(canonical_of(folder.path("merged")), before);
  EXPECT_EQ(merged.out, run.out);
  const ProgramRun partial = run_program("merge " + folder.path("part1") + " --out " + folder.path("partial"));
  EXPECT_EQ(partial.code, 3);
  EXPECT_THAT(partial.err, HasSubstr("trials are missing, the first is cells/"));
}

TEST(Sweep, WhatCannotBeMeantIsSaidBeforeAnythingRuns) {
  const TemporaryFolder folder;
  const std::string sweep = small_sweep(folder);
  write_file(sweep, read_file(sweep) + "  dorp.height: [1]\n");
  const ProgramRun run = run_program("sweep " + sweep + " --out " + folder.path("out"));
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.err, HasSubstr("sweep.yaml:7: dorp: unknown key, did you mean drop?"));
  EXPECT_FALSE(fs::exists(folder.path("out")));
}

TEST(Shards, OneWithoutSeedsHasNothingToDo) {
  const TemporaryFolder folder;
  small_sweep(folder);
  const std::string shard = in_shard(1, 1, 2) ? "2/2" : "1/2";
  const ProgramRun run = run_program("campaign " + folder.path("scene.yaml") + " --seeds 1:2 --shard " + shard +
                                     " --out " + folder.path("out"));
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("has none of these seeds"));
  EXPECT_FALSE(fs::exists(folder.path("out")));
}

TEST(HeatMap, TheFiguresStandOnTheirColoursAndNothingOnGrey) {
  SweepPlan plan;
  plan.name = "a";
  plan.end_seed = 1;
  plan.factors = {{"rows", {}, {"r0"}, false}, {"columns", {}, {"c0", "c1"}, false}};
  SweepResult result;
  result.plan = plan;
  const double nothing = std::nan("");
  result.heat_maps = {{0, 1, std::nullopt, {{0.5, nothing}}, {{3, 0}}}};
  const Image<Rgb> picture = heat_map_picture(result, 0);
  std::map<Rgb, int> colours;
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) ++colours[picture(x, y)];
  EXPECT_GT(colours[(Rgb{235, 236, 238})], 5000);  // the field without a trial
  result.heat_maps = {{0, 1, std::nullopt, {{0.5, 1.0}}, {{3, 3}}}};
  const Image<Rgb> both = heat_map_picture(result, 0);
  std::map<Rgb, int> again;
  for (int y = 0; y < both.height(); ++y)
    for (int x = 0; x < both.width(); ++x) ++again[both(x, y)];
  EXPECT_LT(again[(Rgb{235, 236, 238})], 100);  // no field; the edge of a letter may come by it
  // The ends of cividis (Nunez et al. 2018): dark blue and yellow.
  const auto near = [&](const Rgb& want) {
    int count = 0;
    for (const auto& [colour, pixels] : again) {
      int distance = 0;
      for (std::size_t k = 0; k < 3; ++k) distance = std::max(distance, std::abs(int{colour[k]} - int{want[k]}));
      if (distance <= 6) count += pixels;
    }
    return count;
  };
  EXPECT_GT(near({0, 34, 78}), 5000);
  EXPECT_GT(near({254, 232, 56}), 5000);
}

}  // namespace
}  // namespace binpick

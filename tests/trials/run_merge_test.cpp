// Parts of a campaign put together: the same bytes for any partition and any order.

#include "trials/run_merge.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "core/error.hpp"
#include "tests/core/temp_folder.hpp"
#include "tests/evaluation/example_records.hpp"

namespace binpick {
namespace {

using examples::pick;
using examples::trial;
using Runs = std::vector<std::vector<TrialRecord>>;

TrialRecord record_of(std::uint64_t seed) {
  TrialRecord record = trial(seed, {pick(seed % 3 ? PickOutcome::kSucceeded : PickOutcome::kNoSeal, 4, 3)});
  record.build = "b1";
  record.wall_total = 0.5 * static_cast<double>(seed);
  return record;
}

/// The lines that are kept of these runs' files, merged in this order.
class MergedRuns {
 public:
  explicit MergedRuns(const Runs& runs) {
    for (std::size_t k = 0; k < runs.size(); ++k) {
      const std::string run = "run" + std::to_string(k);
      std::filesystem::create_directories(folder_.at(run + "/records"));
      std::string text;
      for (const TrialRecord& record : runs[k]) text += to_json_line(record) + "\n";
      folder_.put(run + "/records/records.jsonl", text);
      for_each_record(folder_.at(run), [&](TrialRecord&& record, const RecordLine& line) { index_.add(record, line); });
    }
  }
  std::string text() const {
    std::string text;
    for (const auto& [seed, kept] : index_.seeds()) text += read_bytes(kept.file, kept.offset, kept.bytes) + "\n";
    return text;
  }
  const std::set<std::uint64_t>& conflicts() const { return index_.conflicts(); }

 private:
  TempFolder folder_;
  MergeIndex index_;
};

TEST(Shards, EverySeedBelongsToExactlyOne) {
  for (int count = 1; count <= 64; ++count) {
    std::vector<int> sizes(static_cast<std::size_t>(count), 0);
    for (std::uint64_t seed = 5000; seed < 5000 + 640; ++seed) {
      int owners = 0;
      for (int index = 1; index <= count; ++index)
        if (in_shard(seed, index, count)) ++owners, ++sizes[static_cast<std::size_t>(index - 1)];
      EXPECT_EQ(owners, 1) << seed << " of " << count;
    }
    EXPECT_GT(*std::min_element(sizes.begin(), sizes.end()), 0) << count;
  }
}

TEST(Merge, AnyPartitionInAnyOrderGivesTheSameBytes) {
  std::vector<TrialRecord> all;
  for (std::uint64_t seed = 100; seed < 228; ++seed) all.push_back(record_of(seed));
  const std::string whole = MergedRuns(Runs{all}).text();
  Rng rng = Seed{3}.rng();
  for (int count = 1; count <= 64; ++count) {
    Runs runs(static_cast<std::size_t>(count));
    for (const TrialRecord& record : all)
      for (int index = 1; index <= count; ++index)
        if (in_shard(record.seed.key, index, count)) runs[static_cast<std::size_t>(index - 1)].push_back(record);
    for (std::size_t k = runs.size(); k > 1; --k) std::swap(runs[k - 1], runs[rng.below(k)]);
    EXPECT_EQ(MergedRuns(runs).text(), whole) << count;
  }
}

TEST(Merge, WhatTwoRunsBothHoldIsOneUnlessItDiffers) {
  TrialRecord slower = record_of(7), other = record_of(7);
  slower.wall_total = 99;
  EXPECT_EQ(MergedRuns({{record_of(7)}, {slower}}).text(), MergedRuns({{slower}, {record_of(7)}}).text());
  other.picks[0].world_hash ^= 1;
  EXPECT_EQ(MergedRuns({{record_of(6), record_of(7)}, {other}}).conflicts(), std::set<std::uint64_t>{7});
}

TEST(Merge, AResultBeatsAFailedTrial) {
  TrialRecord failed = trial(7, {});
  failed.build = "b1";
  failed.failure = TrialFailure::kTimeout;
  for (const Runs& runs : {Runs{{failed}, {record_of(7)}}, Runs{{record_of(7)}, {failed}}}) {
    const MergedRuns merged(runs);
    EXPECT_TRUE(merged.conflicts().empty());
    EXPECT_EQ(merged.text(), to_json_line(record_of(7)) + "\n");
  }
}

TEST(Merge, AnotherScenarioOrBuildIsRefused) {
  TrialRecord scenario = record_of(8), build = record_of(8);
  scenario.scenario_hash = "other";
  build.build = "b2";
  EXPECT_THROW(MergedRuns({{record_of(7)}, {scenario}}), SpecError);
  EXPECT_THROW(MergedRuns({{record_of(7)}, {build}}), SpecError);
}

}  // namespace
}  // namespace binpick

// Parts of a campaign put together: the same bytes for any partition and any order.

#include "trials/run_merge.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/error.hpp"
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

std::string text_of(const std::vector<TrialRecord>& records) {
  std::string text;
  for (const TrialRecord& record : records) text += to_json_line(record) + "\n";
  return text;
}

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
  const std::string whole = text_of(merge_records(Runs{all}).records);
  Rng rng = Seed{3}.rng();
  for (int count = 1; count <= 64; ++count) {
    Runs runs(static_cast<std::size_t>(count));
    for (const TrialRecord& record : all)
      for (int index = 1; index <= count; ++index)
        if (in_shard(record.seed.key, index, count)) runs[static_cast<std::size_t>(index - 1)].push_back(record);
    for (std::size_t k = runs.size(); k > 1; --k) std::swap(runs[k - 1], runs[rng.below(k)]);
    EXPECT_EQ(text_of(merge_records(runs).records), whole) << count;
  }
}

TEST(Merge, WhatTwoRunsBothHoldIsOneUnlessItDiffers) {
  TrialRecord slower = record_of(7), other = record_of(7);
  slower.wall_total = 99;
  EXPECT_EQ(text_of(merge_records(Runs{{record_of(7)}, {slower}}).records),
            text_of(merge_records(Runs{{slower}, {record_of(7)}}).records));
  other.picks[0].world_hash ^= 1;
  const MergedRecords merged = merge_records(Runs{{record_of(6), record_of(7)}, {other}});
  EXPECT_EQ(merged.conflicts, std::vector<std::uint64_t>{7});
}

TEST(Merge, AResultBeatsAFailedTrial) {
  TrialRecord failed = trial(7, {});
  failed.build = "b1";
  failed.failure = TrialFailure::kTimeout;
  for (const Runs& runs : {Runs{{failed}, {record_of(7)}}, Runs{{record_of(7)}, {failed}}}) {
    const MergedRecords merged = merge_records(runs);
    EXPECT_TRUE(merged.conflicts.empty());
    EXPECT_FALSE(merged.records.at(0).failure);
  }
}

TEST(Merge, AnotherScenarioOrBuildIsRefused) {
  TrialRecord scenario = record_of(8), build = record_of(8);
  scenario.scenario_hash = "other";
  build.build = "b2";
  EXPECT_THROW(merge_records(Runs{{record_of(7)}, {scenario}}), SpecError);
  EXPECT_THROW(merge_records(Runs{{record_of(7)}, {build}}), SpecError);
}

}  // namespace
}  // namespace binpick

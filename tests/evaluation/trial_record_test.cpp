// Records as JSON lines: exact round trips, a hash that knows no wall time, and strict reading.
#include "evaluation/trial_record.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/hash.hpp"
#include "tests/evaluation/example_records.hpp"

namespace binpick {
namespace {

using examples::pick;
using examples::trial;

TrialRecord full_record(std::uint64_t seed = 5000) {
  return trial(seed, {pick(PickOutcome::kSucceeded, 4, 3), pick(PickOutcome::kNoSeal, 3, 2)});
}

std::string refusal(const std::string& line) {
  try {
    trial_record_from_json(line, "run/records/a.jsonl:7");
  } catch (const SpecError& error) {
    return error.what();
  }
  return "accepted";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(TrialRecord, RoundTripIsByteEqual) {
  for (std::uint64_t i = 0; i < 50; ++i) {
    Rng rng = Seed{20261124}.child("round trip").rng().at(i);
    TrialRecord record = full_record(rng.next_u64());
    record.settle_time = rng.normal() * std::pow(10, rng.uniform(-300, 300));
    record.picks[0].place_error = rng.uniform();
    record.picks[0].check.estimates[0].error.abs_xyz = rng.unit_vector();
    record.picks[1].wall.voting = rng.uniform();
    if (i % 2 == 1) record.calibration_translation = rng.unit_vector(), record.calibration_rotation = rng.unit_vector();
    const std::string line = to_json_line(record);
    const TrialRecord back = trial_record_from_json(line, "line");
    EXPECT_EQ(to_json_line(back), line) << "item " << i;
    EXPECT_EQ(back.settle_time, record.settle_time) << "item " << i;
    EXPECT_EQ(back.picks[0].place_error, record.picks[0].place_error) << "item " << i;
    EXPECT_EQ(back.seed, record.seed) << "item " << i;
    EXPECT_EQ(back.calibration_translation, record.calibration_translation) << "item " << i;
    EXPECT_EQ(back.calibration_rotation, record.calibration_rotation) << "item " << i;
    EXPECT_EQ(line.find("calibration") != std::string::npos, i % 2 == 1) << "perfect: no key, as in older records";
    EXPECT_EQ(back.picks[1].wall.voting, record.picks[1].wall.voting) << "item " << i;
    EXPECT_EQ(line.find('\n'), std::string::npos);
  }
}

TEST(TrialRecord, EveryFieldComesBack) {
  const TrialRecord record = full_record();
  const TrialRecord back = trial_record_from_json(to_json_line(record), "line");
  EXPECT_EQ(back.scenario, "bearing_bin");
  EXPECT_EQ(back.dropped, 10);
  EXPECT_EQ(back.penetration_p99, 0.0002);
  EXPECT_EQ(back.penetration_max, 0.0003);
  EXPECT_EQ(back.woken_energy, 1e-9);
  EXPECT_EQ(back.woken_motion, 0.0004);
  EXPECT_EQ(back.woken_share, 0.1);
  EXPECT_EQ(back.placed, 1);
  ASSERT_EQ(back.picks.size(), 2u);
  EXPECT_EQ(back.picks[0].outcome, PickOutcome::kSucceeded);
  EXPECT_EQ(back.picks[1].outcome, PickOutcome::kNoSeal);
  EXPECT_EQ(back.picks[1].reason, "as the test says");
  EXPECT_EQ(back.picks[1].rejections.at("rim blocked"), 3);
  EXPECT_EQ(back.picks[1].collisions.at("lip on the bin"), 2);
  EXPECT_EQ(back.picks[1].second_look, "no plan");
  EXPECT_EQ(back.picks[1].look_time, 1.5);
  EXPECT_FALSE(back.picks[1].place_error.has_value());
  EXPECT_EQ(back.picks[0].frame_hash, 0xfedcba9876543210ull);
  EXPECT_EQ(back.picks[0].check.estimates.size(), 3u);
  EXPECT_EQ(back.picks[0].check.estimates[2].instance, 2u);
  EXPECT_EQ(back.picks[0].check.found, 3u);
  EXPECT_EQ(back.picks[0].check.visible, 4u);
}

TEST(TrialRecord, WhatIsNoNumberBecomesNull) {
  TrialRecord record = full_record();
  record.picks[0].check.estimates[0].error.mssd = std::numeric_limits<double>::infinity();
  record.picks[0].check.estimates[0].error.abs_rpy.y() = std::nan("");
  const std::string line = to_json_line(record);
  EXPECT_NE(line.find("\"mssd\":null"), std::string::npos);
  const TrialRecord back = trial_record_from_json(line, "line");
  EXPECT_TRUE(std::isnan(back.picks[0].check.estimates[0].error.mssd));
  EXPECT_TRUE(std::isnan(back.picks[0].check.estimates[0].error.abs_rpy.y()));
  EXPECT_EQ(to_json_line(back), line);
}

TEST(TrialRecord, HashKnowsNoWallTime) {
  const TrialRecord record = full_record();
  TrialRecord slow = record;
  slow.wall_total = 99;
  slow.picks[0].wall = {1, 2, 3, 4, 5};
  slow.picks[1].plan_wall = 7;
  EXPECT_EQ(record_hash(slow), record_hash(record));
  EXPECT_NE(to_json_line(slow), to_json_line(record));
  const auto before_wall = [](const std::string& line) { return line.substr(0, line.find(",\"wall\":")); };
  EXPECT_EQ(before_wall(to_json_line(slow)), before_wall(to_json_line(record)));
  EXPECT_NE(to_json_line(record).find("\"hash\":\"" + hex(record_hash(record)) + "\""), std::string::npos);
}

// As docs/record_format.md says, so that another program can check it.
TEST(TrialRecord, HashIsThatOfTheBytesBeforeIt) {
  const std::string line = to_json_line(full_record());
  const std::string before = line.substr(0, line.find(",\"hash\":")) + "}";
  EXPECT_EQ(Hasher().bytes(before.data(), before.size()).value(), record_hash(full_record()));
}

TEST(TrialRecord, HashKnowsEverythingElse) {
  const TrialRecord record = full_record();
  std::vector<TrialRecord> others(8, record);
  others[0].seed.key += 1;
  others[1].placed += 1;
  others[2].picks[1].outcome = PickOutcome::kSlipped;
  others[3].picks[0].check.estimates[1].error.rotation = std::nextafter(0.01, 1);
  others[4].picks[0].world_hash ^= 1;
  others[5].error = "x";
  others[6].picks[0].rejections["rim blocked"] = 4;
  others[7].picks[0].place_error.reset();
  for (std::size_t i = 0; i < others.size(); ++i) EXPECT_NE(record_hash(others[i]), record_hash(record)) << i;
}

TEST(TrialRecord, ForeignTextSurvives) {
  TrialRecord record = full_record();
  record.error = "a \"quoted\" \\ path\nof two lines\t\x01 \xc3\xbc";
  EXPECT_EQ(trial_record_from_json(to_json_line(record), "line").error, record.error);
  record.error = "not UTF-8: \xff\xfe";
  const std::string line = to_json_line(record);
  EXPECT_EQ(to_json_line(trial_record_from_json(line, "line")), line);
}

TEST(TrialRecord, BadLinesAreRefusedWithTheirPlace) {
  const std::string line = to_json_line(full_record());
  const std::string place = "run/records/a.jsonl:7: ";
  EXPECT_EQ(refusal(line), "accepted");
  EXPECT_EQ(refusal("{"), place + "is not a JSON record");
  EXPECT_EQ(refusal(""), place + "is not a JSON record");
  EXPECT_EQ(refusal(line + "x"), place + "is not a JSON record");
  EXPECT_EQ(refusal("[]").rfind(place, 0), 0u);
  EXPECT_EQ(refusal(replaced(line, "\"schema\":4", "\"schema\":1")).rfind(place + "schema: 1", 0), 0u);
  EXPECT_EQ(refusal(replaced(line, "\"dropped\":10,", "")), place + "dropped: is missing");
  EXPECT_EQ(refusal(replaced(line, "\"dropped\":10", "\"dropped\":\"10\"")), place + "dropped: is not a whole number");
  EXPECT_EQ(refusal(replaced(line, "\"dropped\":10", "\"dropped\":1e10")), place + "dropped: is not a whole number");
  EXPECT_EQ(refusal(replaced(line, "\"seed\":5000", "\"seed\":-1")), place + "seed: is not a whole number >= 0");
  EXPECT_EQ(refusal(replaced(line, "\"escaped\"", "\"extra\":1,\"escaped\"")), place + "extra: unknown key");
  EXPECT_EQ(refusal(replaced(line, "\"escaped\"", "\"ex\\ntra\":1,\"escaped\"")), place + "ex?tra: unknown key");
  EXPECT_EQ(refusal(replaced(line, "NoSeal", "NoSeel")), place + "picks[1].outcome: 'NoSeel' is not a pick outcome");
  EXPECT_EQ(refusal(replaced(line, "\"score\":0.75", "\"scorn\":0.75")),
            place + "picks[0].estimates[0].score: is missing");
  EXPECT_EQ(refusal(replaced(line, "fedcba9876543210", "fedcba987654321")).rfind(place + "picks[0].frame_hash", 0), 0u);
  EXPECT_EQ(refusal(replaced(line, "\"rim blocked\":3", "\"rim blocked\":[]")),
            place + "picks[0].rejections: rim blocked: is not a whole number");
}

TEST(TrialRecord, AlteredValuesAreNoticed) {
  const std::string line = to_json_line(full_record());
  const std::string altered = refusal(replaced(line, "\"placed\":1", "\"placed\":9"));
  EXPECT_NE(altered.find("hash: does not fit"), std::string::npos) << altered;
  EXPECT_EQ(refusal(replaced(line, "\"plan\":0.05}]}", "\"plan\":0.05},{}]}"))
                .rfind("run/records/a.jsonl:7: wall.picks[2]", 0),
            0u);
  EXPECT_EQ(refusal(line.substr(0, line.rfind("\"picks\":[")) + "\"picks\":[]}}"),
            "run/records/a.jsonl:7: wall.picks: is not as long as the list of picks");
  EXPECT_EQ(refusal(replaced(line, "\"wall\":{\"total\":12.5", "\"wall\":{\"total\":13.5")),
            "run/records/a.jsonl:7: sum: does not fit the line: the record was altered or damaged");
  EXPECT_EQ(refusal(line.substr(0, line.rfind(",\"sum\"")) + "}"), "accepted") << "older lines have no sum";
}

TEST(TrialRecord, CountsMustFitTogether) {
  const auto refused = [](const auto& spoil) {
    TrialRecord record = full_record();
    spoil(record);
    return refusal(to_json_line(record));  // with the hash that fits
  };
  const std::string place = "run/records/a.jsonl:7: ";
  EXPECT_EQ(refused([](TrialRecord&) {}), "accepted");
  EXPECT_EQ(refused([](TrialRecord& r) { r.placed = r.dropped + 1; }), place + "placed: does not lie in 0 .. dropped");
  EXPECT_EQ(refused([](TrialRecord& r) { r.picks[1].check.found_2mm = r.picks[1].check.visible + 1; }),
            place + "picks[1].visible: is less than found");
  EXPECT_EQ(refused([](TrialRecord& r) { r.picks[0].check.counted = r.picks[0].check.right - 1; }),
            place + "picks[0].counted: is less than right");
}

class RunFolder : public testing::Test {
 protected:
  RunFolder() {
    std::filesystem::remove_all(folder_);
    make_folder(folder_ + "/records");
  }
  ~RunFolder() override { std::filesystem::remove_all(folder_); }

  std::string refusal() const {
    try {
      read_records(folder_);
    } catch (const SpecError& error) {
      return error.what();
    }
    return "accepted";
  }

  std::string folder_ =
      testing::TempDir() + "binpick_run_" + testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST(TrialRecord, TellsWhoRanItAndHowItFailedOutsideAndInsideTheHash) {
  const TrialRecord sound = full_record(4);
  TrialRecord repeated = sound;
  repeated.build = "b1";
  repeated.attempts = 2;
  repeated.first_failure = "Crash: signal 11";
  EXPECT_EQ(record_hash(repeated), record_hash(sound));
  EXPECT_EQ(canonical_line(repeated), canonical_line(sound));
  const TrialRecord back = trial_record_from_json(to_json_line(repeated), "x");
  EXPECT_EQ(back.build, "b1");
  EXPECT_EQ(back.attempts, 2);
  EXPECT_EQ(back.first_failure, "Crash: signal 11");
  EXPECT_FALSE(failure_of(back));

  TrialRecord failed = sound;
  failed.failure = TrialFailure::kOutOfMemory;
  EXPECT_NE(record_hash(failed), record_hash(sound));
  EXPECT_EQ(failure_of(trial_record_from_json(to_json_line(failed), "x")), TrialFailure::kOutOfMemory);
}

TEST(TrialRecord, EveryFlippedByteOfALineIsTold) {
  TrialRecord record = full_record(4);
  record.build = "b1";
  const std::string line = to_json_line(record);
  for (std::size_t at = 0; at < line.size(); ++at) {
    std::string flipped = line;
    flipped[at] = static_cast<char>(flipped[at] ^ 1);
    EXPECT_THROW(trial_record_from_json(flipped, "x"), SpecError) << at << ": " << line.substr(at, 20);
  }
}

TEST_F(RunFolder, RecordsComeSortedBySeedFromAllFiles) {
  write_file(folder_ + "/records/b.jsonl", to_json_line(full_record(3)) + "\n" + to_json_line(full_record(1)) + "\n");
  write_file(folder_ + "/records/a.jsonl", to_json_line(full_record(2)) + "\n");
  write_file(folder_ + "/records/notes.txt", "not a record");
  const std::vector<TrialRecord> records = read_records(folder_);
  ASSERT_EQ(records.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(records[i].seed.key, i + 1);
}

TEST_F(RunFolder, DuplicatesAreRefused) {
  write_file(folder_ + "/records/a.jsonl", to_json_line(full_record(4)) + "\n" + to_json_line(full_record(4)) + "\n");
  EXPECT_NE(refusal().find("a.jsonl:2: seed 4 is recorded already at "), std::string::npos) << refusal();
}

TEST_F(RunFolder, ATornLastLineIsReported) {
  const std::string line = to_json_line(full_record(4));
  write_file(folder_ + "/records/a.jsonl", line + "\n" + line.substr(0, line.size() / 2));
  EXPECT_NE(refusal().find("a.jsonl:2: the last line is incomplete"), std::string::npos) << refusal();
}

TEST_F(RunFolder, EmptyAndMissingFolders) {
  EXPECT_TRUE(read_records(folder_).empty());
  EXPECT_THROW(read_records(folder_ + "/nowhere"), AssetError);
}

}  // namespace
}  // namespace binpick

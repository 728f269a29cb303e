// docs/record_format.md names every key that the program writes.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "core/file_io.hpp"
#include "core/pick_outcome.hpp"
#include "evaluation/summary.hpp"
#include "tests/evaluation/example_records.hpp"

namespace binpick {
namespace {

using nlohmann::json;

void collect(const json& value, std::set<std::string>& keys) {
  for (const auto& item : value.items()) {
    if (value.is_object()) keys.insert(item.key());
    if (item.value().is_structured() && item.key() != "rejections" && item.key() != "collisions" &&
        item.key() != "by_name")
      collect(item.value(), keys);
  }
}

TEST(RecordFormat, EveryKeyIsDocumented) {
  const std::string document = read_file(BINPICK_SOURCE_DIR "/docs/record_format.md");
  const std::vector<TrialRecord> records = {
      examples::trial(1, {examples::pick(PickOutcome::kSucceeded, 2, 2), examples::pick(PickOutcome::kNoSeal, 2, 1)})};
  std::set<std::string> keys;
  collect(json::parse(to_json_line(records[0])), keys);
  collect(json::parse(summary_json(summarise(records, 1))), keys);
  for (PickOutcome outcome : all_pick_outcomes()) keys.insert(to_string(outcome));
  EXPECT_GT(keys.size(), 80u);
  for (const std::string& key : keys) EXPECT_NE(document.find("`" + key + "`"), std::string::npos) << key;
}

}  // namespace
}  // namespace binpick

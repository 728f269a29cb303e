// binpick bench heaps: the heaps are the trials' own, to the bit, whoever makes them; and a heap that is no heap is
// told.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/file_io.hpp"
#include "few_parts.hpp"
#include "run_program.hpp"

namespace binpick {
namespace {

std::vector<std::string> hashes(const TemporaryFolder& folder, const std::string& options) {
  const ProgramRun run = run_program("bench heaps " + folder.path("scene.yaml") + " --seeds 100:103 --json " +
                                     folder.path("h.json") + " " + options);
  EXPECT_EQ(run.code, 0) << run.err;
  std::vector<std::string> result;
  for (const auto& heap : nlohmann::json::parse(read_file(folder.path("h.json"))))
    result.push_back(heap.at("hash").get<std::string>());
  return result;
}

TEST(BenchHeaps, SameBitsForAnyNumberOfWorkersInAnyProcessAndInTheTrial) {
  const TemporaryFolder folder;
  write_file(folder.path("scene.yaml"), scene_text(4) + "trial: {max_picks: 1}\n");
  const std::vector<std::string> one = hashes(folder, "--workers 1");
  ASSERT_EQ(one.size(), 3u);
  EXPECT_NE(one[0], one[1]);
  EXPECT_EQ(hashes(folder, "--workers 2"), one);
  EXPECT_EQ(hashes(folder, "--workers 2 --fresh"), one);
  const ProgramRun trial = run_program("trial " + folder.path("scene.yaml") + " --seed 101");
  EXPECT_THAT(trial.out, testing::HasSubstr("\"drop_hash\":\"" + one[1] + "\""));
}

TEST(BenchHeaps, AHeapThatIsNotAtRestIsToldWithItsReason) {
  const TemporaryFolder folder;
  write_file(folder.path("scene.yaml"), scene_text(6) + "settle: {time_limit: 0.1 s}\n");
  const ProgramRun run = run_program("bench heaps " + folder.path("scene.yaml") + " --seeds 100:101 --rows");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, testing::HasSubstr("not at rest within the time limit"));
  EXPECT_THAT(run.out, testing::HasSubstr("1 / 1 = 100.00 %"));
}

}  // namespace
}  // namespace binpick

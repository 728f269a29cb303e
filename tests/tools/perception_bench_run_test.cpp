// binpick bench perception as a user runs it: the oracle is always right, the rows have what scripts read, peers answer
// in the view's frame, and what a user can get wrong is one line.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/file_io.hpp"
#include "tests/tools/few_parts.hpp"
#include "tests/tools/run_program.hpp"
#include "tools/bench/peers/peer.hpp"

namespace binpick {
namespace {

using testing::HasSubstr;

const std::string kRoot = BINPICK_SOURCE_DIR;

class PerceptionBenchRun : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder();
    write_file(folder_->path("scene.yaml"), scene_text(3));
  }
  static void TearDownTestSuite() { delete folder_; }
  static ProgramRun run(const std::string& more) {
    return run_program("bench perception --scene-files " + folder_->path("scene.yaml") + " --scenes 2 --cache " +
                       folder_->path("heaps") + " --json " + folder_->path("out.json") + " " + more);
  }
  static nlohmann::json rows() { return nlohmann::json::parse(read_file(folder_->path("out.json"))).at("rows"); }
  static TemporaryFolder* folder_;
};
TemporaryFolder* PerceptionBenchRun::folder_ = nullptr;

TEST_F(PerceptionBenchRun, APartThatIsNotThereIsNotFoundInItsLookAlike) {
  // What the heap of shafts showed before: an end of 25 mm whose shoulder is half hidden, taken for a bolt of 24 mm
  // (scored 0.99 and 0.94).
  // The heaps are kept in tests/tools/heaps: another solver drops others for the same seed, where a false shaft may
  // lie.
  std::filesystem::copy(kRoot + "/tests/tools/heaps", folder_->path("kept"), std::filesystem::copy_options::recursive);
  const ProgramRun wrong = run_program("bench perception --wrong --scene-files " + kRoot + "/scenes/bolt_bin.yaml " +
                                       kRoot + "/scenes/shaft_bin.yaml --seeds 101:102 --cache " +
                                       folder_->path("kept") + " --sensor gauss_0.5mm,d435_848");
  ASSERT_EQ(wrong.code, 0) << wrong.err;
  EXPECT_THAT(wrong.out, HasSubstr("| gauss_z:sigma_0.5mm, looked for | in shaft_bin | in bolt_bin |")) << wrong.out;
  EXPECT_THAT(wrong.out, HasSubstr("| bolt_m24x80 | 0 | - |")) << wrong.out;
  EXPECT_THAT(wrong.out, HasSubstr("| disparity:d435_848, looked for |"));
  std::size_t sums = 0;
  for (std::size_t at = 0; (at = wrong.out.find("\n0 poses in 0 of 2 views.\n", at)) != std::string::npos; ++at) ++sums;
  EXPECT_EQ(sums, 2u) << wrong.out;
  std::size_t heaps = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_->path("kept")))
    heaps += entry.is_regular_file();
  EXPECT_EQ(heaps, 2u) << "heaps of another key were dropped: drop these two again";
}

TEST_F(PerceptionBenchRun, TheOracleIsAlwaysRightAndTheRowsHaveEveryKey) {
  const ProgramRun oracle = run("--sensor ideal --estimator oracle --estimator ppf");
  ASSERT_EQ(oracle.code, 0) << oracle.err;
  const nlohmann::json json = rows();
  ASSERT_EQ(json.size(), 2u);
  for (const nlohmann::json& row : json) {
    for (const char* key : {"part",
                            "sensor",
                            "scenes",
                            "recall",
                            "precision",
                            "top1",
                            "translation_median_m",
                            "rotation_median_rad",
                            "total_ms",
                            "first_ms",
                            "train_ms",
                            "table_bytes",
                            "ratio_opencv",
                            "ratio_pcl",
                            "estimator",
                            "missed",
                            "wrong",
                            "settings",
                            "stage_ms",
                            "z_bias_m"})
      EXPECT_TRUE(row.contains(key)) << key;
    EXPECT_EQ(row.at("part"), "tee");
    EXPECT_EQ(row.at("scenes"), 2);
    EXPECT_TRUE(row.at("ratio_opencv").is_null()) << "no peer took part";
  }
  EXPECT_EQ(json[0].at("recall").at("rate"), 1.0);
  EXPECT_EQ(json[0].at("precision").at("rate"), 1.0);
  EXPECT_EQ(json[0].at("top1").at("rate"), 1.0);
  EXPECT_LT(json[0].at("translation_median_m").get<double>(), 1e-12);
  EXPECT_TRUE(json[0].at("missed").empty());
  EXPECT_GT(json[0].at("recall").at("visible").get<int>(), 0);
  EXPECT_EQ(json[1].at("recall").at("visible"), json[0].at("recall").at("visible")) << "not the same looks";
  EXPECT_EQ(json[1].at("recall").at("rate"), 1.0) << "three parts under an ideal sensor";
  EXPECT_GT(json[1].at("table_bytes").get<int>(), 0);
}

TEST(PerceptionPeers, AnswerInTheFrameOfTheView) {
  const TemporaryFolder folder;
  write_file(folder.path("scene.yaml"), scene_text(1, "bearing_6914"));  // peers lose parts of a heap
  for (const EstimatorEntry& peer : peer_registry()) {
    const ProgramRun run = run_program("bench perception --scene-files " + folder.path("scene.yaml") +
                                       " --scenes 2 --peer-scenes 1 --sensor ideal --estimator \"" + peer.name +
                                       " voxel=0.08 best=1\" --estimator oracle --json " + folder.path("out.json"));
    ASSERT_EQ(run.code, 0) << run.err;
    const nlohmann::json rows = nlohmann::json::parse(read_file(folder.path("out.json"))).at("rows");
    EXPECT_EQ(rows[0].at("scenes"), 1) << "asked about more heaps than wanted";
    EXPECT_EQ(rows[1].at("scenes"), 2);
    EXPECT_EQ(rows[0].at("recall").at("rate"), 1.0) << peer.name << ": a bearing in full view, no noise";
    EXPECT_TRUE(rows[1].at("ratio_" + peer.name).is_number());
    EXPECT_THAT(run.out, HasSubstr("settings voxel: 0.08"));
  }
}

TEST_F(PerceptionBenchRun, AWronglyPlacedOracleIsListedAsFailure) {
  const ProgramRun oracle = run("--sensor ideal --estimator \"oracle translation_error=0.1\" --failures");
  ASSERT_EQ(oracle.code, 0) << oracle.err;
  const nlohmann::json row = rows().at(0);
  EXPECT_LT(row.at("precision").at("rate").get<double>(), 1.0);
  EXPECT_EQ(row.at("wrong").size(),
            row.at("precision").at("counted").get<std::size_t>() - row.at("precision").at("right").get<std::size_t>());
  EXPECT_EQ(row.at("missed").size(),
            row.at("recall").at("visible").get<std::size_t>() - row.at("recall").at("found").get<std::size_t>());
  EXPECT_THAT(oracle.out, HasSubstr("wrong   rank 0"));
}

TEST_F(PerceptionBenchRun, BadArgumentsAreOneLineAndExitTwo) {
  for (const std::string bad : {"--estimator ppff", "--estimator \"ppf search.edgse=false\"",
                                "--set search.rounds=none", "--sensor d999", "--parts washer", "--seeds 5:5",
                                "--bin-offset \"5 deg\"", "--other-part nowhere.yaml", "--estimator-file no.yaml"}) {
    const ProgramRun wrong = run(bad);
    EXPECT_EQ(wrong.code, 2) << bad << wrong.err;
    EXPECT_TRUE(wrong.out.empty()) << bad;
    EXPECT_EQ(std::count(wrong.err.begin(), wrong.err.end(), '\n'), 1) << wrong.err;
  }
  EXPECT_EQ(run_program("bench perception --scenes 0").code, 2);
  EXPECT_EQ(run_program("bench perception --scene-files " + folder_->path("no.yaml")).code, 2);
  EXPECT_EQ(run_program("bench perception --scenes 1 --parts tee --json /dev/null/out.json", "cd " + kRoot).code, 6);
}

}  // namespace
}  // namespace binpick

// A run as a BOP data set: what is written is what the trial's first look saw, and scores as it must.
#include "trials/dataset_export.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/image_io.hpp"
#include "evaluation/bop_score.hpp"
#include "evaluation/trial_record.hpp"
#include "tests/evaluation/bop_dataset.hpp"
#include "trials/environment.hpp"
#include "trials/observation.hpp"

namespace binpick {
namespace {

struct Silent : ProgressSink {
  void update(std::size_t, std::size_t, const std::string&) override {}
};

/// A run of three T-pieces whose estimates are the truth off by some millimetres: scenario and records, seeds 4 and 5.
/// The record of 5 tells of another frame.
class DatasetExport : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new examples::Folder("dataset_export");
    const std::string root = BINPICK_SOURCE_DIR;
    write_file(folder_->path("scene.yaml"), "name: few\npart: " + root +
                                                "/assets/parts/tee/part.yaml\ncount: 3\ncell: " + root +
                                                "/assets/cells/mz07_one_cup.yaml\nsensor: {type: ideal}\n"
                                                "estimator: {type: oracle, translation_error: 1 mm}\n");
    Scenario scenario = read_scenario(folder_->path("scene.yaml"));
    const TrialContext context = make_trial_context(scenario);
    make_folder(run() + "/records");
    write_file(run() + "/scenario.yaml", expanded_yaml(scenario, run()));
    std::string lines;
    for (const std::uint64_t seed : {4, 5}) {
      TrialRecord record;
      record.scenario = scenario.name, record.scenario_hash = context.hash, record.seed = Seed{seed};
      record.build = build_id();
      if (seed == 5) record.picks.emplace_back().frame_hash = 1;
      lines += to_json_line(record) + "\n";
    }
    write_file(run() + "/records/0.jsonl", lines);
    Silent silent;
    replayed_ = new ReplayedRun(export_dataset(run(), set(), 100, silent));
  }
  static void TearDownTestSuite() {
    delete replayed_;
    delete folder_;
  }
  static std::string run() { return folder_->path("run"); }
  static std::string set() { return folder_->path("set"); }
  static examples::Folder* folder_;
  static ReplayedRun* replayed_;
};
examples::Folder* DatasetExport::folder_ = nullptr;
ReplayedRun* DatasetExport::replayed_ = nullptr;

TEST_F(DatasetExport, EverySeedIsASceneAndAnotherFrameIsTold) {
  EXPECT_EQ(replayed_->seeds, (std::vector<std::uint64_t>{4, 5}));
  EXPECT_EQ(replayed_->different, (std::vector<std::uint64_t>{5}));
  EXPECT_TRUE(replayed_->same_build);
  const BopDataset read = read_bop_dataset(set());
  ASSERT_EQ(read.images.size(), 2u);
  EXPECT_EQ(read.images[0].scene, 4);
  EXPECT_EQ(read.images[0].instances.size(), 3u);
  // The object's origin is the middle of its box.
  const Eigen::AlignedBox3d box = bounding_box(read.objects.at(1).part.mesh_P);
  EXPECT_LT(box.center().norm(), 1e-9);
}

// The pictures, the poses and the depth agree: a part drawn where the truth says is where the depth has it.
TEST_F(DatasetExport, PosesMasksAndDepthAgree) {
  const BopDataset read = read_bop_dataset(set());
  for (const BopImage& image : read.images) {
    const Image<float> depth = read_bop_depth(read, image);
    for (const BopInstance& one : image.instances) {
      ZBuffer drawn(image.camera);
      drawn.draw(read.objects.at(one.object).part.mesh_P, one.X_CO, 0);
      int silhouette = 0, alike = 0;
      for (std::size_t p = 0; p < depth.size(); ++p) {
        if (drawn.result().ids[p] != 0) continue;
        ++silhouette;
        alike += std::abs(drawn.result().depth[p] - depth[p]) < 1e-3f ? 1 : 0;
      }
      EXPECT_EQ(silhouette, one.px_all);  // seeds 4 and 5 lie inside the image
      EXPECT_GE(alike, one.px_visible - 5);
      EXPECT_GT(one.visible_fraction, 0.5);
      EXPECT_GE(one.px_all, one.px_visible);
      EXPECT_GE(one.px_all, one.px_valid);
      EXPECT_GT(one.box_visible[2] * one.box_visible[3], one.px_visible);
    }
  }
  for (const char* file : {"gray/000000.png", "mask/000000_000002.png", "mask_visib/000000_000002.png"})
    EXPECT_TRUE(std::filesystem::exists(set() + "/test/000004/" + file)) << file;
}

TEST_F(DatasetExport, OurResultsScoreWhatTheOracleIsOffBy) {
  Silent silent;
  std::vector<BopEstimate> ours;
  const ReplayedRun run_again = estimates_of_run(run(), 1, silent, ours);
  EXPECT_EQ(run_again.seeds.size(), 1u);  // at most one
  ASSERT_EQ(ours.size(), 3u);
  EXPECT_EQ(ours[0].scene, 4);
  estimates_of_run(run(), 100, silent, ours);
  ours.erase(ours.begin(), ours.begin() + 3);
  const BopDataset read = read_bop_dataset(set());
  const BopScore score = score_bop(read, ours, {});
  EXPECT_EQ(score.elsewhere, 0u);
  ASSERT_EQ(score.matched.pairs.size(), 6u);
  double worst = 0;
  for (const PairErrors& pair : score.matched.pairs) worst = std::max(worst, pair.translation);
  EXPECT_GT(worst, 1e-4);
  EXPECT_LT(worst, 0.015);
  const BopScore truth = score_bop(read, examples::truth_as_estimates(read, [](const Pose& X, int) { return X; }), {});
  EXPECT_EQ(truth.ar, 1.0);
  EXPECT_EQ(truth.ap, 1.0);
}

TEST_F(DatasetExport, WhatIsNoRunIsRefused) {
  Silent silent;
  EXPECT_THROW(export_dataset(folder_->path("nowhere"), folder_->path("x"), 1, silent), SpecError);
  EXPECT_THROW(export_dataset(run(), set(), 1, silent), SpecError);  // not empty
}

}  // namespace
}  // namespace binpick

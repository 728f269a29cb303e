// Stages that are told the truth: what they are told is the truth.
#include "trials/oracle_stages.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/yaml.hpp"
#include "sim/render_scene.hpp"

namespace binpick {
namespace {

const std::string kScenes = std::string(BINPICK_SOURCE_DIR) + "/scenes/";

struct Look {
  Scenario scenario = read_scenario(kScenes + "bearing_bin_chain.yaml");
  TrialContext context;
  Observation seen;
  std::vector<Pose> parts_W;
  explicit Look(int count) {
    scenario.parts[0].count = count;
    context = make_trial_context(scenario);
    const TrueCell built = true_cell(scenario, context, Seed{12});
    CellWorld cell_world(built.cell, scenario.physics, context.parts);
    drop_heap(scenario, context, Seed{12}, cell_world);
    seen = observe(scenario, cell_world, context, Seed{12}, 0);
  }
};

TEST(OracleStages, ThePlannerSeesTheHeapWhereItIsAndTheEstimatesWhereTheyWere) {
  const Look look(3);
  ASSERT_GT((look.seen.X_WC_believed.translation() - look.seen.truth.X_WC.translation()).norm(), 1e-4)
      << "the chain leaves an error";
  EstimateResult found;
  found.estimates.push_back({0, Pose(Eigen::Translation3d(0.01, 0.02, 0.55)), 1});
  const TrueSight sight = true_sight(look.seen, found);
  const Pose before_W = look.seen.X_WC_believed * found.estimates[0].X_CP;
  EXPECT_TRUE((sight.X_WC * sight.found.estimates[0].X_CP).isApprox(before_W, 1e-12));
  EXPECT_TRUE((sight.X_WC * sight.view.X_CB).isApprox(look.scenario.cell.X_WB, 1e-6));
  // Every pixel of a part lies on that part: within its box, where it is in the world.
  const auto& frame = std::get<DepthFrame>(sight.view.seen);
  const Image<std::int32_t>& ids = look.seen.captures[0].exact.ids;
  const Part& part = look.context.parts[0];
  Eigen::AlignedBox3d box_P;
  for (const Eigen::Vector3d& v : part.mesh_P.vertices) box_P.extend(v);
  int on_parts = 0;
  for (int v = 0; v < ids.height(); v += 3)
    for (int u = 0; u < ids.width(); u += 3)
      for (const GroundTruth::Instance& instance : look.seen.truth.instances) {
        if (ids(u, v) != static_cast<std::int32_t>(instance.body)) continue;
        const Eigen::Vector3d p_W = sight.X_WC * frame.camera.unproject(u, v, frame.depth(u, v));
        EXPECT_LT(box_P.exteriorDistance(instance.X_WP.inverse() * p_W), 1e-4);
        ++on_parts;
      }
  EXPECT_GT(on_parts, 500);
}

TEST(OracleStages, TheSegmentationIsThatOfThePartsAndTheEstimatorUsesIt) {
  Look look(3);
  const auto parts = true_segmentation(look.seen);
  const Image<std::int32_t>& ids = look.seen.captures[0].exact.ids;
  std::size_t pixels = 0, visible = 0;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    EXPECT_EQ((*parts)[i] != 0, ids[i] >= 0 && ids[i] < kIdBin);
    pixels += (*parts)[i] != 0;
  }
  for (const GroundTruth::Instance& instance : look.seen.truth.instances)
    visible += static_cast<std::size_t>(instance.visible_pixels);
  EXPECT_EQ(pixels, visible);
  look.seen.view.segmentation = parts;
  EXPECT_EQ(look.scenario.estimator->estimate(look.seen.view, Seed{1}).estimates.size(), 3u);
  look.seen.view.segmentation = std::make_shared<Image<std::uint8_t>>(ids.width(), ids.height(), std::uint8_t{0});
  EXPECT_TRUE(look.scenario.estimator->estimate(look.seen.view, Seed{1}).estimates.empty()) << "nothing is a part";
}

TEST(OracleStages, AreWrittenOnlyWhereOneIsOn) {
  Scenario scenario = read_scenario(kScenes + "bearing_bin.yaml");
  EXPECT_EQ(expanded_yaml(scenario, "/").find("oracles"), std::string::npos);
  const std::string hash = scenario_hash(scenario);
  scenario.oracles.seal = true;
  EXPECT_NE(expanded_yaml(scenario, "/").find("seal: true"), std::string::npos);
  EXPECT_NE(scenario_hash(scenario), hash);
}

TEST(OracleStages, AreForOneCamera) {
  const std::string text = read_file(kScenes + "bearing_bin_two_cameras.yaml") + "\noracles: {planning: true}\n";
  Scenario scenario;
  const std::string file = testing::TempDir() + "two_cameras_oracle.yaml";
  std::string absolute = text;
  for (std::size_t at = 0; (at = absolute.find("../assets", at)) != std::string::npos; at += 9)
    absolute.replace(at, 9, std::string(BINPICK_SOURCE_DIR) + "/assets");
  write_file(file, absolute);
  try {
    read_scenario(file);
    FAIL();
  } catch (const SpecError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("one camera"));
  }
}

}  // namespace
}  // namespace binpick

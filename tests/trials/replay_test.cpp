// Replays: looking on changes no bit; what is kept is where things were; the text says what the page needs.
#include "trials/replay.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "trials/replay_picture.hpp"
#include "trials/replay_recorder.hpp"
#include "trials/trial.hpp"

namespace binpick {
namespace {

struct Watched {
  Scenario scenario;
  TrialContext context;
  TrialRecord without, with;
  Replay replay;
};

/// Four bearings, truth as estimate, two picks; with and without somebody looking on.
const Watched& watched() {
  static const Watched made = [] {
    Watched w;
    w.scenario = read_scenario(std::string(BINPICK_SOURCE_DIR) + "/scenes/ci/bearing_oracle.yaml");
    w.context = make_trial_context(w.scenario);
    w.without = run_trial(w.scenario, Seed{3}, w.context);
    ReplayRecorder recorder(300);
    w.with = run_trial(w.scenario, Seed{3}, w.context, nullptr, &recorder);
    w.replay = recorder.finish(w.with);
    return w;
  }();
  return made;
}

TEST(Replay, LookingOnChangesNoBit) {
  ASSERT_TRUE(watched().with.error.empty()) << watched().with.error;
  EXPECT_EQ(canonical_line(watched().with), canonical_line(watched().without));
}

TEST(Replay, EveryPartHasAWayFromDropToPlace) {
  const Replay& replay = watched().replay;
  ASSERT_EQ(replay.bodies.size(), 4u);
  ASSERT_EQ(replay.looks.size(), watched().with.picks.size());
  for (const PoseTrack& track : replay.bodies) {
    const std::optional<Pose> first = pose_at(track, track.times.front()), rest = pose_at(track, replay.looks[0].time);
    ASSERT_TRUE(first && rest);
    EXPECT_GT(first->translation().z(), rest->translation().z() + 0.015);  // it fell
    EXPECT_FALSE(pose_at(track, track.times.front() - 0.1));
  }
  const Cell& cell = watched().scenario.cell;
  int placed = 0;
  for (const PoseTrack& track : replay.bodies) {
    const Eigen::Vector3d p_T = cell.tray.X_WT.inverse() * pose_at(track, replay.duration)->translation();
    placed += p_T.head<2>().cwiseAbs().maxCoeff() < cell.tray.inner_size.maxCoeff() / 2 ? 1 : 0;
  }
  EXPECT_EQ(placed, watched().with.placed);
}

TEST(Replay, TheOraclesEstimatesLieOnTheBodiesTheyAreOf) {
  const Replay& replay = watched().replay;
  for (const ReplayLook& look : replay.looks) {
    ASSERT_FALSE(look.estimates.empty());
    EXPECT_LE(look.cloud_W.size(), 300u);
    for (const ReplayEstimate& e : look.estimates) {
      ASSERT_GE(e.body, 0);
      const Pose X_WP = *pose_at(replay.bodies[static_cast<std::size_t>(e.body)], look.time);
      EXPECT_LT(distance_between(X_WP, e.X_WP), 0.6e-3);  // the track is kept to 0.5 mm
    }
  }
}

TEST(Replay, TheArmsChainIsTheArms) {
  const ReplayCell& cell = watched().replay.cell;
  const Vector6d q = (Vector6d() << 0.3, -0.2, 0.5, 1.1, -0.7, 0.4).finished();
  Pose X_WF = cell.X_WR;
  for (std::size_t j = 0; j < 6; ++j)
    X_WF = X_WF * cell.joints[j].X_before * Eigen::AngleAxisd(q[static_cast<Eigen::Index>(j)], cell.joints[j].axis);
  X_WF = X_WF * cell.X_6F;
  const Pose expected = watched().scenario.cell.X_WR * watched().scenario.cell.arm->forward(q);
  EXPECT_LT((X_WF.matrix() - expected.matrix()).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Replay, ThinningKeepsToHalfAMillimetre) {
  PoseTrack track;  // a quarter circle of 0.1 m, then rest
  for (int k = 0; k <= 200; ++k) {
    const double angle = std::min(1.57, 0.01 * k);
    track.times.push_back(0.02 * k);
    track.X.push_back(pose_from(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix(),
                                {0.1 * std::cos(angle), 0.1 * std::sin(angle), 0}));
  }
  const PoseTrack thin = thinned(track);
  EXPECT_LT(thin.times.size(), 20u);
  EXPECT_EQ(thin.times.back(), track.times.back());
  for (std::size_t k = 0; k < track.times.size(); ++k) {
    const Pose X = *pose_at(thin, track.times[k]);
    EXPECT_LE(distance_between(X, track.X[k]), 0.5001e-3) << k;
    EXPECT_LE(angle_between(X.linear(), track.X[k].linear()), 0.01001) << k;
  }
}

std::vector<std::int16_t> words(const std::string& text) {
  static const std::string kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned buffer = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    buffer = buffer << 6 | static_cast<unsigned>(kDigits.find(c));
    if ((bits += 6) >= 8) bytes += static_cast<char>(buffer >> (bits -= 8) & 0xff);
  }
  std::vector<std::int16_t> values;
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2)
    values.push_back(static_cast<std::int16_t>(static_cast<unsigned char>(bytes[i]) |
                                               static_cast<unsigned char>(bytes[i + 1]) << 8));
  return values;
}

TEST(Replay, TheTextHoldsTheTracks) {
  const Replay& replay = watched().replay;
  const nlohmann::json json = nlohmann::json::parse(replay_json(replay));
  EXPECT_EQ(json["schema"], kReplaySchema);
  EXPECT_EQ(json["seed"], "3");
  const std::vector<std::int16_t> poses = words(json["bodies"][2]["x"]), times = words(json["bodies"][2]["t"]);
  const PoseTrack& track = replay.bodies[2];
  ASSERT_EQ(poses.size(), 7 * track.X.size());
  ASSERT_EQ(times.size(), track.times.size());
  for (std::size_t k = 0; k < track.X.size(); ++k) {
    EXPECT_NEAR(1e-4 * poses[7 * k + 2], track.X[k].translation().z(), 0.6e-4);
    const Eigen::Quaterniond q(poses[7 * k + 6], poses[7 * k + 3], poses[7 * k + 4], poses[7 * k + 5]);
    EXPECT_LT(angle_between(q.normalized().toRotationMatrix(), track.X[k].linear()), 1e-3);
  }
  EXPECT_EQ(json["looks"].size(), replay.looks.size());
  EXPECT_EQ(json["events"][0]["what"], "heap at rest");
}

TEST(Replay, MeshesAreMadeSmall) {
  const std::size_t whole = watched().replay.cell.part_meshes_P[0].triangles.size();
  const nlohmann::json fine = nlohmann::json::parse(replay_cell_json(watched().replay.cell));
  const nlohmann::json coarse = nlohmann::json::parse(replay_cell_json(watched().replay.cell, 800));
  const std::size_t triangles = words(coarse["parts"][0]["mesh"]["i"]).size() / 3;
  EXPECT_GT(whole, 800u);
  EXPECT_LE(triangles, 800u);
  EXPECT_GT(triangles, 100u);
  EXPECT_LE(words(fine["parts"][0]["mesh"]["i"]).size() / 3, 2500u);
  EXPECT_EQ(fine["links"].size(), 7u);
  const double step = coarse["parts"][0]["mesh"]["step"];
  double reach = 0;  // the ring's radius is kept
  for (const std::int16_t v : words(coarse["parts"][0]["mesh"]["v"])) reach = std::max(reach, step * std::abs(v));
  EXPECT_NEAR(reach, 0.05, 0.002);
}

TEST(ReplayPicture, ShowsTheTrialAtItsTime) {
  const Replay& replay = watched().replay;
  const std::unique_ptr<DepthRenderer> renderer = make_osmesa_renderer();
  const ReplayPicture picture(replay, *renderer);
  const auto parts_at = [&](double time) {
    const RenderScene scene = picture.scene(time);
    return std::count_if(scene.items.begin(), scene.items.end(),
                         [](const RenderItem& item) { return item.id < kIdBin; });
  };
  EXPECT_LT(parts_at(0.03), 4);  // parts rain one by one
  EXPECT_EQ(parts_at(replay.duration), 4);
  EXPECT_EQ(picture.scene(0.03).items.size() - static_cast<std::size_t>(parts_at(0.03)), 3u);  // no arm yet
  const double time = telling_time(replay, 0);
  EXPECT_GT(time, replay.looks[0].time);
  EXPECT_LT(time, span_of(replay, 0).second);
  // In the air the held part hangs below the tool.
  const RenderScene scene = picture.scene(time);
  const auto tool = std::find_if(scene.items.begin(), scene.items.end(), [](const auto& i) { return i.id == kIdTool; });
  ASSERT_NE(tool, scene.items.end());
  const auto held = static_cast<std::size_t>(*replay.record.picks[0].lifted_body);
  EXPECT_LT(distance_between(scene.items[held].X_WO, tool->X_WO), 0.1);
  const Image<Rgb> before = picture.at(replay.looks[0].time, 120, 80), lifted = picture.at(time, 120, 80);
  std::size_t different = 0;
  for (std::size_t i = 0; i < before.size(); ++i) different += before[i] != lifted[i] ? 1 : 0;
  EXPECT_GT(different, before.size() / 50);
}

}  // namespace
}  // namespace binpick

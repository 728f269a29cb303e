#include "perception/voting.hpp"

#include <gtest/gtest.h>

#include <map>

#include "perception/pose_clustering.hpp"
#include "tests/perception/scene_maker.hpp"

namespace binpick {
namespace {

PointCloud random_points(std::uint64_t seed, int count) {
  Rng rng(seed);
  PointCloud cloud;
  for (int i = 0; i < count; ++i) {
    cloud.points.push_back(0.05 * rng.unit_vector() * std::cbrt(rng.uniform()));
    cloud.normals.push_back(rng.unit_vector());
  }
  return cloud;
}

VotingConfig exact_config() {
  VotingConfig config;
  config.reference_step = 1;
  config.pair_radius = 1;
  config.partners = 0;
  config.full_cell = 1;
  config.largest_cell = 1 << 30;
  config.peaks = 1;
  return config;
}

OrientedPoint at(const PointCloud& cloud, std::size_t i) {
  return {cloud.points[i].cast<float>(), cloud.normals[i].cast<float>()};
}

/// Most votes that any (model point, alpha) gets from one scene point, by trying every pair against every pair.
int most_votes(const PointCloud& scene, std::size_t reference, const PointCloud& model, const PairQuantiser& q) {
  std::map<std::pair<std::size_t, int>, int> votes;
  const Eigen::Matrix3f S = frame_with_x(at(scene, reference).normal);
  for (std::size_t j = 0; j < scene.size(); ++j) {
    if (j == reference) continue;
    const int cell = q.cell(pair_feature(at(scene, reference), at(scene, j)));
    for (std::size_t m = 0; m < model.size() && cell >= 0; ++m)
      for (std::size_t k = 0; k < model.size(); ++k) {
        if (k == m || q.cell(pair_feature(at(model, m), at(model, k))) != cell) continue;
        const Eigen::Matrix3f M = frame_with_x(at(model, m).normal);
        const int turns = alpha_turns(S, at(scene, j).point - at(scene, reference).point) -
                          alpha_turns(M, at(model, k).point - at(model, m).point);
        const int bin = ((turns + 1024 + 4 * 65536) / 2048) % 32;  // 32 bins, centred
        ++votes[{m, bin}];
      }
  }
  int most = 0;
  for (const auto& [key, n] : votes) most = std::max(most, n);
  return most;
}

TEST(Voting, AgreesWithBruteForceOnSmallClouds) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const PointCloud model = random_points(seed, 30);
    Rng rng(100 + seed);
    const Pose X = pose_from(rng.rotation().toRotationMatrix(), Eigen::Vector3d(0.1, -0.2, 0.6));
    const PointCloud scene = transformed(X, model);
    const VotingConfig config = exact_config();
    const PairTable table(model, Symmetry(), config.quantiser(0.1), 1e-4);
    const auto poses = vote(scene, table, 0.1, config);
    ASSERT_EQ(poses.size(), scene.size()) << "seed " << seed;
    for (std::size_t i = 0; i < scene.size(); ++i)
      EXPECT_EQ(static_cast<int>(poses[i].votes), most_votes(scene, i, model, table.quantiser())) << "seed " << seed;
  }
}

TEST(Voting, GivesTheSameBitsOnAnyNumberOfThreads) {
  const PointCloud model = random_points(1, 80);
  PointCloud scene;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const Pose X = pose_from(Eigen::Matrix3d::Identity(), {0.02 * static_cast<double>(seed), 0, 0.6});
    const PointCloud part = transformed(X, random_points(seed, 80));
    scene.points.insert(scene.points.end(), part.points.begin(), part.points.end());
    scene.normals.insert(scene.normals.end(), part.normals.begin(), part.normals.end());
  }
  const VotingConfig config = exact_config();
  const PairTable table(model, Symmetry(), config.quantiser(0.1), 1e-4);
  const auto one = vote(scene, table, 0.1, config);
  EXPECT_GT(one.size(), 150u);
  for (const int threads : {2, 3, 7}) {
    const auto more = vote(scene, table, 0.1, config, {threads});
    ASSERT_EQ(more.size(), one.size()) << threads;
    for (std::size_t i = 0; i < one.size(); ++i) {
      ASSERT_EQ(more[i].votes, one[i].votes) << threads;
      ASSERT_TRUE(more[i].X_CP.matrix() == one[i].X_CP.matrix()) << threads;
    }
  }
}

TEST(Voting, FindsTheOnlyPose) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const PointCloud model = random_points(seed, 60);
    Rng rng(200 + seed);
    const Pose X = pose_from(rng.rotation().toRotationMatrix(), Eigen::Vector3d(0.1, -0.2, 0.6));
    const VotingConfig config = exact_config();
    const PairTable table(model, Symmetry(), config.quantiser(0.1), 1e-4);
    const auto clusters = cluster_poses(vote(transformed(X, model), table, 0.1, config), Symmetry(), SamePose());
    ASSERT_FALSE(clusters.empty());
    EXPECT_LT(distance_between(clusters.front().X_CP, X), 0.004) << "seed " << seed;
    EXPECT_LT(angle_between(clusters.front().X_CP.linear(), X.linear()), 0.11) << "seed " << seed;  // one alpha bin
  }
}

TEST(Voting, RightCorrespondencesGiveTheExactPose) {
  const PointCloud model = random_points(3, 2);
  Rng rng(4);
  const Pose X = pose_from(rng.rotation().toRotationMatrix(), Eigen::Vector3d(0.1, -0.2, 0.6));
  const PointCloud scene = transformed(X, model);
  const auto alpha = [](const PointCloud& c) {
    return alpha_turns(frame_with_x(at(c, 0).normal), at(c, 1).point - at(c, 0).point) / 65536.0 * 2 * std::numbers::pi;
  };
  const Pose found = pose_from_vote(at(scene, 0), at(model, 0), alpha(scene) - alpha(model));
  EXPECT_LT(distance_between(found, X), 1e-4);
  EXPECT_LT(angle_between(found.linear(), X.linear()), 1e-3);
  EXPECT_TRUE(is_rigid(found));
}

TEST(PairTable, KeepsOneReferenceOfEachOrbitOfARing) {
  const Part ring = testing_scene::ring_part();
  const PointCloud cloud = sample_surface(ring.mesh_P, 0.005, Seed{1});
  const VotingConfig config = exact_config();
  const PairTable all(cloud, Symmetry(), config.quantiser(ring.diameter), 0.004);
  const PairTable reduced(cloud, ring.symmetry, config.quantiser(ring.diameter), 0.004);
  EXPECT_EQ(all.references().size(), cloud.size());
  EXPECT_LT(reduced.references().size(), 25u);  // 15 mm of face and two walls of 8 mm at 4 mm, and roundings
  EXPECT_GE(reduced.references().size(), 6u);
}

TEST(PairTable, NothingInNothingOut) {
  const VotingConfig config = exact_config();
  const PairTable table(random_points(1, 10), Symmetry(), config.quantiser(0.1), 1e-4);
  EXPECT_TRUE(vote(PointCloud(), table, 0.1, config).empty());
}

TEST(PoseClustering, TakesSymmetricTwinsAsOne) {
  const Part ring = testing_scene::ring_part();
  const Pose X = pose_from_xyz_rpy({0.1, 0, 0.5}, {0.3, 0.2, 0.1});
  const Pose turned = X * pose_from_xyz_rpy({0, 0, 0}, {0, 0, 1.0}),
             flipped = X * pose_from_xyz_rpy({0, 0, 0}, {3.14159265, 0, 0});
  const Pose tilted = X * pose_from_xyz_rpy({0, 0, 0}, {1.0, 0, 0});
  EXPECT_TRUE(same_pose(X, turned, ring.symmetry, SamePose()));
  EXPECT_TRUE(same_pose(X, flipped, ring.symmetry, SamePose()));
  EXPECT_FALSE(same_pose(X, tilted, ring.symmetry, SamePose()));
  EXPECT_FALSE(same_pose(X, turned, Symmetry(), SamePose()));
  const auto clusters = cluster_poses({{tilted, 5}, {X, 3}, {turned, 2}, {flipped, 1}}, ring.symmetry, SamePose());
  ASSERT_EQ(clusters.size(), 2u);
  EXPECT_EQ(clusters[0].votes, 6);  // three twins together beat the other
  EXPECT_TRUE(clusters[0].X_CP.isApprox(X));
}

/// Every pose against every cluster, in turn.
std::vector<PoseHypothesis> clusters_in_turn(std::vector<PoseHypothesis> poses, const Symmetry& symmetry,
                                             const SamePose& limits) {
  const auto best_first = [](const PoseHypothesis& a, const PoseHypothesis& b) { return a.votes > b.votes; };
  std::stable_sort(poses.begin(), poses.end(), best_first);
  std::vector<PoseHypothesis> clusters;
  for (const PoseHypothesis& pose : poses) {
    const auto same = std::find_if(clusters.begin(), clusters.end(), [&](const PoseHypothesis& c) {
      return same_pose(c.X_CP, pose.X_CP, symmetry, limits);
    });
    same == clusters.end() ? clusters.push_back(pose) : static_cast<void>(same->votes += pose.votes);
  }
  std::stable_sort(clusters.begin(), clusters.end(), best_first);
  return clusters;
}

TEST(PoseClustering, AgreesWithTryingEveryPoseAgainstEveryCluster) {
  const Part ring = testing_scene::ring_part();
  const SamePose limits{Eigen::Vector3d(0.01, 0, 0.002), 0.01, 0.6};
  for (std::uint64_t seed = 1; seed <= 6; ++seed)
    for (const Symmetry& symmetry : {Symmetry(), ring.symmetry}) {
      Rng rng(seed);
      std::vector<PoseHypothesis> poses;
      for (int k = 0; k < 700; ++k) {
        const Eigen::Vector3d place = k % 10 == 0 ? Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal())
                                                  : Eigen::Vector3d(0.02 * rng.unit_vector());
        const Pose X = pose_from(exp_so3(0.6 * rng.unit_vector() * rng.uniform()), place);
        poses.push_back({X, static_cast<double>(rng.below(40))});
      }
      const auto expected = clusters_in_turn(poses, symmetry, limits), found = cluster_poses(poses, symmetry, limits);
      EXPECT_LT(expected.size(), poses.size());
      ASSERT_EQ(found.size(), expected.size()) << "seed " << seed;
      for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(found[i].votes, expected[i].votes) << "seed " << seed << " cluster " << i;
        EXPECT_TRUE(found[i].X_CP.matrix() == expected[i].X_CP.matrix()) << "seed " << seed << " cluster " << i;
      }
    }
}

}  // namespace
}  // namespace binpick

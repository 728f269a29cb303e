// A bin, or a table, found in the view itself: drawn boxes whose size and pose are known.
#include "perception/bin_finder.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "perception/pose_estimator.hpp"
#include "perception/preprocess.hpp"
#include "tests/perception/scene_maker.hpp"

namespace binpick {
namespace {

using namespace testing_scene;

constexpr double kLargest = 0.1;  // m, of the wanted parts

/// What is drawn, in B.
struct Cell {
  Eigen::Vector3d size = {0.4, 0.3, 0.2};
  double wall = 0.005;
  std::array<bool, 4> walls = {true, true, true, true};  // at -x, +x, -y, +y
  double lean = 0;                                       // rad, draft of the walls
  bool ground = true;
  double sigma = 0.0005;  // m
};

/// A slab whose inner face holds the floor's edge, leaning outwards by `lean`.
Primitive wall_of(const Cell& cell, int k) {
  const int axis = k / 2;
  const double out = k % 2 == 0 ? -1 : 1, height = cell.size.z() / std::cos(cell.lean);
  Eigen::Vector3d box(cell.wall, cell.wall, height), middle = Eigen::Vector3d::Zero();
  box[1 - axis] = cell.size[1 - axis] + 2 * (cell.wall + height * std::sin(cell.lean));
  middle[axis] = out * cell.wall / 2;
  middle.z() = height / 2;
  Eigen::Vector3d edge = Eigen::Vector3d::Zero(), about = Eigen::Vector3d::Zero();
  edge[axis] = out * cell.size[axis] / 2;
  about[1 - axis] = axis == 0 ? out * cell.lean : -out * cell.lean;
  const Eigen::Matrix3d R = exp_so3(about);
  return Primitive::box(box, pose_from(R, edge + R * middle));
}

Scene drawn(const Cell& cell, const Pose& X_CB, Seed seed, const std::vector<Primitive>& more = {}) {
  Scene scene;
  ZBuffer buffer(scene.camera);
  const auto draw = [&](const Primitive& p) { buffer.draw(mesh_of(p), X_CB, 1); };
  const auto slab = [](double x, double y, double top) {
    return Primitive::box({x, y, 0.004}, pose_from(Eigen::Matrix3d::Identity(), {0, 0, top - 0.002}));
  };
  draw(slab(cell.size.x() + 2 * cell.wall, cell.size.y() + 2 * cell.wall, 0));
  if (cell.ground) draw(slab(3, 3, -0.006));
  for (int k = 0; k < 4; ++k)
    if (cell.walls[k]) draw(wall_of(cell, k));
  for (const Primitive& p : more) draw(p);
  scene.depth = buffer.result().depth;
  scene.noise.constant = cell.sigma;
  Rng rng = seed.rng();
  for (float& z : scene.depth)
    z = std::isfinite(z) ? static_cast<float>(z + cell.sigma * rng.normal()) : std::numeric_limits<float>::quiet_NaN();
  return scene;
}

/// A camera `away` from a point 50 mm over the floor's middle, tilted off the vertical, turned about it.
Pose looking_at_bin(double away, double tilt, double heading, double roll) {
  Pose X_BC = camera_above(away);
  X_BC = pose_from(exp_so3({0, 0, heading}) * exp_so3({tilt, 0, 0}), Eigen::Vector3d::Zero()) * X_BC *
         pose_from(exp_so3({0, 0, roll}), Eigen::Vector3d::Zero());
  X_BC.translation().z() += 0.05;
  return X_BC.inverse();
}

/// Largest distance of a corner of the found bin's floor from the nearest true one.
double corners_off(const FoundBin& found, const Cell& cell, const Pose& X_CB) {
  double worst = 0;
  for (int a = 0; a < 4; ++a) {
    const auto corner = [](const Eigen::Vector3d& size, int k) {
      return Eigen::Vector3d(k & 1 ? size.x() / 2 : -size.x() / 2, k & 2 ? size.y() / 2 : -size.y() / 2, 0);
    };
    double nearest = 1e9;
    for (int b = 0; b < 4; ++b)
      nearest = std::min(nearest, (found.X_CB * corner(found.bin.inner_size, a) - X_CB * corner(cell.size, b)).norm());
    worst = std::max(worst, nearest);
  }
  return worst;
}

/// Angle between the found and the true upward direction.
double off_upright(const FoundBin& found, const Pose& X_CB) {
  return std::acos(std::min(1.0, found.X_CB.linear().col(2).dot(X_CB.linear().col(2))));
}

TEST(BinFinder, EmptyBinsOfThreeSizesFromAbove) {
  for (const Eigen::Vector3d& size :
       {Eigen::Vector3d(0.4, 0.3, 0.2), Eigen::Vector3d(0.3, 0.2, 0.12), Eigen::Vector3d(0.6, 0.4, 0.15)}) {
    Cell cell;
    cell.size = size;
    const Pose X_CB = looking_at_bin(0.65, 0, 0.4, 0);
    const auto found = find_bin(drawn(cell, X_CB, Seed{1}), kLargest);
    ASSERT_TRUE(found && found->walls() == 4) << size.transpose();
    EXPECT_FALSE(found->drafted);
    EXPECT_LT(corners_off(*found, cell, X_CB), 0.001) << size.transpose();
    EXPECT_NEAR(found->bin.inner_size.z(), size.z(), 0.007);  // a pixel on a wall seen from above
    EXPECT_NO_THROW(found->bin.validate());
  }
}

TEST(BinFinder, AnyAttitudeOfTheCamera) {
  Rng rng = Seed{2}.rng();
  for (int k = 0; k < 8; ++k) {
    const double tilt = rng.uniform(0, 0.6), heading = rng.uniform(0, 6.3), roll = rng.uniform(0, 6.3);
    const Pose X_CB = looking_at_bin(0.65, tilt, heading, roll);
    const auto found = find_bin(drawn(Cell(), X_CB, Seed{3}.child("k", k)), kLargest);
    ASSERT_TRUE(found) << k << " tilt " << tilt;
    ASSERT_GE(found->walls(), 2) << k << " tilt " << tilt;
    EXPECT_LT(off_upright(*found, X_CB), 0.004) << k;
    // Walls seen from behind are where the others end, which patches tell to two of their size.
    EXPECT_LT(corners_off(*found, Cell(), X_CB), found->walls() == 4 ? 0.0015 : 0.03) << k << " tilt " << tilt;
  }
}

TEST(BinFinder, TurningTheCameraAboutItsAxisTurnsTheBin) {
  const Pose X_CB = looking_at_bin(0.6, 0.2, 0.3, 0);
  const Pose turn = pose_from(exp_so3({0, 0, std::numbers::pi}), Eigen::Vector3d::Zero());
  const auto one = find_bin(drawn(Cell(), X_CB, Seed{4}), kLargest);
  const auto two = find_bin(drawn(Cell(), turn * X_CB, Seed{5}), kLargest);
  ASSERT_TRUE(one && two);
  EXPECT_LT((one->bin.inner_size - two->bin.inner_size).norm(), 0.003);
  EXPECT_LT((turn * one->X_CB.translation() - two->X_CB.translation()).norm(), 0.001);
}

TEST(BinFinder, ASideWithoutAWallIsOpen) {
  Cell cell;
  cell.walls = {true, true, true, false};
  cell.ground = false;
  const Pose X_CB = looking_at_bin(0.6, 0.1, 0.3, 0.2);
  const auto found = find_bin(drawn(cell, X_CB, Seed{6}), kLargest);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->walls(), 3);
  EXPECT_LT(off_upright(*found, X_CB), 0.004);
  // In the true bin's frame the found one spans its length, starts at the wall that is there, and goes on past the end.
  const Eigen::Vector3d half = found->bin.inner_size / 2;
  Eigen::AlignedBox3d span;
  for (int k = 0; k < 4; ++k)
    span.extend(X_CB.inverse() *
                (found->X_CB * Eigen::Vector3d(k & 1 ? half.x() : -half.x(), k & 2 ? half.y() : -half.y(), 0)));
  EXPECT_NEAR(span.min().x(), -0.2, 0.002);
  EXPECT_NEAR(span.max().x(), 0.2, 0.002);
  EXPECT_NEAR(span.min().y(), -0.15, 0.002);
  EXPECT_GT(span.max().y(), 0.15 + 0.5 * kLargest);
}

TEST(BinFinder, WallsMayLeanOutwards) {
  Cell cell;
  cell.lean = 5 * std::numbers::pi / 180;
  const Pose X_CB = looking_at_bin(0.6, 0, 0.3, 0.2);
  Scene scene = drawn(cell, X_CB, Seed{7});
  const auto found = find_bin(scene, kLargest);
  ASSERT_TRUE(found && found->walls() == 4);
  EXPECT_TRUE(found->drafted);
  for (const double slope : found->box.slope) EXPECT_NEAR(slope, std::tan(cell.lean), 0.01);
  const double wider = 2 * cell.size.z() * std::tan(cell.lean);  // at the opening
  for (int k = 0; k < 2; ++k) EXPECT_NEAR(found->bin.inner_size[k], cell.size[k] + wider, 0.004);
  scene.wanted = Image<std::uint8_t>(scene.depth.width(), scene.depth.height(), 1);
  unmark_faces(scene, *found, 0.005);
  int on_walls = 0, left = 0;
  for (int v = 0; v < scene.depth.height(); ++v)
    for (int u = 0; u < scene.depth.width(); ++u) {
      const Eigen::Vector3d p_B = X_CB.inverse() * scene.camera.unproject(u, v, scene.depth(u, v));
      if (!(p_B.z() > 0.02) || !(p_B.z() < 0.19)) continue;
      ++on_walls;
      left += scene.wanted(u, v);
    }
  EXPECT_GT(on_walls, 20000);
  EXPECT_LT(left, on_walls / 200);
}

TEST(BinFinder, ATableIsAFloorWithoutWalls) {
  Cell cell;
  cell.walls = {};
  cell.size = {1.2, 0.9, 0.2};
  cell.ground = false;
  const Pose X_CB = looking_at_bin(0.6, 0.4, 0.3, 0.2);
  const Primitive block = Primitive::box({0.08, 0.05, 0.03}, pose_from(Eigen::Matrix3d::Identity(), {0.05, 0, 0.015}));
  const auto found = find_bin(drawn(cell, X_CB, Seed{8}, {block}), kLargest);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->walls(), 0);
  EXPECT_LT(off_upright(*found, X_CB), 0.004);
  EXPECT_NEAR((X_CB.inverse() * found->X_CB.translation()).z(), 0, 0.001);
}

TEST(BinFinder, AWallBehindATableIsNotWanted) {
  Cell cell;
  cell.walls = {};
  cell.size = {1.2, 0.7, 0.2};
  cell.ground = false;
  const Pose X_CB = looking_at_bin(0.6, 0.4, 0, 0);
  std::vector<Primitive> more;
  for (const double y : {-0.3, 0.3})  // one of them is in view from its front
    more.push_back(Primitive::box({1.2, 0.01, 0.3}, pose_from(Eigen::Matrix3d::Identity(), {0, y, 0.15})));
  more.push_back(Primitive::box({0.08, 0.05, 0.03}, pose_from(Eigen::Matrix3d::Identity(), {0.05, 0, 0.015})));
  const Scene seen = drawn(cell, X_CB, Seed{12}, more);
  SceneView view;
  view.seen = DepthFrame{seen.camera, seen.depth, Pose::Identity(), seen.noise};
  const Scene scene = binpick::make_scene(view, PreprocessConfig(), NormalsConfig(), 0.03, kLargest);
  ASSERT_TRUE(scene.bin);
  int block = 0, on_wall = 0, left = 0;
  for (int v = 0; v < scene.depth.height(); ++v)
    for (int u = 0; u < scene.depth.width(); ++u) {
      const Eigen::Vector3d p_B = X_CB.inverse() * scene.camera.unproject(u, v, scene.depth(u, v));
      const bool wall = std::abs(std::abs(p_B.y()) - 0.295) < 0.004 && p_B.z() > 0.02 && p_B.z() < 0.28;
      on_wall += wall;
      left += wall && scene.wanted(u, v) && !scene.normals(u, v).isZero();  // without a normal it takes no part
      block += scene.wanted(u, v) && std::abs(p_B.x() - 0.05) < 0.05 && std::abs(p_B.y()) < 0.035;
    }
  EXPECT_GT(block, 1000);
  ASSERT_GT(on_wall, 10000);
  EXPECT_LT(left, on_wall / 50);
}

TEST(BinFinder, WhereThereIsNoPlaneNothingIsFound) {
  Scene scene;  // a field of balls, none as large as a part
  ZBuffer buffer(scene.camera);
  Rng rng = Seed{9}.rng();
  for (int k = 0; k < 300; ++k)
    buffer.draw(mesh_of(Primitive::sphere(0.03)),
                pose_from(Eigen::Matrix3d::Identity(),
                          {rng.uniform(-0.4, 0.4), rng.uniform(-0.25, 0.25), rng.uniform(0.5, 0.8)}),
                1);
  scene.depth = buffer.result().depth;  // infinite where nothing is
  scene.noise.constant = 0.0005;
  for (float& z : scene.depth) z = std::isfinite(z) ? z : std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(find_bin(scene, kLargest));
  for (float& z : scene.depth) z = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(find_bin(scene, kLargest));
}

TEST(BinFinder, APlaneNoLargerThanAPartIsNoFloor) {
  Cell cell;
  cell.walls = {};
  cell.size = {0.2, 0.15, 0.2};
  cell.ground = false;
  EXPECT_FALSE(find_bin(drawn(cell, looking_at_bin(0.6, 0.2, 0.3, 0.2), Seed{10}), 0.3));
}

TEST(BinFinder, UnderAHeapAndStereoNoise) {
  for (const Part& part : {ring_part(), bracket_part()})
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const HeapScene made = make_scene(part, HeapOptions(), Seed{seed}, camera_above(0.6));
      Scene scene;
      scene.camera = made.frame.camera;
      scene.depth = made.frame.depth;
      scene.noise = made.frame.noise;
      const auto found = find_bin(scene, part.diameter);
      ASSERT_TRUE(found) << part.name << " seed " << seed;
      EXPECT_EQ(found->walls(), 4);
      EXPECT_LT(corners_off(*found, Cell(), made.view.X_CB), 0.003) << part.name << " seed " << seed;
    }
}

/// Poses without a word of the bin, against those with it.
void expect_same_poses(const HeapScene& made, const Part& part) {
  const auto estimator = make_estimator("ppf");
  estimator->prepare(std::span<const Part>(&part, 1));
  const auto vertices = hull_vertices(part.mesh_P);
  SceneView untold = made.view;
  untold.bin.reset();
  const auto known = estimator->estimate(made.view, Seed{1}).estimates;
  const auto found = estimator->estimate(untold, Seed{1}).estimates;
  ASSERT_FALSE(known.empty());
  std::size_t again = 0;
  for (const PoseEstimate& e : known)
    again += std::any_of(found.begin(), found.end(), [&](const PoseEstimate& f) {
      return mssd(part, e.X_CP, f.X_CP, vertices) < 0.1 * part.diameter;
    });
  EXPECT_GE(again + 1, known.size());
  EXPECT_LE(found.size(), known.size() + 1);
}

TEST(BinFinder, PosesAreThoseOfAKnownBin) {
  HeapScene made = make_scene(ring_part(), HeapOptions(), Seed{11}, camera_above(0.6));
  expect_same_poses(made, ring_part());
  made.view.cloud_noise = made.frame.noise;
  made.view.seen = unproject(made.frame);
  expect_same_poses(made, ring_part());
}

TEST(BinFinder, AnEmptyBinHoldsNoPart) {
  const Part ring = ring_part();
  const auto estimator = make_estimator("ppf");
  estimator->prepare(std::span<const Part>(&ring, 1));
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    HeapScene made = photograph(ring, {}, HeapOptions(), Seed{seed}, camera_above(0.6));
    made.view.bin.reset();
    EXPECT_TRUE(estimator->estimate(made.view, Seed{1}).estimates.empty()) << "seed " << seed;
  }
}

}  // namespace
}  // namespace binpick

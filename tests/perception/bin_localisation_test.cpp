// The bin's pose and the disparity's bias from floor and walls, on heaps whose truth is known.
#include "perception/bin_localisation.hpp"

#include <gtest/gtest.h>

#include "perception/pose_estimator.hpp"
#include "perception/preprocess.hpp"
#include "tests/perception/scene_maker.hpp"

namespace binpick {
namespace {

using namespace testing_scene;

/// What the localisation is given: the frame, and the bin believed `off` metres and as many degrees / 5 mm away.
Scene believed(const HeapScene& made, double off, Seed seed) {
  Scene scene;
  scene.bin = made.view.bin;
  scene.camera = made.frame.camera;
  scene.depth = made.frame.depth;
  scene.noise = made.frame.noise;
  Rng rng = seed.child("bin").rng();
  Vector6d twist;
  twist << off * rng.unit_vector(), off / 0.005 * std::numbers::pi / 180 * rng.unit_vector();
  scene.X_CB = made.view.X_CB * exp_se3(twist);
  return scene;
}

void bend(Scene& scene, const InverseDepthBias& bias) {
  for (int v = 0; v < scene.depth.height(); ++v)
    for (int u = 0; u < scene.depth.width(); ++u)
      scene.depth(u, v) = static_cast<float>(1 / (1 / scene.depth(u, v) + bias.at(scene.camera, u, v)));
}

double millimetres_off(const LocatedBin& found, const HeapScene& made) {
  return 1000 * log_se3(made.view.X_CB.inverse() * found.X_CB).head<3>().norm();
}

double degrees_off(const LocatedBin& found, const HeapScene& made) {
  return angle_between(found.X_CB.linear(), made.view.X_CB.linear()) * 180 / std::numbers::pi;
}

TEST(BinLocalisation, AnEmptyBinWithoutNoiseIsFoundExactly) {
  HeapOptions options;
  options.noise = false;
  const HeapScene made = photograph(ring_part(), {}, options, Seed{1}, camera_above(0.6));
  for (const double off : {0.0, 0.005}) {
    const LocatedBin found = locate_bin(believed(made, off, Seed{2}), {});
    ASSERT_TRUE(found.found);
    EXPECT_LT(millimetres_off(found, made), off > 0 ? 0.3 : 0.05);
    EXPECT_LT(degrees_off(found, made), 0.03);
    EXPECT_LT(std::abs(found.bias.constant) * 360, off > 0 ? 0.2 : 0.05);  // mm at the floor
  }
}

TEST(BinLocalisation, FiveMillimetresAndADegreeOffUnderPartsAndNoise) {
  for (const Part& part : {ring_part(), bracket_part()})
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const HeapScene made = make_scene(part, HeapOptions(), Seed{seed}, camera_above(0.6));
      const LocatedBin found = locate_bin(believed(made, 0.005, Seed{seed}), {});
      ASSERT_TRUE(found.found);
      EXPECT_LT(millimetres_off(found, made), 0.6) << part.name << " seed " << seed;
      EXPECT_LT(degrees_off(found, made), 0.15) << part.name << " seed " << seed;
    }
}

TEST(BinLocalisation, WallsTellABiasFromAHeight) {
  HeapOptions options;
  options.noise = false;
  const HeapScene made = make_scene(ring_part(), options, Seed{4}, camera_above(0.6));
  Scene biased = believed(made, 0, Seed{4});
  bend(biased, {0.01, 0, 0, 0});  // 3.6 mm at the floor
  const LocatedBin a = locate_bin(biased, {});
  EXPECT_NEAR(a.bias.constant, 0.01, 0.0008);
  EXPECT_LT(millimetres_off(a, made), 0.4);
  Scene moved = believed(made, 0, Seed{4});
  moved.X_CB = moved.X_CB * pose_from(exp_so3({0, 0, 0.01}), {0.003, 0.002, 0.004});
  const LocatedBin b = locate_bin(moved, {});
  EXPECT_LT(std::abs(b.bias.constant), 0.0015);
  EXPECT_LT(millimetres_off(b, made), 0.6);
}

TEST(BinLocalisation, ABentBiasIsTakenOffOverTheWholeFloor) {
  const HeapScene made = make_scene(ring_part(), HeapOptions(), Seed{5}, camera_above(0.6));
  SceneView view = made.view;
  Scene bent = believed(made, 0, Seed{5});
  bend(bent, {0.004, 0.002, -0.001, -0.003});
  DepthFrame frame = made.frame;
  frame.depth = bent.depth;
  view.seen = frame;
  const Scene scene = binpick::make_scene(view, PreprocessConfig(), NormalsConfig(), 0.016);
  double sum[4] = {0, 0, 0, 0};
  int count[4] = {0, 0, 0, 0};
  for (int v = 0; v < scene.depth.height(); ++v)
    for (int u = 0; u < scene.depth.width(); ++u) {
      const Eigen::Vector3d p_B = made.view.X_CB.inverse() * scene.camera.unproject(u, v, scene.depth(u, v));
      if (std::abs(p_B.x()) > 0.19 || std::abs(p_B.y()) > 0.14 || !(std::abs(p_B.z()) < 0.005)) continue;
      const int corner = 2 * (p_B.x() > 0) + (p_B.y() > 0);
      sum[corner] += p_B.z();
      ++count[corner];
    }
  for (int k = 0; k < 4; ++k) {
    ASSERT_GT(count[k], 500);
    EXPECT_LT(std::abs(sum[k] / count[k]), 0.0006) << "quarter " << k;
  }
}

TEST(BinLocalisation, ARippleIsTakenOffWhatLiesAboveTheFloor) {
  HeapOptions options;
  options.noise = false;
  const HeapScene made = photograph(ring_part(), {}, options, Seed{7}, camera_above(0.6));
  Scene scene = believed(made, 0, Seed{7});
  scene.noise.focal_baseline = scene.camera.fx * 0.05;
  const double fB = scene.noise.focal_baseline, amplitude = 0.03;
  for (float& z : scene.depth)
    z = static_cast<float>(fB / (fB / z + amplitude * std::sin(2 * std::numbers::pi * fB / z)));
  const LocatedBin found = locate_bin(scene, {});
  ASSERT_TRUE(found.found);
  // Of the seen disparity instead of the true one the wave is a little skewed: 2 pi 0.03 = 19 %.
  EXPECT_NEAR(std::hypot(found.ripple.sine, found.ripple.cosine), amplitude, 0.2 * amplitude);
  for (const double z : {0.598, 0.590, 0.585, 0.55}) {  // heights at which parts lie
    const double seen = fB / (fB / z + amplitude * std::sin(2 * std::numbers::pi * fB / z));
    const double corrected = 1 / (1 / seen - found.ripple.at(seen) - found.bias.constant);
    EXPECT_NEAR(corrected, z, 0.0002) << z;  // 0.5 mm when left in
  }
  Scene without = scene;
  without.noise.focal_baseline = 0;
  EXPECT_TRUE(locate_bin(without, {}).ripple.none());
}

TEST(BinLocalisation, SaysWhenThereIsNothingToGoBy) {
  const HeapScene made = photograph(ring_part(), {}, HeapOptions(), Seed{6}, camera_above(0.6));
  Scene scene = believed(made, 0.002, Seed{6});
  const Pose as_believed = scene.X_CB;
  for (float& z : scene.depth) z = std::numeric_limits<float>::quiet_NaN();
  const LocatedBin found = locate_bin(scene, {});
  EXPECT_FALSE(found.found);
  EXPECT_TRUE(found.X_CB.isApprox(as_believed));
  EXPECT_EQ(found.bias.constant, 0);
}

TEST(BinLocalisation, PosesAreAsGoodWithTheBinBelievedElsewhere) {
  const Part ring = ring_part();
  const auto estimator = make_estimator("ppf");
  estimator->prepare(std::span<const Part>(&ring, 1));
  const auto vertices = hull_vertices(ring.mesh_P);
  HeapScene made = make_scene(ring, HeapOptions(), Seed{7}, camera_above(0.6));
  const auto right = estimator->estimate(made.view, Seed{1}).estimates;
  made.view.X_CB = believed(made, 0.005, Seed{7}).X_CB;
  const auto off = estimator->estimate(made.view, Seed{1}).estimates;
  ASSERT_FALSE(right.empty());
  std::size_t again = 0;
  for (const PoseEstimate& e : right)
    again += std::any_of(off.begin(), off.end(),
                         [&](const PoseEstimate& f) { return mssd(ring, e.X_CP, f.X_CP, vertices) < 0.003; });
  EXPECT_GE(again + 1, right.size());
  EXPECT_LE(off.size(), right.size() + 1);
}

}  // namespace
}  // namespace binpick

// What a refined pose says about its own error: analytic cases, and sheets whose far side is nearer than the near one.
#include "perception/pose_covariance.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "perception/icp.hpp"
#include "perception/noise_correlation.hpp"
#include "perception/part_view.hpp"
#include "perception/preprocess.hpp"
#include "tests/perception/scene_maker.hpp"

namespace binpick {
namespace {

using namespace testing_scene;

/// Information of points on a square of a plane z = 0 about the origin, `sigma` each.
Matrix6d plane_information(double half, int side, double sigma) {
  Matrix6d A = Matrix6d::Zero();
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const Eigen::Vector3d p(half * (2.0 * i / (side - 1) - 1), half * (2.0 * j / (side - 1) - 1), 0), n(0, 0, 1);
      Vector6d a;
      a << n, p.cross(n);
      A += a * a.transpose() / (sigma * sigma);
    }
  return A;
}

TEST(PoseCovariance, APlaneLeavesThreeDegreesOfFreedomOpen) {
  PoseInformation info;
  info.surface = plane_information(0.03, 21, 0.001);
  const Vector6d variance = pose_covariance(info).diagonal();
  const double n = 441, second_moment = 0.03 * 0.03 * 22 / (3.0 * 20);  // of 21 even points on [-1, 1]: (k+1)/(3(k-1))
  EXPECT_NEAR(variance[2], 1e-6 / n, 1e-3 * 1e-6 / n);
  EXPECT_NEAR(variance[3], 1e-6 / (n * second_moment), 1e-2 * 1e-6 / (n * second_moment));
  EXPECT_NEAR(variance[4], variance[3], 1e-6 * variance[3]);
  EXPECT_NEAR(variance[0], 1, 1e-6);  // a metre
  EXPECT_NEAR(variance[1], 1, 1e-6);
  EXPECT_NEAR(variance[5], std::numbers::pi * std::numbers::pi, 1e-4);  // half a turn
}

TEST(PoseCovariance, SharedNoiseWidensWhatIsKnownAndLeavesOpenWhatIsOpen) {
  PoseInformation info;
  info.surface = plane_information(0.03, 21, 0.001);
  const Vector6d alone = pose_covariance(info).diagonal();
  info.surface_variance = 9;
  const Vector6d shared = pose_covariance(info).diagonal();
  EXPECT_NEAR(shared[2] / alone[2], 9, 1e-3);
  EXPECT_NEAR(shared[0], alone[0], 1e-6);
  info.bias << 0, 0, 0.002, 0, 0, 0;
  EXPECT_NEAR(pose_covariance(info)(2, 2), shared[2] + 4e-6, 1e-12);
}

Scene scene_of(const Part& part, const Pose& X_WP, const HeapOptions& options, std::uint64_t seed) {
  const HeapScene photo = photograph(part, {{0, X_WP, 0, 0}}, options, Seed{seed}, camera_above(0.6));
  return binpick::make_scene(photo.view, PreprocessConfig(), NormalsConfig(), 0.004);
}

TEST(PoseCovariance, AShaftWhoseEndsAreCoveredIsOpenAlongItsAxis) {
  const Part shaft = part_from("shaft", mesh_of(Primitive::cylinder(0.0125, 0.12), 48), {});
  const SurfaceModel surface(shaft.mesh_P, 0.02 * shaft.diameter, 0.1 * shaft.diameter);
  HeapOptions options;
  options.noise = false;
  const Pose X_WP = pose_from_xyz_rpy({0, 0, 0.0125}, {0, std::numbers::pi / 2, 0});  // lying along x
  const Pose X_CP = camera_above(0.6).inverse() * X_WP;
  Scene scene = scene_of(shaft, X_WP, options, 1);
  const auto sigmas = [&] {
    const IcpResult fit = refine_pose(scene, surface, X_CP, IcpConfig(), IcpStage::kFine);
    EXPECT_GT(fit.points, 50);
    return Vector6d(fit.covariance.diagonal().cwiseSqrt());
  };
  EXPECT_LT(sigmas()[2], 0.001);  // the ends show: along the axis, z of P
  for (int v = 0; v < scene.depth.height(); ++v)
    for (int u = 0; u < scene.depth.width(); ++u)
      if (std::abs(scene.point(u, v, 0.57f).x()) > 0.03f) scene.depth(u, v) = 0.5f, scene.wanted(u, v) = 0;
  const Vector6d covered = sigmas();
  EXPECT_GT(covered[2], 0.02);
  EXPECT_LT(covered[0], 0.001);
  EXPECT_LT(covered[1], 0.002);
}

TEST(Icp, ASheetIsFoundFromBeyondItsMiddle) {
  // 4 mm too deep or too high in a plate of 6 mm: the nearest point is on the side that nobody sees.
  const Part plate = part_from("plate", mesh_of(Primitive::box({0.1, 0.06, 0.006})), {});
  const SurfaceModel surface(plate.mesh_P, 0.02 * plate.diameter, 0.1 * plate.diameter);
  HeapOptions options;
  options.noise = false;
  const Pose X_WP = pose_from_xyz_rpy({0.02, 0.01, 0.02}, {0, 0, 0.4}), X_CP = camera_above(0.6).inverse() * X_WP;
  const Scene scene = scene_of(plate, X_WP, options, 1);
  for (const double off : {-0.005, -0.004, 0.004, 0.005}) {
    Pose start = X_CP;
    start.translation().z() += off;
    const IcpResult fit = refine_pose(scene, surface, start, IcpConfig(), IcpStage::kCoarse);
    EXPECT_LT(std::abs((fit.X_CP.translation() - X_CP.translation()).z()), 0.0003) << off;
  }
}

TEST(NoiseCorrelation, TellsWindowsFromWhiteNoise) {
  const Part part = ring_part();
  const Pose X_WP = pose_from_xyz_rpy({0, 0, 0.008}, {0, 0, 0});
  HeapOptions options;
  EXPECT_NEAR(pixels_per_noise_value(scene_of(part, X_WP, options, 3)), 4 * std::numbers::pi * 2.5 * 2.5, 45);
  options.noise = false;
  HeapScene photo = photograph(part, {{0, X_WP, 0, 0}}, options, Seed{3}, camera_above(0.6));
  Rng rng = Seed{5}.rng();
  for (float& z : photo.frame.depth) z += static_cast<float>(0.0005 * rng.normal());
  photo.view.seen = photo.frame;
  EXPECT_LT(pixels_per_noise_value(binpick::make_scene(photo.view, PreprocessConfig(), NormalsConfig(), 0.016)), 8);
}

TEST(PartView, GrowsByWholePixelsAndClosesNarrowGaps) {
  PartView view;
  view.u0 = 10, view.v0 = 20;
  view.depth = Image<float>(12, 9, std::numeric_limits<float>::infinity());
  for (int v = 2; v < 7; ++v)
    for (int u = 2; u < 10; ++u)
      if (u != 5) view.depth(u, v) = u < 5 ? 0.5f : 0.4f;  // a slit of one pixel
  const PartView wide = grown(view, 1);
  for (int v = 18; v < 32; ++v)
    for (int u = 8; u < 26; ++u)
      EXPECT_EQ(wide.inside(u, v), u >= 11 && u <= 20 && v >= 21 && v <= 27) << u << ' ' << v;
  EXPECT_EQ(wide.at(15, 24), 0.4f);  // the nearer side fills the slit
  EXPECT_EQ(wide.at(11, 24), 0.5f);
}

}  // namespace
}  // namespace binpick

#include "perception/preprocess.hpp"

#include <gtest/gtest.h>

#include "perception/floor_offset.hpp"
#include "tests/perception/scene_maker.hpp"

namespace binpick {
namespace {

using namespace testing_scene;

/// A scene that is one plane n . p = distance seen by a small camera.
Scene plane_scene(const Eigen::Vector3d& normal, double distance) {
  Scene scene;
  scene.camera.width = scene.camera.height = 120;
  scene.camera.cx = scene.camera.cy = 59.5;
  scene.depth = Image<float>(120, 120);
  scene.wanted = Image<std::uint8_t>(120, 120, 1);
  scene.normals = Image<Eigen::Vector3f>(120, 120, Eigen::Vector3f::Zero());
  for (int v = 0; v < 120; ++v)
    for (int u = 0; u < 120; ++u) scene.depth(u, v) = static_cast<float>(distance / normal.dot(scene.camera.ray(u, v)));
  return scene;
}

double degrees_between(const Eigen::Vector3f& a, const Eigen::Vector3d& b) {
  return std::acos(std::clamp(a.cast<double>().dot(b), -1.0, 1.0)) * 180 / std::numbers::pi;
}

TEST(Normals, OfAPlaneAreItsNormalTowardsTheCamera) {
  for (const Eigen::Vector3d& n : {Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(0.5, 0.2, -1).normalized()}) {
    Scene scene = plane_scene(n, n.z() * 0.6);
    estimate_normals(scene, NormalsConfig());
    for (int v = 20; v < 100; ++v)
      for (int u = 20; u < 100; ++u) ASSERT_LT(degrees_between(scene.normals(u, v), n), 0.5) << u << " " << v;
  }
}

TEST(Normals, OfASphereAreRadial) {
  Scene scene = plane_scene({0, 0, -1}, -0.8);
  const Eigen::Vector3d center(0, 0, 0.6);
  const double radius = 0.05;
  for (int v = 0; v < 120; ++v)
    for (int u = 0; u < 120; ++u) {
      const Eigen::Vector3d ray = scene.camera.ray(u, v);
      const double b = ray.dot(center),
                   discriminant = b * b - ray.squaredNorm() * (center.squaredNorm() - radius * radius);
      if (discriminant > 0) scene.depth(u, v) = static_cast<float>((b - std::sqrt(discriminant)) / ray.squaredNorm());
    }
  estimate_normals(scene, NormalsConfig());
  for (int v = 45; v < 75; ++v)
    for (int u = 45; u < 75; ++u) {  // the middle, where no window reaches the rim
      const Eigen::Vector3d n = (scene.point(u, v, scene.depth(u, v)).cast<double>() - center).normalized();
      ASSERT_LT(degrees_between(scene.normals(u, v), n), 2) << u << " " << v;
    }
}

TEST(Normals, OfACylinderAreRadial) {
  Scene scene = plane_scene({0, 0, -1}, -0.8);
  const double radius = 0.04, z = 0.6;  // along y
  for (int v = 0; v < 120; ++v)
    for (int u = 0; u < 120; ++u) {
      const Eigen::Vector3d ray = scene.camera.ray(u, v);
      const double a = ray.x() * ray.x() + 1, discriminant = z * z - a * (z * z - radius * radius);
      if (discriminant > 0) scene.depth(u, v) = static_cast<float>((z - std::sqrt(discriminant)) / a);
    }
  estimate_normals(scene, NormalsConfig());
  for (int v = 20; v < 100; ++v)
    for (int u = 48; u < 72; ++u) {
      const Eigen::Vector3d p = scene.point(u, v, scene.depth(u, v)).cast<double>();
      ASSERT_LT(degrees_between(scene.normals(u, v), Eigen::Vector3d(p.x(), 0, p.z() - z).normalized()), 2) << u;
    }
}

TEST(Normals, DoNotFeelTheFarSideOfAStep) {
  const Eigen::Vector3d near = Eigen::Vector3d(0.3, -0.1, -1).normalized(), far(0, 0, -1);
  Scene scene = plane_scene(near, near.z() * 0.5);
  const Scene behind = plane_scene(far, -0.65);
  for (int v = 0; v < 120; ++v)
    for (int u = 0; u < 120; ++u) {
      if (u >= 60) scene.depth(u, v) = behind.depth(u, v);
      if (u % 17 == 0 && v % 3 == 0) scene.depth(u, v) = std::nanf("");  // and holes
    }
  const Image<float> depth = scene.depth;
  for (std::size_t i = 0; i < depth.size(); ++i) scene.wanted[i] = depth[i] > 0;
  NormalsConfig config;
  config.agreement = 3.1;  // nothing is dropped
  estimate_normals(scene, config);
  for (int v = 0; v < 120; ++v)
    for (int u = 0; u < 120; ++u) {
      if (!scene.wanted(u, v)) {
        ASSERT_TRUE(scene.normals(u, v).isZero()) << u << " " << v;
        continue;
      }
      ASSERT_LT(degrees_between(scene.normals(u, v), u < 60 ? near : far), 0.5) << u << " " << v;
    }
}

TEST(Normals, KeepTheNoiseOfThePlaneFitOnly) {
  // Even noise in inverse depth on a tilted plane: the regression is unbiased, so the mean normal is the plane's.
  const Eigen::Vector3d n = Eigen::Vector3d(0.5, 0.3, -1).normalized();
  Scene scene = plane_scene(n, n.z() * 0.5);
  scene.noise.constant = 0.001;
  Rng rng(4);
  for (float& z : scene.depth) z = static_cast<float>(1 / (1 / z + 0.003 * rng.normal()));
  estimate_normals(scene, NormalsConfig());
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  for (int v = 10; v < 110; ++v)
    for (int u = 10; u < 110; ++u) mean += scene.normals(u, v);
  EXPECT_LT(degrees_between(mean.normalized(), n), 0.5);
}

TEST(Normals, AreTheSameBitsOnAnyNumberOfThreads) {
  const HeapScene photo = testing_scene::make_scene(ring_part(), HeapOptions(), Seed{3}, camera_above(0.6));
  SceneView view = photo.view;
  const Scene one = make_scene(view, PreprocessConfig(), NormalsConfig(), 0.016);
  for (const int threads : {2, 3}) {
    view.threads = threads;
    const Scene more = make_scene(view, PreprocessConfig(), NormalsConfig(), 0.016);
    ASSERT_EQ(more.normals.size(), one.normals.size());
    for (std::size_t i = 0; i < one.normals.size(); ++i) ASSERT_TRUE(more.normals[i] == one.normals[i]) << i;
  }
}

TEST(Normals, ThatDisagreeWithTheirNeighboursAreDropped) {
  Scene scene = plane_scene({0, 0, -1}, -0.6);
  estimate_normals(scene, NormalsConfig());
  scene.normals(60, 60) = Eigen::Vector3f(1, 0, -1).normalized();  // 45 degrees off, paper eq. 3
  drop_disagreeing_normals(scene, NormalsConfig());
  EXPECT_TRUE(scene.normals(60, 60).isZero());
  EXPECT_FALSE(scene.normals(50, 50).isZero());
}

TEST(Normals, OfACloudComeFromTheSamePlane) {
  const Eigen::Vector3d n = Eigen::Vector3d(0.3, 0.1, -1).normalized();
  const Scene scene = plane_scene(n, n.z() * 0.6);
  PointCloud cloud;
  for (int v = 0; v < 120; v += 2)
    for (int u = 0; u < 120; u += 2) cloud.points.push_back(scene.camera.unproject(u, v, scene.depth(u, v)));
  for (const Eigen::Vector3d& m : cloud_normals(cloud, 0.008)) ASSERT_LT(degrees_between(m.cast<float>(), n), 0.5);
  EXPECT_NEAR(median_spacing(cloud), 2 * 0.6 / scene.camera.fx, 0.0004);
}

TEST(VoxelGrid, KeepsBothSidesOfAThinPlate) {
  PointCloud plate;
  for (int i = 0; i < 20; ++i)
    for (const double side : {1.0, -1.0}) {
      plate.points.emplace_back(0.0005 * i + 1e-5, 1e-4, 0.001 + 0.0004 * side);
      plate.normals.emplace_back(0, 0, side);
    }
  const PointCloud grid = voxel_grid(plate, 0.01);  // all in one voxel
  ASSERT_EQ(grid.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(grid.points[i].z(), 0.001 + 0.0004 * grid.normals[i].z(), 1e-7);
    EXPECT_NEAR(grid.points[i].x(), 0.00476, 1e-5);
  }
}

TEST(Preprocess, RemovesFloorAndWallsButNotThePartLyingFlat) {
  HeapOptions options;
  options.noise = false;
  const Part plate = part_from("plate", mesh_of(Primitive::box({0.08, 0.05, 0.006})), {});
  const Pose X_WP = pose_from(Eigen::Matrix3d::Identity(), {0.03, 0.02, 0.003});
  const HeapScene photo = photograph(plate, {{0, X_WP, 0, 0}}, options, Seed{1}, camera_above(0.6));
  const Scene scene = make_scene(photo.view, PreprocessConfig(), NormalsConfig(), 0.006);
  int wanted = 0;
  for (std::size_t i = 0; i < scene.wanted.size(); ++i) wanted += scene.wanted[i];
  EXPECT_EQ(wanted, photo.instances[0].visible_pixels);  // its top face and nothing else
}

TEST(Preprocess, RemovesLeaningWallsAndDividersButNotThePartsBeside) {
  HeapOptions options;
  options.noise = false;
  options.draft = 0.12;
  options.dividers_x = {-0.05};
  const Part plate = part_from("plate", mesh_of(Primitive::box({0.08, 0.05, 0.006})), {});
  // One lies flat on the floor, one high beside the rim, over no floor.
  const std::vector<Instance> places = {
      {0, pose_from(Eigen::Matrix3d::Identity(), {0.03, 0.02, 0.003}), 0, 0},
      {0, pose_from(Eigen::Matrix3d::Identity(), {0.165, -0.1, 0.18}), 0, 0},
  };
  const HeapScene photo = photograph(plate, places, options, Seed{1}, camera_above(0.6));
  const Scene scene = make_scene(photo.view, PreprocessConfig(), NormalsConfig(), 0.006);
  int wanted = 0;
  for (std::size_t i = 0; i < scene.wanted.size(); ++i) wanted += scene.wanted[i];
  EXPECT_EQ(wanted, photo.instances[0].visible_pixels + photo.instances[1].visible_pixels);
}

TEST(FloorOffset, IsReadOffTheVisibleFloor) {
  for (const double bias_px : {-0.25, 0.0, 0.25})
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      HeapOptions options;
      const Part ring = ring_part();
      HeapScene photo = make_scene(ring, options, Seed{seed}, camera_above(0.6));
      const double focal_baseline = photo.frame.camera.fx * 0.05;
      const double drawn = options.bias_px * Seed{seed}.child("noise").child("bias").rng().normal();
      DepthFrame frame = photo.frame;
      for (float& z : frame.depth) z = static_cast<float>(1 / (1 / z + bias_px / focal_baseline));
      photo.view.seen = frame;
      const Scene scene = make_scene(photo.view, PreprocessConfig(), NormalsConfig(), 0.016);
      EXPECT_NEAR(scene.floor_offset * focal_baseline, bias_px + drawn, 0.03) << "seed " << seed << " bias " << bias_px;
    }
}

TEST(FloorOffset, IsZeroWhereNoFloorShows) {
  HeapOptions options;
  options.noise = false;
  const Part slab = part_from("slab", mesh_of(Primitive::box({0.39, 0.29, 0.05})), {});
  const Pose X_WP = pose_from(Eigen::Matrix3d::Identity(), {0, 0, 0.025});
  HeapScene photo = photograph(slab, {{0, X_WP, 0, 0}}, options, Seed{1}, camera_above(0.6));
  EXPECT_EQ(make_scene(photo.view, PreprocessConfig(), NormalsConfig(), 0.05).floor_offset, 0);
}

TEST(Preprocess, AnEmptyOrBrokenFrameIsAnEmptyScene) {
  SceneView view;
  DepthFrame frame;
  frame.depth = Image<float>(frame.camera.width, frame.camera.height, std::numeric_limits<float>::infinity());
  frame.depth(3, 3) = -1, frame.depth(4, 4) = 0;
  view.seen = frame;
  const Scene scene = make_scene(view, PreprocessConfig(), NormalsConfig(), 0.01);
  EXPECT_EQ(voxel_grid(scene, 0.004).size(), 0u);
  view.seen = PointCloud();
  EXPECT_EQ(voxel_grid(make_scene(view, PreprocessConfig(), NormalsConfig(), 0.01), 0.004).size(), 0u);
}

}  // namespace
}  // namespace binpick

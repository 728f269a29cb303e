// A rendered plate is found, and its pose is the one it was drawn at.
#include "trials/calibration/marker_plate.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "core/primitive.hpp"
#include "core/random.hpp"
#include "sim/grey_image.hpp"

namespace binpick {
namespace {

const PinholeCamera kCamera{1280, 960, 920, 920, 639.5, 479.5};

/// Faces the camera, tilted by `tilt` about its x.
Pose before_camera(double distance, double tilt) {
  return pose_from(Eigen::AngleAxisd(std::numbers::pi - tilt, Eigen::Vector3d::UnitX()).toRotationMatrix(),
                   {0.02, -0.03, distance});
}

TEST(MarkerPlate, PoseOfExactCornersIsExact) {
  const MarkerPlate plate;
  LensDistortion lens;
  lens.k1 = -0.05, lens.p1 = 0.001;
  for (const double tilt : {0.0, 0.3, -0.6}) {
    const Pose X_CQ = before_camera(0.6, tilt);
    const std::vector<SeenCorner> corners = projected_corners(plate, X_CQ, kCamera, lens);
    ASSERT_EQ(corners.size(), 16u);
    const std::optional<Pose> found = plate_pose(corners, plate, kCamera, lens);
    ASSERT_TRUE(found);
    EXPECT_LT(distance_between(*found, X_CQ), 1e-7);
    EXPECT_LT(angle_between(found->linear(), X_CQ.linear()), 1e-6);
  }
}

TEST(MarkerPlate, CornersOutsideTheImageAreLeftOut) {
  const MarkerPlate plate;
  Pose X_CQ = before_camera(0.6, 0.2);
  X_CQ.translation().x() += 0.42;  // 644 px to the right
  const std::vector<SeenCorner> corners = projected_corners(plate, X_CQ, kCamera);
  EXPECT_LT(corners.size(), 16u);
  EXPECT_FALSE(plate_pose({}, plate, kCamera));
}

TEST(MarkerPlate, ARenderedPlateIsFoundToFractionsOfAPixel) {
  const MarkerPlate plate;
  const Pose X_CQ = before_camera(0.5, 0.4), X_WC = pose_from_xyz_rpy({0, 0, 1}, {std::numbers::pi, 0, 0});
  RenderScene scene;
  RenderItem item;
  item.mesh_O = std::make_shared<const TriangleMesh>(
      mesh_of(Primitive::box({plate.edge(), plate.edge(), 0.004}, Pose(Eigen::Translation3d(0, 0, -0.002)))));
  item.X_WO = X_WC * X_CQ;
  item.id = 1100;
  item.texture = std::make_shared<const SurfaceTexture>(plate.texture());
  scene.items.push_back(item);
  const std::unique_ptr<DepthRenderer> renderer = make_renderer("osmesa");
  GreyCamera camera;
  camera.intrinsics = kCamera;
  camera.X_WC = X_WC;
  const Image<std::uint8_t> image = capture_grey(*renderer, scene, camera, {}, Seed{5});
  const std::vector<SeenCorner> seen = find_corners(image, plate), drawn = projected_corners(plate, X_CQ, kCamera);
  ASSERT_EQ(seen.size(), 16u);
  double squares = 0;
  for (const SeenCorner& corner : seen) {
    const Eigen::Vector2d off = corner.pixel - drawn[corner.index].pixel;
    EXPECT_LT(off.norm(), 0.5) << corner.index;
    squares += off.squaredNorm() / 32;
  }
  EXPECT_LT(std::sqrt(squares), 0.3);  // px along an axis: 0.1 to 0.3 is usual for refined ArUco corners
  const std::optional<Pose> found = plate_pose(seen, plate, kCamera);
  ASSERT_TRUE(found);
  EXPECT_LT(distance_between(*found, X_CQ), 2e-3);
  EXPECT_LT(angle_between(found->linear(), X_CQ.linear()), 0.02);
}

}  // namespace
}  // namespace binpick

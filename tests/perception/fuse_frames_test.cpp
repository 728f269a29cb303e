// Two views of a box: where its points lie, which of its faces are seen, where normals point.

#include "perception/fuse_frames.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "core/primitive.hpp"
#include "core/zbuffer.hpp"

namespace binpick {
namespace {

const Eigen::Vector3d kEdges(0.10, 0.08, 0.06);  // m, box at the world's origin

Pose looking_at_origin(const Eigen::Vector3d& eye_W) {
  Pose X_WC = Pose::Identity();
  X_WC.linear() = rotation_with_z(-eye_W.normalized());
  X_WC.translation() = eye_W;
  return X_WC;
}

DepthFrame view_of_box(const Pose& X_WC) {
  DepthFrame frame;
  frame.camera = {320, 240, 400, 400, 159.5, 119.5};
  frame.X_WC = X_WC;
  ZBuffer buffer(frame.camera);
  buffer.draw(mesh_of(Primitive::box(kEdges)), X_WC.inverse(), 0);
  frame.depth = buffer.result().depth;
  for (float& z : frame.depth)
    if (!std::isfinite(z)) z = std::numeric_limits<float>::quiet_NaN();
  return frame;
}

/// Faces +x -x +y -y +z -z of the box with at least 100 points of the cloud well inside them.
int faces_seen(const PointCloud& cloud_C, const Pose& X_WC) {
  std::array<int, 6> count = {};
  for (const Eigen::Vector3d& p_C : cloud_C.points) {
    const Eigen::Array3d p = (X_WC * p_C).array() / (0.5 * kEdges.array());
    Eigen::Index k = 0;
    p.abs().maxCoeff(&k);
    const auto face = static_cast<std::size_t>(2 * k + (p[k] < 0));
    Eigen::Array3d inside = p.abs();
    inside[k] = 0;
    count[face] += inside.maxCoeff() < 0.9;
  }
  int faces = 0;
  for (const int n : count) faces += n >= 100;
  return faces;
}

TEST(FuseFrames, TwoViewsShowMoreFacesThanOne) {
  const DepthFrame above = view_of_box(looking_at_origin({0, 0, 0.5}));
  const DepthFrame corner = view_of_box(looking_at_origin({0.35, 0.3, 0.3}));
  const DepthFrame behind = view_of_box(looking_at_origin({-0.4, -0.3, 0.2}));
  EXPECT_EQ(faces_seen(fuse_frames(std::array{above}, {}), above.X_WC), 1);
  EXPECT_EQ(faces_seen(fuse_frames(std::array{corner}, {}), corner.X_WC), 3);
  EXPECT_EQ(faces_seen(fuse_frames(std::array{above, corner}, {}), above.X_WC), 3);
  EXPECT_EQ(faces_seen(fuse_frames(std::array{corner, behind}, {}), corner.X_WC), 5);
}

TEST(FuseFrames, EveryPointLiesOnTheBoxAndItsNormalLooksOut) {
  const DepthFrame first = view_of_box(looking_at_origin({0.35, 0.3, 0.3}));
  const DepthFrame second = view_of_box(looking_at_origin({-0.4, -0.3, 0.2}));
  const PointCloud cloud_C = fuse_frames(std::array{first, second}, {});
  ASSERT_TRUE(cloud_C.has_normals());
  const Pose X_WC = first.X_WC;
  std::size_t normals = 0;
  for (std::size_t i = 0; i < cloud_C.size(); ++i) {
    const Eigen::Vector3d p = X_WC * cloud_C.points[i], n = X_WC.linear() * cloud_C.normals[i];
    ASSERT_NEAR((p.cwiseAbs() - 0.5 * kEdges).maxCoeff(), 0, 1e-5);
    if (n.isZero()) continue;
    ++normals;
    ASSERT_NEAR(n.norm(), 1, 1e-5);
    ASSERT_GT(n.dot(p), 0);  // out of a box that holds the origin
  }
  EXPECT_GT(normals, cloud_C.size() * 9 / 10);
}

TEST(FuseFrames, OneFrameIsItsOwnCloud) {
  const DepthFrame frame = view_of_box(looking_at_origin({0.35, 0.3, 0.3}));
  const PointCloud own = cloud_with_normals(frame, {}), fused = fuse_frames(std::array{frame}, {});
  ASSERT_EQ(own.size(), fused.size());
  for (std::size_t i = 0; i < own.size(); ++i) EXPECT_LT((own.points[i] - fused.points[i]).norm(), 1e-7);
}

// Camera 2 measures all disparities 2 px too small; the floor it sees tells, and the floors of both meet.
TEST(FuseFrames, AKnownBinRemovesEachCamerasOffset) {
  const KnownBin bin;
  const Pose X_WC = looking_at_origin({0, 0, 0.6});
  DepthFrame good;
  good.camera = {320, 240, 300, 300, 159.5, 119.5};
  good.X_WC = X_WC;
  good.noise = {0, 0, 0.003, 0};
  good.depth = Image<float>(320, 240, 0.6f);
  DepthFrame off = good;
  for (float& z : off.depth) z = 1 / (1 / z - 0.01f);  // 3.6 mm too far
  const auto height = [&](const PointCloud& cloud_C) {
    double sum = 0;
    for (const Eigen::Vector3d& p_C : cloud_C.points) sum += (X_WC * p_C).z();
    return sum / static_cast<double>(cloud_C.size());
  };
  EXPECT_NEAR(height(fuse_frames(std::array{off}, {})), -0.0036, 1e-4);
  EXPECT_NEAR(height(fuse_frames(std::array{off}, {}, bin)), 0, 1e-4);
  EXPECT_NEAR(height(fuse_frames(std::array{good, off}, {}, bin)), 0, 1e-4);
}

}  // namespace
}  // namespace binpick

// ZBuffer against geometry that is known on paper: planes, slopes, a sphere, shared edges, the near plane.
#include "core/zbuffer.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace binpick {
namespace {

PinholeCamera small_camera() {
  PinholeCamera camera;
  camera.width = 160;
  camera.height = 120;
  camera.fx = 150;
  camera.fy = 140;
  camera.cx = 71.3;  // off-centre on purpose
  camera.cy = 64.8;
  return camera;
}

// A quadrilateral through four points, two triangles.
TriangleMesh quad(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                  const Eigen::Vector3d& d) {
  return {{a, b, c, d}, {{0, 1, 2}, {0, 2, 3}}};
}

// The plane n . p = distance as a quadrilateral that reaches beyond the image.
TriangleMesh wide_plane(const Eigen::Vector3d& normal, double distance, double reach) {
  const Eigen::Vector3d n = normal.normalized();
  const Eigen::Vector3d x = n.cross(Eigen::Vector3d::UnitY()).normalized();
  const Eigen::Vector3d y = n.cross(x);
  const Eigen::Vector3d o = n * distance;
  return quad(o - reach * x - reach * y, o + reach * x - reach * y, o + reach * x + reach * y,
              o - reach * x + reach * y);
}

TriangleMesh sphere(double radius, int rings) {
  TriangleMesh mesh;
  const auto ring_point = [&](int i, int j) {
    const double polar = M_PI * i / rings, around = M_PI * j / rings;
    return Eigen::Vector3d(radius * std::sin(polar) * std::cos(around), radius * std::sin(polar) * std::sin(around),
                           radius * std::cos(polar));
  };
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j < 2 * rings; ++j) mesh.vertices.push_back(ring_point(i, j));
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * 2 * rings + j % (2 * rings)); };
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < 2 * rings; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

TEST(ZBuffer, TiltedPlaneIsExactAtEveryPixel) {
  const PinholeCamera camera = small_camera();
  const Eigen::Vector3d normal = Eigen::Vector3d(0.5, -0.3, -1).normalized();
  ZBuffer buffer(camera);
  buffer.draw(wide_plane(normal, -0.7, 3.0), Pose::Identity(), 4);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const double z = -0.7 / normal.dot(camera.ray(u, v));
      ASSERT_NEAR(buffer.result().depth(u, v), z, 1e-6) << u << "," << v;
      ASSERT_EQ(buffer.result().ids(u, v), 4);
    }
}

TEST(ZBuffer, PixelCentresAreIntegers) {
  PinholeCamera camera = small_camera();
  camera.fx = camera.fy = 100;
  camera.cx = 80;
  camera.cy = 60;
  ZBuffer buffer(camera);
  // At z = 1 the square spans u in [70, 90], v in [50, 70]: the left and upper borders belong to it, the others do not.
  buffer.draw(quad({-0.1, -0.1, 1}, {0.1, -0.1, 1}, {0.1, 0.1, 1}, {-0.1, 0.1, 1}), Pose::Identity(), 1);
  int count = 0;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const bool inside = u >= 70 && u < 90 && v >= 50 && v < 70;
      count += buffer.result().ids(u, v) == 1;
      if (u == 70 || u == 90 || v == 50 || v == 70) continue;
      ASSERT_EQ(buffer.result().ids(u, v) == 1, inside) << u << "," << v;
    }
  EXPECT_EQ(count, 400);
  EXPECT_EQ(buffer.dirty().width(), 20);
  EXPECT_EQ(buffer.dirty().height(), 20);
}

TEST(ZBuffer, SphereDepthAndArea) {
  const PinholeCamera camera = small_camera();
  const double radius = 0.1;
  const Eigen::Vector3d centre(0.03, -0.02, 0.6);
  Pose X_CO = Pose::Identity();
  X_CO.translation() = centre;
  ZBuffer buffer(camera);
  buffer.draw(sphere(radius, 200), X_CO, 0);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector3d ray = camera.ray(u, v);
      const double a = ray.squaredNorm(), b = ray.dot(centre), c = centre.squaredNorm() - radius * radius;
      const double discriminant = b * b - a * c;
      // Off the outline by more than the facets' sagitta (0.012 % of the radius), depth is known within it.
      if (discriminant > 2e-4) {
        ASSERT_NEAR(buffer.result().depth(u, v), (b - std::sqrt(discriminant)) / a, 1e-4);
      }
      if (discriminant < -2e-6) {
        ASSERT_TRUE(std::isinf(buffer.result().depth(u, v)));
      }
    }
}

// A pixel in two neighbours or in neither would show as a count other than one.
TEST(ZBuffer, NeighboursNeitherOverlapNorLeaveGaps) {
  const PinholeCamera camera = small_camera();
  const Eigen::Vector3d hub(0.013, 0.007, 1);
  std::vector<Eigen::Vector3d> rim;
  for (int i = 0; i < 97; ++i) rim.emplace_back(2 * std::cos(2 * M_PI * i / 97), 2 * std::sin(2 * M_PI * i / 97), 1.0);
  Image<int> hits(camera.width, camera.height, 0);
  for (std::size_t i = 0; i < rim.size(); ++i) {
    ZBuffer one(camera);
    one.draw({{hub, rim[i], rim[(i + 1) % rim.size()]}, {{0, 1, 2}}}, Pose::Identity(), 1);
    for (std::size_t k = 0; k < hits.size(); ++k) hits[k] += one.result().ids[k] == 1;
  }
  for (std::size_t k = 0; k < hits.size(); ++k) ASSERT_EQ(hits[k], 1) << "pixel " << k;
}

TEST(ZBuffer, NearestWinsAndEqualDepthKeepsTheEarlier) {
  const PinholeCamera camera = small_camera();
  ZBuffer buffer(camera);
  const TriangleMesh far_wall = wide_plane({0, 0, 1}, 1.0, 2.0);
  const TriangleMesh near_wall = wide_plane({0, 0, 1}, 0.5, 2.0);
  buffer.draw(far_wall, Pose::Identity(), 1);
  buffer.draw(near_wall, Pose::Identity(), 2);
  buffer.draw(far_wall, Pose::Identity(), 3);
  buffer.draw(near_wall, Pose::Identity(), 4);
  for (const std::int32_t id : buffer.result().ids) ASSERT_EQ(id, 2);
}

TEST(ZBuffer, TriangleThroughTheNearPlaneIsClipped) {
  const PinholeCamera camera = small_camera();
  const double near = 0.2;
  ZBuffer buffer(camera, near);
  // The floor y = 0.1 under the camera, from behind it to far in front: z = 0.1 / ray.y.
  buffer.draw(quad({-50, 0.1, -5}, {50, 0.1, -5}, {50, 0.1, 50}, {-50, 0.1, 50}), Pose::Identity(), 7);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const double down = camera.ray(u, v).y();
      const double z = 0.1 / down;
      const bool visible = down > 0 && z < 50 && z > near;
      if (std::abs(down - 0.1 / 50) < 1e-2 || std::abs(z - near) < 2e-3) continue;  // the border rows themselves
      ASSERT_EQ(buffer.result().ids(u, v) == 7, visible) << u << "," << v;
      if (visible) {
        ASSERT_NEAR(buffer.result().depth(u, v), z, 1e-6 * z * z + 1e-6);
      }
    }
  buffer.clear();
  buffer.draw(wide_plane({0, 0, 1}, 0.199, 2.0), Pose::Identity(), 1);
  EXPECT_TRUE(buffer.dirty().empty());
}

TEST(ZBuffer, WindowEqualsTheSameCutOfTheWholeImage) {
  const PinholeCamera camera = small_camera();
  Pose X_CO = Pose::Identity();
  X_CO.translation() = Eigen::Vector3d(0, 0, 0.5);
  const TriangleMesh ball = sphere(0.15, 30);
  ZBuffer whole(camera), part(camera);
  whole.draw(ball, X_CO, 1);
  const PixelRect window{40, 30, 90, 70};
  part.restrict_to(window);
  part.draw(ball, X_CO, 1);
  EXPECT_EQ(part.dirty(), window);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const bool inside = u >= window.u0 && u < window.u1 && v >= window.v0 && v < window.v1;
      ASSERT_EQ(part.result().ids(u, v), inside ? whole.result().ids(u, v) : -1);
      if (inside) {
        ASSERT_EQ(part.result().depth(u, v), whole.result().depth(u, v));
      }
    }
  part.clear();
  EXPECT_TRUE(part.dirty().empty());
  for (const std::int32_t id : part.result().ids) ASSERT_EQ(id, -1);
}

TEST(ZBuffer, BehindTheCameraOrOutsideDrawsNothing) {
  ZBuffer buffer(small_camera());
  buffer.draw(wide_plane({0, 0, 1}, -0.5, 2.0), Pose::Identity(), 1);
  Pose aside = Pose::Identity();
  aside.translation() = Eigen::Vector3d(100, 0, 0.5);
  buffer.draw(sphere(0.1, 8), aside, 2);
  const double nan = std::nan("");
  buffer.draw({{{nan, 0, 1}, {0, nan, 1}, {1, 1, 1}}, {{0, 1, 2}}}, Pose::Identity(), 3);
  EXPECT_TRUE(buffer.dirty().empty());
}

}  // namespace
}  // namespace binpick

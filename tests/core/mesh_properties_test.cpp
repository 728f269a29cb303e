#include "core/mesh_properties.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/convex_hull.hpp"
#include "core/primitive.hpp"
#include "core/random.hpp"
#include "core/sample_surface.hpp"

namespace binpick {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TriangleMesh box(double x, double y, double z) { return mesh_of(Primitive::box({x, y, z})); }

/// Ring of rectangular section about z with n facets, vertices on the true radii; closed, with a hole.
TriangleMesh ring(double inner, double outer, double height, int n) {
  TriangleMesh mesh;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * kPi * i / n;
    for (const double r : {inner, outer}) {
      for (const double z : {-height / 2, height / 2})
        mesh.vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
  }
  const auto quad = [&](int a, int b, int c, int d) {
    const auto id = [&](int v) { return static_cast<std::uint32_t>(v % (4 * n)); };
    mesh.triangles.push_back({id(a), id(b), id(c)});
    mesh.triangles.push_back({id(a), id(c), id(d)});
  };
  for (int i = 0; i < n; ++i) {
    const int a = 4 * i;  // inner low, inner high, outer low, outer high; +4: the next angle
    quad(a + 2, a + 6, a + 7, a + 3);
    quad(a, a + 1, a + 5, a + 4);
    quad(a + 1, a + 3, a + 7, a + 5);
    quad(a, a + 4, a + 6, a + 2);
  }
  return mesh;
}

Pose random_pose(Rng& rng) {
  Pose X = Pose::Identity();
  X.linear() = rng.rotation().toRotationMatrix();
  X.translation() = rng.unit_vector() * rng.uniform(0, 3);
  return X;
}

TriangleMesh random_mesh(Rng& rng) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 30; ++i) points.push_back(rng.unit_vector().cwiseProduct(Eigen::Vector3d(0.05, 0.08, 0.03)));
  return convex_hull(points);
}

TEST(MassProperties, BoxIsExact) {
  const MassProperties m = mass_properties(transformed(Pose(Eigen::Translation3d(1, -2, 3)), box(0.2, 0.4, 0.6)), 1000);
  EXPECT_NEAR(m.volume, 0.048, 1e-15);
  EXPECT_NEAR(m.mass, 48, 1e-12);
  EXPECT_LT((m.center_P - Eigen::Vector3d(1, -2, 3)).norm(), 1e-14);
  const Eigen::Vector3d expected = 48.0 / 12 * Eigen::Vector3d(0.16 + 0.36, 0.04 + 0.36, 0.04 + 0.16);
  EXPECT_LT((m.inertia_P - Eigen::Matrix3d(expected.asDiagonal())).norm(), 1e-12);
}

TEST(MassProperties, RegularPrismRingIsExact) {
  // n-gon prism of circumradius R: area n/2 R^2 sin(2 pi/n), polar second moment area R^2 (2 + cos(2 pi/n)) / 6.
  const int n = 24;
  const double step = 2 * kPi / n;
  const auto area = [&](double r) { return n / 2.0 * r * r * std::sin(step); };
  const auto polar = [&](double r) { return area(r) * r * r * (2 + std::cos(step)) / 6; };
  const double height = 0.016;
  const TriangleMesh mesh = ring(0.035, 0.05, height, n);
  ASSERT_TRUE(is_closed(mesh));
  const MassProperties m = mass_properties(mesh, 2700);
  const double volume = (area(0.05) - area(0.035)) * height;
  EXPECT_NEAR(m.volume, volume, 1e-12 * volume);
  const double izz = 2700 * (polar(0.05) - polar(0.035)) * height;
  EXPECT_NEAR(m.inertia_P(2, 2), izz, 1e-12);
  EXPECT_NEAR(m.inertia_P(0, 0), izz / 2 + m.mass * height * height / 12, 1e-12);
}

TEST(MassProperties, RegularPrismIsExact) {
  const int n = 48;
  const double step = 2 * kPi / n;
  const MassProperties m = mass_properties(mesh_of(Primitive::cylinder(0.03, 0.1), n), 7860);
  const double area = n / 2.0 * 0.03 * 0.03 * std::sin(step);
  EXPECT_NEAR(m.volume, area * 0.1, 1e-16);
  const double izz = m.mass * 0.03 * 0.03 * (2 + std::cos(step)) / 6;
  EXPECT_NEAR(m.inertia_P(2, 2), izz, 1e-12);
  EXPECT_NEAR(m.inertia_P(1, 1), izz / 2 + m.mass * 0.1 * 0.1 / 12, 1e-12);
}

TEST(MassProperties, ConvergesToTheRoundRing) {
  const double volume = kPi * (0.05 * 0.05 - 0.035 * 0.035) * 0.016;
  for (const int n : {32, 64, 128}) {
    const double missing = 1 - mass_properties(ring(0.035, 0.05, 0.016, n), 1).volume / volume;
    EXPECT_NEAR(missing, std::pow(2 * kPi / n, 2) / 6, 0.02 * missing) << n;  // 1 - sin(x)/x
  }
}

TEST(MassProperties, SphereConverges) {
  const MassProperties m = mass_properties(mesh_of(Primitive::sphere(0.1), 256), 1);
  EXPECT_NEAR(m.volume, 4 * kPi / 3 * 1e-3, 2e-3 * m.volume);
  EXPECT_NEAR(m.inertia_P(0, 0), 0.4 * m.mass * 0.01, 2e-3 * m.inertia_P(0, 0));
}

TEST(MassProperties, FollowRigidMotionAndScale) {
  const Seed seed = Seed{1}.child("mass-motion");
  for (std::uint64_t i = 0; i < 50; ++i) {
    SCOPED_TRACE("item " + std::to_string(i));
    Rng rng = seed.rng().at(i);
    const TriangleMesh mesh_P = random_mesh(rng);
    const Pose X_AP = random_pose(rng);
    const double s = rng.uniform(0.1, 5);
    const MassProperties p = mass_properties(mesh_P, 3);
    const MassProperties a = mass_properties(transformed(X_AP, mesh_P), 3);
    EXPECT_NEAR(a.volume, p.volume, 1e-11 * p.volume);
    EXPECT_LT((a.center_P - X_AP * p.center_P).norm(), 1e-12);
    EXPECT_LT((a.inertia_P - X_AP.linear() * p.inertia_P * X_AP.linear().transpose()).norm(),
              1e-10 * p.inertia_P.norm());
    TriangleMesh scaled = mesh_P;
    for (auto& v : scaled.vertices) v *= s;
    const MassProperties q = mass_properties(scaled, 3);
    EXPECT_NEAR(q.volume, p.volume * s * s * s, 1e-12 * q.volume);
    EXPECT_LT((q.inertia_P - p.inertia_P * std::pow(s, 5)).norm(), 1e-11 * q.inertia_P.norm());
  }
}

TEST(IsClosed, SeesAMissingAndAFlippedTriangle) {
  TriangleMesh mesh = box(1, 1, 1);
  EXPECT_TRUE(is_closed(mesh));
  TriangleMesh hole = mesh;
  hole.triangles.pop_back();
  EXPECT_FALSE(is_closed(hole));
  TriangleMesh flipped = mesh;
  std::swap(flipped.triangles[3][0], flipped.triangles[3][1]);
  EXPECT_FALSE(is_closed(flipped));
  EXPECT_FALSE(is_closed({}));
}

TEST(IsClosed, WeldsASoup) {
  const TriangleMesh mesh = box(1, 2, 3);
  TriangleMesh soup;
  for (const auto& t : mesh.triangles) {
    const auto n = static_cast<std::uint32_t>(soup.vertices.size());
    for (const auto corner : t) soup.vertices.push_back(mesh.vertices[corner]);
    soup.triangles.push_back({n, n + 1, n + 2});
  }
  EXPECT_TRUE(is_closed(soup));
}

TEST(Diameter, IsExact) {
  EXPECT_DOUBLE_EQ(mesh_diameter(box(0.3, 0.4, 1.2)), 1.3);
  EXPECT_NEAR(mesh_diameter(ring(0.035, 0.05, 0.016, 48)), std::hypot(0.1, 0.016), 1e-15);
  TriangleMesh flat;  // no volume: Qhull cannot help
  flat.vertices = {{0, 0, 0}, {3, 0, 0}, {3, 4, 0}, {0, 4, 0}, {1, 1, 0}};
  flat.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}};
  EXPECT_DOUBLE_EQ(mesh_diameter(flat), 5);
}

TEST(Diameter, AgreesWithAllPairs) {
  const Seed seed = Seed{1}.child("diameter");
  for (std::uint64_t i = 0; i < 30; ++i) {
    Rng rng = seed.rng().at(i);
    TriangleMesh mesh;
    for (int k = 0; k < 90; ++k) mesh.vertices.push_back(rng.unit_vector() * (i % 2 ? 1 : rng.uniform(0.5, 1)));
    for (std::uint32_t k = 0; k + 2 < 90; k += 3) mesh.triangles.push_back({k, k + 1, k + 2});
    double best = 0;
    for (const auto& a : mesh.vertices) {
      for (const auto& b : mesh.vertices) best = std::max(best, (a - b).norm());
    }
    EXPECT_NEAR(mesh_diameter(mesh), best, 1e-14) << "item " << i;
  }
}

TEST(ConvexHull, OfABoxWithInnerPoints) {
  std::vector<Eigen::Vector3d> points = box(1, 2, 3).vertices;
  Rng rng = Seed{1}.child("hull").rng();
  for (int i = 0; i < 100; ++i) points.push_back(0.45 * rng.unit_vector());
  const TriangleMesh hull = convex_hull(points);
  EXPECT_TRUE(is_closed(hull));
  EXPECT_NEAR(mass_properties(hull, 1).volume, 6, 1e-12);
  EXPECT_TRUE(convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}).empty());
}

TEST(MeshQuery, RayMeetsTheFacesOfABox) {
  const MeshQuery query(box(2, 4, 6));
  const auto hit = query.ray({0.1, 0.2, 10}, {0, 0, -1}, 100);
  ASSERT_TRUE(hit);
  EXPECT_DOUBLE_EQ(hit->distance, 7);
  EXPECT_EQ(hit->normal, Eigen::Vector3d::UnitZ());
  EXPECT_FALSE(query.ray({0.1, 0.2, 10}, {0, 0, -1}, 6.9));
  const auto from_inside = query.ray({0.1, 0.2, 0.3}, {1, 0, 0}, 100);
  ASSERT_TRUE(from_inside);
  EXPECT_DOUBLE_EQ(from_inside->distance, 0.9);
  EXPECT_FALSE(query.ray({0.1, 0.2, 10}, {0, 0, 1}, kInfinity));
}

TEST(MeshQuery, NothingSlipsThroughEdgesAndCorners) {
  const MeshQuery query(box(2, 2, 2));  // diagonals and edges are hit exactly
  for (int i = -10; i <= 10; ++i) {
    for (int j = -10; j <= 10; ++j) {
      const Eigen::Vector3d origin(i / 10.0, j / 10.0, 5);
      const auto hit = query.ray(origin, {0, 0, -1}, 100);
      ASSERT_TRUE(hit) << i << " " << j;
      EXPECT_DOUBLE_EQ(hit->distance, 4);
      EXPECT_TRUE(query.ray({0.01, 0.02, 0.03}, origin.normalized(), 100)) << i << " " << j;
    }
  }
}

TEST(MeshQuery, RefusesNonsenseQuietly) {
  const MeshQuery query(box(1, 1, 1));
  EXPECT_FALSE(query.ray({kNan, 0, 0}, {0, 0, 1}, 1));
  EXPECT_FALSE(query.ray({0, 0, 0}, {0, kNan, 1}, 1));
  EXPECT_FALSE(query.ray({0, 0, 0}, {0, 0, 0}, 1));
  EXPECT_FALSE(query.ray({0, 0, 0}, {0, 0, 1}, kNan));
  EXPECT_FALSE(query.ray({0, 0, 0}, {0, 0, 1}, -1));
  EXPECT_FALSE(query.closest({0, kNan, 0}, 1));
  EXPECT_FALSE(query.closest({0, kInfinity, 0}, kInfinity));
  EXPECT_FALSE(query.closest({0, 0, 0}, kNan));
  const MeshQuery nothing{TriangleMesh{}};
  EXPECT_FALSE(nothing.ray({0, 0, 0}, {0, 0, 1}, 1));
  EXPECT_FALSE(nothing.closest({0, 0, 0}, kInfinity));
}

TEST(MeshQuery, ClosestPointOfABoxIsTheClampedPoint) {
  const MeshQuery query(box(2, 4, 6));
  const Seed seed = Seed{1}.child("closest-box");
  for (std::uint64_t i = 0; i < 500; ++i) {
    Rng rng = seed.rng().at(i);
    const Eigen::Vector3d p = rng.unit_vector() * rng.uniform(4, 9);  // outside: the corner radius is 3.74
    const Eigen::Vector3d foot = p.cwiseMax(Eigen::Vector3d(-1, -2, -3)).cwiseMin(Eigen::Vector3d(1, 2, 3));
    const auto hit = query.closest(p, kInfinity);
    ASSERT_TRUE(hit) << i;
    EXPECT_LT((hit->point - foot).norm(), 1e-14) << i;
    EXPECT_NEAR(hit->distance, (p - foot).norm(), 1e-14) << i;
    EXPECT_FALSE(query.closest(p, (p - foot).norm() * 0.999)) << i;
  }
}

TEST(MeshQuery, AgreesWithEveryTriangleAlone) {
  const Seed seed = Seed{1}.child("brute");
  const TriangleMesh mesh = ring(0.035, 0.05, 0.016, 60);
  const MeshQuery all(mesh);
  std::vector<MeshQuery> alone;
  for (const auto& t : mesh.triangles) alone.emplace_back(TriangleMesh{mesh.vertices, {t}});
  for (std::uint64_t i = 0; i < 300; ++i) {
    SCOPED_TRACE("item " + std::to_string(i));
    Rng rng = seed.rng().at(i);
    const Eigen::Vector3d p = rng.unit_vector() * rng.uniform(0, 0.1);
    const Eigen::Vector3d direction = rng.unit_vector();
    double ray_best = kInfinity, near_best = kInfinity;
    for (const auto& one : alone) {
      if (const auto hit = one.ray(p, direction, 1)) ray_best = std::min(ray_best, hit->distance);
      near_best = std::min(near_best, one.closest(p, kInfinity)->distance);
    }
    const auto hit = all.ray(p, direction, 1);
    EXPECT_EQ(hit ? hit->distance : kInfinity, ray_best);
    if (hit) {
      EXPECT_LT(all.closest(hit->point, 1)->distance, 1e-15);
    }
    EXPECT_EQ(all.closest(p, kInfinity)->distance, near_best);
  }
}

TEST(SampleSurface, IsEvenAndOnTheSurface) {
  const TriangleMesh mesh = box(0.1, 0.06, 0.02);
  const double spacing = 0.002;
  const PointCloud cloud = sample_surface(mesh, spacing, Seed{3});
  EXPECT_NEAR(static_cast<double>(cloud.size()), surface_area(mesh) / (spacing * spacing), 1);
  ASSERT_TRUE(cloud.has_normals());
  const MeshQuery query(mesh);
  std::vector<int> per_face(6, 0);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto hit = query.closest(cloud.points[i], 1e-12);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->normal, cloud.normals[i]);
    Eigen::Index axis = 0;
    cloud.normals[i].cwiseAbs().maxCoeff(&axis);
    ++per_face[static_cast<std::size_t>(2 * axis + (cloud.normals[i][axis] > 0))];
  }
  const double areas[3] = {0.06 * 0.02, 0.1 * 0.02, 0.1 * 0.06};
  for (std::size_t f = 0; f < 6; ++f) EXPECT_NEAR(per_face[f], areas[f / 2] / (spacing * spacing), 2.0) << f;
  // Evenness: no spot of the surface is farther than 2.5 spacings from a sample.
  for (const Eigen::Vector3d& p : sample_surface(mesh, 0.001, Seed{4}).points) {
    double best = kInfinity;
    for (const Eigen::Vector3d& q : cloud.points) best = std::min(best, (p - q).norm());
    EXPECT_LT(best, 2.5 * spacing);
  }
}

TEST(SampleSurface, RepeatsForTheSameSeedOnly) {
  const TriangleMesh mesh = ring(0.035, 0.05, 0.016, 24);
  const PointCloud a = sample_surface(mesh, 0.003, Seed{3});
  EXPECT_EQ(a.points, sample_surface(mesh, 0.003, Seed{3}).points);
  EXPECT_NE(a.points, sample_surface(mesh, 0.003, Seed{4}).points);
}

}  // namespace
}  // namespace binpick

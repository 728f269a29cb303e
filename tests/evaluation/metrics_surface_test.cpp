// The distance of Bregier et al. against its definition: the integral by sampling the surface, the symmetries by brute
// force.
#include "evaluation/metrics_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/mesh_properties.hpp"
#include "tests/evaluation/example_parts.hpp"

namespace binpick {
namespace {

/// Points with equal area each: a triangle is cut in k^2 alike ones, their middles taken with the triangle's area.
struct Samples {
  std::vector<Eigen::Vector3d> points;
  std::vector<double> weights;
};

Samples samples_of(const TriangleMesh& mesh, int k) {
  Samples samples;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const double area = 0.5 * (b - a).cross(c - a).norm();
    for (int i = 0; i < k; ++i)
      for (int j = 0; i + j < k; ++j)
        for (int upper = 0; upper <= (i + j + 1 < k ? 1 : 0); ++upper) {
          const double s = (i + (upper ? 2 : 1) / 3.0) / k, r = (j + (upper ? 2 : 1) / 3.0) / k;
          samples.points.push_back(a + s * (b - a) + r * (c - a));
          samples.weights.push_back(area / (k * k));
        }
  }
  return samples;
}

double by_definition(const Pose& X_1, const Pose& X_2, const Samples& samples, const std::vector<Pose>& group) {
  double least = 1e9;
  for (const Pose& S : group) {
    const Pose X_2S = X_2 * S;
    double sum = 0, area = 0;
    for (std::size_t i = 0; i < samples.points.size(); ++i) {
      sum += samples.weights[i] * (X_1 * samples.points[i] - X_2S * samples.points[i]).squaredNorm();
      area += samples.weights[i];
    }
    least = std::min(least, std::sqrt(sum / area));
  }
  return least;
}

TEST(SurfaceDistance, IsTheIntegralAndTheLeastOverTheGroup) {
  for (const Part& part : examples::all()) {
    const SurfaceDistance distance(part.mesh_P, part.symmetry);
    const Samples samples = samples_of(part.mesh_P, part.symmetry.center_P ? 2 : part.symmetry.axis ? 12 : 32);
    const std::vector<Pose> group = sampled_group(part.symmetry, part.symmetry.center_P ? 40 : 180);
    for (std::uint64_t i = 0; i < 6; ++i) {
      Rng rng = Seed{20261130}.child("surface " + part.name).rng().at(i);
      const Pose X_1 = examples::random_pose(rng);
      Pose X_2 = X_1 * examples::random_member(part.symmetry, rng) *
                 examples::turn(part.box_center_P, rng.unit_vector(), i < 3 ? 0.2 : rng.uniform(0, 3));
      // A sphere's group is sampled coarsely: its shift is large, so that turning hardly tells.
      X_2.translation() += rng.uniform(0.5, 1) * (part.symmetry.center_P ? 0.2 : 0.02) * rng.unit_vector();
      const double expected = by_definition(X_1, X_2, samples, group);
      EXPECT_NEAR(distance.between(X_1, X_2), expected, 1e-3 * expected) << part.name << ", item " << i;
      EXPECT_NEAR(distance.between(X_2, X_1), distance.between(X_1, X_2), 1e-4 * expected) << part.name;
    }
  }
}

TEST(SurfaceDistance, AShiftIsItsLength) {
  for (const Part& part : examples::all()) {
    const SurfaceDistance distance(part.mesh_P, part.symmetry);
    EXPECT_NEAR(distance.between(Pose::Identity(), examples::moved_to(0.003, 0, 0.004)), 0.005, 1e-7) << part.name;
  }
}

// A ball of radius r turned by an angle, without its symmetry: M = r^2/3, d^2 = 2 (1 - cos) (M_xx + M_yy).
TEST(SurfaceDistance, ATurnedBallWithoutSymmetry) {
  const Part ball = examples::ball();
  const SurfaceDistance distance(ball.mesh_P, Symmetry{});
  const double angle = 0.7, r = 0.02;
  EXPECT_NEAR(distance.between(Pose::Identity(), examples::turn({0, 0.01, 0}, {0, 0, 1}, angle)),
              std::sqrt(2 * (1 - std::cos(angle)) * 2 * r * r / 3), 0.02 * r);  // of a ball of flat facets
}

TEST(SurfaceDistance, TheBallAroundABox) {
  const Part box = examples::box();
  const double diagonal = std::sqrt(0.08 * 0.08 + 0.05 * 0.05 + 0.03 * 0.03);
  EXPECT_NEAR(SurfaceDistance(box.mesh_P, {}).ball_diameter(), diagonal, 1e-3 * diagonal);
  TriangleMesh triangle;  // equilateral, side 1: its ball is wider than its longest side
  triangle.vertices = {{0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(0.75), 0}};
  triangle.triangles = {{0, 1, 2}};
  EXPECT_NEAR(SurfaceDistance(triangle, {}).ball_diameter(), 2 / std::sqrt(3.0), 1e-3);
}

}  // namespace
}  // namespace binpick

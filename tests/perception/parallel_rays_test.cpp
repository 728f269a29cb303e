#include "perception/parallel_rays.hpp"

#include <gtest/gtest.h>

#include "core/mesh_properties.hpp"
#include "core/random.hpp"
#include "core/sample_surface.hpp"
#include "tests/perception/example_parts.hpp"

namespace binpick {
namespace {

using namespace testing_scene;

TEST(ParallelRays, AnswerAsSingleRaysDo) {
  int blocked = 0, all = 0;
  for (const TriangleMesh& mesh : {bearing_with_balls(), bracket_part().mesh_P}) {
    const MeshQuery query(mesh);
    const PointCloud samples = sample_surface(mesh, 0.003, Seed{3});
    Rng rng = Seed{4}.rng();
    std::vector<Eigen::Vector3d> directions = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}, {1, 1, 0}, {0, 1, -1}};
    while (directions.size() < 20) directions.push_back(rng.unit_vector());
    for (const Eigen::Vector3d& direction : directions) {
      ParallelRays rays(mesh, direction);
      for (std::size_t i = 0; i < samples.size(); ++i) {
        const Eigen::Vector3d origin = samples.points[i] + 1e-6 * samples.normals[i];
        const bool expected = query.ray(origin, direction, 1).has_value();
        EXPECT_EQ(rays.blocked(origin), expected) << origin.transpose() << " along " << direction.transpose();
        blocked += expected, ++all;
      }
    }
  }
  EXPECT_GT(blocked, all / 4);  // both answers are asked for
  EXPECT_LT(blocked, 3 * all / 4);
}

TEST(ParallelRays, CornersEdgesAndPlacesOutsideAreNoException) {
  const TriangleMesh box = mesh_of(Primitive::box({0.1, 0.2, 0.3}));
  ParallelRays up(box, {0, 0, 1});
  for (const double x : {-0.05, 0.0, 0.05})
    for (const double y : {-0.1, 0.0, 0.1}) EXPECT_TRUE(up.blocked({x, y, -0.2})) << x << " " << y;
  EXPECT_FALSE(up.blocked({0, 0, 0.151}));
  EXPECT_TRUE(up.blocked({0, 0, 0.149}));
  EXPECT_FALSE(up.blocked({0.0501, 0, -0.2}));
  EXPECT_FALSE(up.blocked({7, -7, -9}));
  EXPECT_FALSE(ParallelRays(TriangleMesh{}, {0, 0, 1}).blocked({0, 0, 0}));
}

}  // namespace
}  // namespace binpick

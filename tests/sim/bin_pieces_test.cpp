// A bin from CAD collides where its mesh is, and nothing gets through its thin walls.
#include "sim/bin_pieces.hpp"

#include <gtest/gtest.h>

#include "core/bin_mesh.hpp"
#include "core/mesh_io.hpp"
#include "core/random.hpp"
#include "example_parts.hpp"
#include "sim/bin.hpp"
#include "sim/rest_check.hpp"
#include "tests/core/open_box.hpp"
#include "tests/core/temp_folder.hpp"

namespace binpick {
namespace {

constexpr double kWall = 0.003;

struct CadBin {
  TempFolder folder;
  BinSpec bin;
  CadBin() {
    bin.inner_size = {0.3, 0.2, 0.12};
    bin.wall = kWall;
    bin.mesh = folder.at("bin.stl");
    write_stl(bin.mesh, open_box(bin.inner_size, kWall));
    prepare_bin(bin);
  }
};

bool inside(const TriangleMesh& hull, const Eigen::Vector3d& p) {
  for (const auto& t : hull.triangles) {
    const Eigen::Vector3d& a = hull.vertices[t[0]];
    if ((hull.vertices[t[1]] - a).cross(hull.vertices[t[2]] - a).dot(p - a) > 0) return false;
  }
  return true;
}

TEST(BinPieces, WallsAreThickOutwardsAndTheRoomStaysFree) {
  const CadBin cad;
  const std::vector<TriangleMesh> pieces = thickened(*cad.bin.pieces_B, cad.bin, 0.05);
  ASSERT_EQ(pieces.size(), cad.bin.pieces_B->size());
  Rng rng(3);
  for (int i = 0; i < 4000; ++i) {
    const Eigen::Vector3d p(rng.uniform(-0.2, 0.2), rng.uniform(-0.15, 0.15), rng.uniform(-0.05, 0.119));
    const Eigen::Vector3d beyond(std::abs(p.x()) - 0.15, std::abs(p.y()) - 0.1, -p.z());
    if (beyond.cwiseAbs().minCoeff() < 1e-3) continue;
    // Over the rim's corner of two walls either may reach; straight behind one wall it is solid.
    if ((beyond.array() > 0).count() > 1) continue;
    const bool solid =
        std::any_of(pieces.begin(), pieces.end(), [&](const TriangleMesh& hull) { return inside(hull, p); });
    EXPECT_EQ(solid, beyond.maxCoeff() > 0) << p.transpose();
  }
}

TEST(BinPieces, AFastPartDoesNotPassThroughAThinWall) {
  const CadBin cad;
  const Part ball = example::ring();
  const CollisionShape shape = collision_shape(ball);
  for (const Eigen::Vector3d& way : {Eigen::Vector3d(8, 0, 0), Eigen::Vector3d(0, -8, 0), Eigen::Vector3d(0, 0, -8)}) {
    World world{PhysicsConfig{}};
    add_bin(world, cad.bin, Pose::Identity());
    const BodyId body = world.add_free(ball, shape, Pose(Eigen::Translation3d(0, 0, 0.06)));
    world.set_velocity(body, way, Eigen::Vector3d::Zero());
    for (int i = 0; i < 200; ++i) world.step();
    const Eigen::Vector3d p = world.mass_center(body);
    EXPECT_TRUE(std::abs(p.x()) < 0.15 && std::abs(p.y()) < 0.1 && p.z() > 0) << p.transpose();
  }
}

TEST(BinPieces, RingsRestInIt) {
  const CadBin cad;
  const Part part = example::ring();
  const CollisionShape shape = collision_shape(part);
  World world{PhysicsConfig{}};
  add_bin(world, cad.bin, Pose::Identity());
  const std::vector<DropItem> items(6, {&part, &shape, 0});
  DropResult heap = drop_parts(world, items, cad.bin, Pose::Identity(), {}, {}, Seed{9});
  const SolidProbe probe = probe_of(part);
  check_rest(world, cad.bin, Pose::Identity(), std::span(&probe, 1), {}, heap);
  EXPECT_TRUE(heap.settled) << heap.unsettled;
  EXPECT_TRUE(heap.escaped.empty());
  EXPECT_LT(heap.worst_penetration, 1e-3);
}

TEST(BinPieces, DepthInTheMeshIsMeasured) {
  const CadBin cad;
  const Part part = example::ring();
  const CollisionShape shape = collision_shape(part);
  World world{PhysicsConfig{}};
  const SolidProbe probe = probe_of(part);
  const SolidProbe* probes[] = {&probe};
  const double half = bounding_box(part.mesh_P).sizes().z() / 2;
  const BodyId bodies[] = {world.add_free(part, shape, Pose(Eigen::Translation3d(0, 0, half - 1e-3)))};
  const std::vector<double> depths = penetrations(world, bodies, probes, cad.bin, Pose::Identity());
  ASSERT_EQ(depths.size(), 1u);
  EXPECT_NEAR(depths[0], 1e-3, 1e-5);
}

}  // namespace
}  // namespace binpick

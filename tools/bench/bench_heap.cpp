#include "tools/bench/bench_heap.hpp"

#include <cmath>
#include <memory>
#include <numbers>

#include "core/bin_spec.hpp"
#include "core/primitive.hpp"
#include "sim/bin.hpp"
#include "sim/collision_shape.hpp"
#include "sim/drop.hpp"

namespace binpick {
namespace {

constexpr double kInner = 0.035, kOuter = 0.05, kHeight = 0.016;  // m
constexpr int kSides = 4;                                         // points on each side of the section

// The section of the ring, once around, in (radius, z).
std::vector<Eigen::Vector2d> section() {
  const double h = kHeight / 2;
  const Eigen::Vector2d corners[] = {{kInner, -h}, {kOuter, -h}, {kOuter, h}, {kInner, h}};
  std::vector<Eigen::Vector2d> points;
  for (int side = 0; side < 4; ++side)
    for (int k = 0; k < kSides; ++k)
      points.push_back(corners[side] + (corners[(side + 1) % 4] - corners[side]) * k / kSides);
  return points;
}

// Points of the section turned to sector `k` of `sectors`.
std::vector<Eigen::Vector3d> turned(const std::vector<Eigen::Vector2d>& points, int k, int sectors) {
  const double angle = 2 * std::numbers::pi * k / sectors;
  std::vector<Eigen::Vector3d> out;
  for (const Eigen::Vector2d& p : points) out.push_back({p.x() * std::cos(angle), p.x() * std::sin(angle), p.y()});
  return out;
}

TriangleMesh ring_mesh(int sectors) {
  const std::vector<Eigen::Vector2d> profile = section();
  const auto n = static_cast<std::uint32_t>(profile.size());
  TriangleMesh mesh;
  for (int k = 0; k < sectors; ++k) {
    const std::vector<Eigen::Vector3d> points = turned(profile, k, sectors);
    mesh.vertices.insert(mesh.vertices.end(), points.begin(), points.end());
    const auto here = static_cast<std::uint32_t>(k) * n, next = static_cast<std::uint32_t>((k + 1) % sectors) * n;
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = here + i, b = here + (i + 1) % n, c = next + (i + 1) % n, d = next + i;
      mesh.triangles.push_back({a, c, b});
      mesh.triangles.push_back({a, d, c});
    }
  }
  return mesh;
}

std::vector<TriangleMesh> wedges(int count) {
  std::vector<TriangleMesh> pieces;
  for (int w = 0; w < count; ++w) {
    TriangleMesh piece;
    for (int i = 0; i <= 3; ++i) {
      const std::vector<Eigen::Vector3d> points = turned(section(), 3 * w + i, 3 * count);
      for (int corner = 0; corner < 4; ++corner)
        piece.vertices.push_back(points[static_cast<std::size_t>(corner) * kSides]);
    }
    pieces.push_back(piece);
  }
  return pieces;
}

std::shared_ptr<const TriangleMesh> merged(const std::vector<Primitive>& shapes) {
  TriangleMesh mesh;
  for (const Primitive& shape : shapes) append(mesh, mesh_of(shape));
  return std::make_shared<const TriangleMesh>(std::move(mesh));
}

}  // namespace

Part bench_ring() {
  Part part;
  part.name = "bench_ring";
  part.mesh_P = part.envelope_P = ring_mesh(160);
  part.pieces_P = wedges(8);
  part.density = 2700;
  part.mass = mass_properties(part.envelope_P, part.density);
  part.diameter = mesh_diameter(part.envelope_P);
  return part;
}

BenchHeap bench_heap(std::size_t parts, Seed seed) {
  const Part part = bench_ring();
  const CollisionShape shape = collision_shape(part);
  const BinSpec bin;
  World world{PhysicsConfig{}};
  add_bin(world, bin, Pose::Identity());
  const std::vector<DropItem> items(parts, {&part, &shape, 0});
  const DropResult drop =
      drop_parts(world, items, bin, Pose::Identity(), DropConfig{}, SettleConfig{}, seed.child("drop"));

  BenchHeap heap;
  heap.parts = parts;
  heap.triangles = part.mesh_P.triangles.size();
  const auto mesh = std::make_shared<const TriangleMesh>(part.mesh_P);
  for (std::size_t i = 0; i < parts; ++i)
    heap.scene.items.push_back({mesh, world.pose(drop.bodies[i]), static_cast<std::int32_t>(i), {}});
  heap.scene.items.push_back({merged(bin_boxes(bin, bin.wall)), Pose::Identity(), kIdBin, {}});
  const Pose below(Eigen::Translation3d(0, 0, -0.05));
  heap.scene.items.push_back({merged({Primitive::box({2, 2, 0.05}, below)}), Pose::Identity(), kIdTable, {}});
  heap.X_WC = pose_from_xyz_rpy({0, 0, 0.6}, {std::numbers::pi, 0, 0});
  return heap;
}

}  // namespace binpick

// The ray caster on its own, against geometry known on paper; then the rasteriser against it, on heaps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/bin_spec.hpp"
#include "core/error.hpp"
#include "core/mesh_properties.hpp"
#include "core/part.hpp"
#include "core/primitive.hpp"
#include "core/random.hpp"
#include "sim/depth_renderer.hpp"
#include "sim/visibility.hpp"

namespace binpick {
namespace {

using MeshPtr = std::shared_ptr<const TriangleMesh>;

MeshPtr share(TriangleMesh mesh) { return std::make_shared<const TriangleMesh>(std::move(mesh)); }

Pose at(double x, double y, double z) { return Pose(Eigen::Translation3d(x, y, z)); }

// A square of the plane z = 0, facing -z, 2 `reach` wide.
TriangleMesh plate(double reach) {
  return {{{-reach, -reach, 0}, {reach, -reach, 0}, {reach, reach, 0}, {-reach, reach, 0}}, {{0, 2, 1}, {0, 3, 2}}};
}

ExactFrame cast(const RenderScene& scene, const PinholeCamera& camera, double near = 0.1, double far = 3) {
  return make_raycast_renderer()->render(scene, camera, Pose::Identity(), near, far);
}

TEST(Raycast, TiltedPlaneToTheRoundingOfAFloat) {
  const PinholeCamera camera;
  const Pose X_CO = at(0.02, -0.01, 0.7) * pose_from_xyz_rpy({0, 0, 0}, {0.5, -0.6, 0.3});
  const Eigen::Vector3d n = -X_CO.linear().col(2);
  const ExactFrame frame = cast({{{share(plate(12)), X_CO, 4, {}}}}, camera);
  int seen = 0;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const double z = n.dot(X_CO.translation()) / n.dot(camera.ray(u, v));
      if (z < 0.11 || z > 2.9) continue;
      ++seen;
      ASSERT_FLOAT_EQ(frame.depth(u, v), static_cast<float>(z)) << u << "," << v;
      ASSERT_LT((frame.normals_C(u, v).cast<double>() - n).norm(), 1e-6);
    }
  EXPECT_GT(seen, 300000);
}

TEST(Raycast, SphereLiesBetweenItsCornersAndItsFacets) {
  const PinholeCamera camera;
  const double radius = 0.1, distance = 0.5;
  const int segments = 256;
  const MeshPtr mesh = share(mesh_of(Primitive::sphere(radius), segments));
  const ExactFrame frame = cast({{{mesh, at(0.03, -0.02, distance), 0, {}}}}, camera);
  const Eigen::Vector3d centre(0.03, -0.02, distance);
  const double sagitta = radius * (1 - std::cos(M_PI / segments)) * 2;  // both directions of the facet
  int hits = 0, inside = 0;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector3d ray = camera.ray(u, v);
      const double b = ray.dot(centre), a = ray.squaredNorm();
      inside += b * b - a * (centre.squaredNorm() - radius * radius) > 0;
      if (frame.ids(u, v) != 0) continue;
      ++hits;
      const Eigen::Vector3d from_centre = camera.unproject(u, v, frame.depth(u, v)) - centre;
      ASSERT_LE(from_centre.norm(), radius + 1e-7);
      ASSERT_GE(from_centre.norm(), radius - sagitta - 1e-7);
      // A facet's normal is off by at most the angle from its middle to its corner.
      ASSERT_GT(frame.normals_C(u, v).cast<double>().dot(from_centre.normalized()), std::cos(2 * M_PI / segments));
      ASSERT_LE(frame.normals_C(u, v).cast<double>().dot(ray), 0);
    }
  EXPECT_LE(hits, inside);  // the mesh lies inside the sphere
  EXPECT_GT(hits, 0.998 * inside);
}

TEST(Raycast, BoxShowsItsFrontFace) {
  PinholeCamera camera;
  camera.fx = camera.fy = 400;
  camera.cx = 400.25;
  camera.cy = 240.25;
  const ExactFrame frame = cast({{{share(mesh_of(Primitive::box({0.3, 0.2, 0.1}))), at(0, 0, 1.05), 7, {}}}}, camera);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const bool box = std::abs(u - 400.25) < 60 && std::abs(v - 240.25) < 40;  // 400 px/m at z = 1
      ASSERT_EQ(frame.ids(u, v), box ? 7 : kIdNothing) << u << "," << v;
      if (box) {
        ASSERT_FLOAT_EQ(frame.depth(u, v), 1.0f);
        ASSERT_FLOAT_EQ(frame.normals_C(u, v).z(), -1.0f);
      }
    }
}

// Depth is clipped by z, not by the distance along the ray: in the image's corner that is 14 % more.
TEST(Raycast, NearAndFarAreDepths) {
  const PinholeCamera camera;
  const RenderScene scene{{{share(plate(2)), at(0, 0, 0.6), 1, {}}, {share(plate(2)), at(0, 0, 0.8), 2, {}}}};
  for (const auto& [near, far, id] : {std::tuple{0.1, 2.0, 1}, {0.61, 2.0, 2}, {0.1, 0.61, 1}, {0.61, 0.79, -1}}) {
    const ExactFrame frame = cast(scene, camera, near, far);
    for (const std::int32_t seen : frame.ids) ASSERT_EQ(seen, id) << near << " " << far;
  }
}

TEST(Raycast, OfTwoAtTheSamePlaceTheEarlierIsSeen) {
  const PinholeCamera camera;
  const MeshPtr ball = share(mesh_of(Primitive::sphere(0.1), 32)), copy = share(TriangleMesh(*ball));
  for (const bool swapped : {false, true}) {
    RenderScene scene{{{ball, at(0, 0, 0.6), 5, {}}, {copy, at(0, 0, 0.6), 6, {}}}};
    if (swapped) std::swap(scene.items[0], scene.items[1]);
    const ExactFrame drawn = make_osmesa_renderer()->render(scene, camera, Pose::Identity(), 0.1, 2);
    const ExactFrame frame = cast(scene, camera);
    for (std::size_t i = 0; i < frame.ids.size(); ++i) {
      ASSERT_TRUE(frame.ids[i] == kIdNothing || frame.ids[i] == (swapped ? 6 : 5)) << i;
      ASSERT_TRUE(drawn.ids[i] == kIdNothing || drawn.ids[i] == (swapped ? 6 : 5)) << i;
    }
  }
}

// ---- a heap
// ------------------------------------------------------------------------------------------------------------------

struct Heap {
  RenderScene scene;
  PinholeCamera camera;
  Pose X_WC;
  std::size_t parts = 0;
};

Heap random_heap(std::uint64_t seed) {
  Heap heap;
  Rng rng = Seed{seed}.child("heap").rng();
  PartSpec spec = read_part_spec(BINPICK_SOURCE_DIR "/assets/parts/bracket_l/part.yaml");
  const MeshPtr meshes[] = {share(load_part(spec).mesh_P), share(mesh_of(Primitive::sphere(0.03), 96)),
                            share(mesh_of(Primitive::cylinder(0.025, 0.07), 96)),
                            share(mesh_of(Primitive::box({0.08, 0.05, 0.02})))};
  TriangleMesh bin;
  for (const Primitive& box : bin_boxes(BinSpec{}, 0.005)) append(bin, mesh_of(box));
  heap.parts = 24;
  for (std::size_t i = 0; i < heap.parts; ++i) {
    Pose X_WP = at(rng.uniform(-0.16, 0.16), rng.uniform(-0.11, 0.11), rng.uniform(0.03, 0.12));
    X_WP.linear() = rng.rotation().toRotationMatrix();
    heap.scene.items.push_back({meshes[i % std::size(meshes)], X_WP, static_cast<std::int32_t>(i), {}});
  }
  heap.scene.items.push_back({share(std::move(bin)), Pose::Identity(), kIdBin, {}});
  heap.X_WC = at(0.05, -0.03, 0.5) * pose_from_xyz_rpy({0, 0, 0}, {M_PI - 0.1, 0.15, 0.4});
  return heap;
}

ExactFrame draw(DepthRenderer& renderer, const Heap& heap) {
  return renderer.render(heap.scene, heap.camera, heap.X_WC, 0.1, 2);
}

TEST(RaycastHeap, ThreadsChangeNoBit) {
  const Heap heap = random_heap(3);
  const ExactFrame one = draw(*make_raycast_renderer(1), heap);
  for (const int threads : {2, 3, 7}) {
    const ExactFrame many = draw(*make_raycast_renderer(threads), heap);
    EXPECT_TRUE(std::equal(one.ids.begin(), one.ids.end(), many.ids.begin()));
    for (std::size_t i = 0; i < one.ids.size(); ++i) {
      ASSERT_TRUE(one.depth[i] == many.depth[i] || one.ids[i] == kIdNothing);
      ASSERT_EQ(one.normals_C[i], many.normals_C[i]);
    }
  }
}

// Rays of core's MeshQuery, in double and without Embree.
TEST(RaycastHeap, AgreesWithRaysInDouble) {
  const Heap heap = random_heap(4);
  const ExactFrame frame = draw(*make_raycast_renderer(), heap);
  std::map<const TriangleMesh*, MeshQuery> queries;
  for (const RenderItem& item : heap.scene.items) queries.try_emplace(item.mesh_O.get(), *item.mesh_O);
  int rays = 0, other_id = 0;
  for (int v = 3; v < heap.camera.height; v += 11)
    for (int u = 2; u < heap.camera.width; u += 11) {
      const Eigen::Vector3d ray_C = heap.camera.ray(u, v);
      double z = 2;
      std::int32_t id = kIdNothing;
      for (const RenderItem& item : heap.scene.items) {
        const Pose X_OC = (heap.X_WC.inverse() * item.X_WO).inverse();
        const auto hit =
            queries.at(item.mesh_O.get()).ray(X_OC.translation(), X_OC.linear() * ray_C.normalized(), z * ray_C.norm());
        if (!hit || hit->distance / ray_C.norm() >= z) continue;
        z = hit->distance / ray_C.norm();
        id = item.id;
      }
      ++rays;
      other_id += frame.ids(u, v) != id;
      if (id != kIdNothing && frame.ids(u, v) == id) {
        ASSERT_NEAR(frame.depth(u, v), z, 1e-7) << u << "," << v;
      }
    }
  EXPECT_GT(rays, 3000);
  EXPECT_LE(other_id, 1);  // a ray that passes an edge within the rounding of a float
}

struct Difference {
  double pixels = 0, other_id = 0, other_facet = 0, far_off = 0, sum_z = 0, compared = 0;
};

// Pixel by pixel; where both see the same facet of the same thing (or two of one plane), depth is compared.
Difference difference(const ExactFrame& drawn, const ExactFrame& exact) {
  Difference d;
  for (std::size_t i = 0; i < exact.ids.size(); ++i) {
    ++d.pixels;
    if (drawn.ids[i] != exact.ids[i]) {
      ++d.other_id;
    } else if (exact.ids[i] != kIdNothing) {
      const double dz = std::abs(drawn.depth[i] - exact.depth[i]);
      const bool same_facet = (drawn.normals_C[i] - exact.normals_C[i]).norm() < 1e-4f;
      d.other_facet += !same_facet;
      if (!same_facet) continue;
      ++d.compared;
      dz > 0.2e-6 ? ++d.far_off : d.sum_z += dz;  // far off: another facet that is parallel
    }
  }
  return d;
}

// The rasteriser rounds corners to 1/256 pixel: at a silhouette or an edge the pixel beside it may be seen instead.
TEST(RaycastHeap, RasteriserAgrees) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Heap heap = random_heap(seed);
    const auto osmesa = make_osmesa_renderer(), raycast = make_raycast_renderer(2);
    const ExactFrame drawn = draw(*osmesa, heap), exact = draw(*raycast, heap);
    const Difference d = difference(drawn, exact);
    EXPECT_GT(d.compared, 0.3 * d.pixels) << "seed " << seed;
    EXPECT_LT(d.other_id, 2e-4 * d.pixels) << "seed " << seed;
    EXPECT_LT(d.other_facet, 1e-3 * d.pixels) << "seed " << seed;
    EXPECT_LT(d.far_off, 1e-4 * d.pixels) << "seed " << seed;
    EXPECT_LT(d.sum_z / d.compared, 1e-9) << "seed " << seed;  // both take depth from the facet
    const auto a = part_visibility(*osmesa, heap.scene, drawn, heap.camera, heap.X_WC, heap.parts);
    const auto b = part_visibility(*raycast, heap.scene, exact, heap.camera, heap.X_WC, heap.parts);
    for (std::size_t i = 0; i < heap.parts; ++i)
      EXPECT_NEAR(a[i].fraction(), b[i].fraction(), 5e-3) << "seed " << seed << " part " << i;
  }
}

// Silhouettes are counted without a renderer; the ray caster, shown one part alone, must count the same.
TEST(RaycastHeap, SilhouettesAreWhatAPartAloneCovers) {
  for (std::uint64_t seed = 11; seed <= 13; ++seed) {
    const Heap heap = random_heap(seed);
    const auto raycast = make_raycast_renderer();
    PinholeCamera wide = heap.camera;  // what lies outside the image counts
    wide.width += 1000, wide.height += 1000, wide.cx += 500, wide.cy += 500;
    const auto seen = part_visibility(*raycast, heap.scene, draw(*raycast, heap), heap.camera, heap.X_WC, heap.parts);
    for (std::size_t i = 0; i < heap.parts; ++i) {
      const ExactFrame alone = raycast->render({{heap.scene.items[i]}}, wide, heap.X_WC, 0.05, 2);
      const auto pixels = std::count(alone.ids.begin(), alone.ids.end(), static_cast<std::int32_t>(i));
      EXPECT_NEAR(static_cast<double>(seen[i].silhouette_pixels), static_cast<double>(pixels), 1) << seed << " " << i;
    }
  }
}

TEST(RaycastHeap, APartThroughTheCamerasPlaneHasASilhouette) {
  const PinholeCamera camera;
  const RenderScene scene{{{share(mesh_of(Primitive::box({0.02, 0.02, 1}))), at(0.05, 0, 0.3), 0, {}}}};
  const auto raycast = make_raycast_renderer();
  const ExactFrame frame = raycast->render(scene, camera, Pose::Identity(), 0.05, 2);
  const Visibility seen = part_visibility(*raycast, scene, frame, camera, Pose::Identity(), 1).at(0);
  EXPECT_GT(seen.visible_pixels, 1000);
  EXPECT_GE(seen.silhouette_pixels, seen.visible_pixels);
}

}  // namespace
}  // namespace binpick

// Without a bin in the view: what is larger than any part is no part.
#include "perception/large_planes.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"

namespace binpick {
namespace {

constexpr double kFloor = 0.6, kTop = 0.584;

/// A floor under the camera and on it two boxes of 80 x 60 px (110 x 84 mm) and 16 mm, noise of half a millimetre. The
/// left third of the picture is a wall, slanted by 45 degrees.
Scene floor_and_boxes() {
  Scene scene;
  scene.camera = {320, 200, 430, 430, 159.5, 99.5};
  scene.noise.constant = 0.0005;
  scene.depth = Image<float>(320, 200, 0.0f);
  scene.wanted = Image<std::uint8_t>(320, 200, 1);
  scene.normals = Image<Eigen::Vector3f>(320, 200, -Eigen::Vector3f::UnitZ());
  Rng rng = Seed{11}.rng();
  for (int v = 0; v < 200; ++v)
    for (int u = 0; u < 320; ++u) {
      const bool box = v >= 60 && v < 120 && ((u >= 120 && u < 200) || (u >= 215 && u < 295));
      double z = box ? kTop : kFloor;
      if (u < 100) {  // the plane z + x = c, which meets the floor at u = 100
        const double x = (u - 159.5) / 430, edge = (100 - 159.5) / 430;
        z = kFloor * (1 - edge) / (1 - x);
        scene.normals(u, v) = Eigen::Vector3f(1, 0, -1).normalized();
      }
      scene.depth(u, v) = static_cast<float>(z + 0.0005 * rng.normal());
    }
  return scene;
}

double share_wanted(const Scene& scene, int u0, int u1, int v0, int v1) {
  int wanted = 0;
  for (int v = v0; v < v1; ++v)
    for (int u = u0; u < u1; ++u) wanted += scene.wanted(u, v) != 0;
  return static_cast<double>(wanted) / ((u1 - u0) * (v1 - v0));
}

TEST(LargePlanes, FloorAndWallGoAndBoxesStay) {
  Scene scene = floor_and_boxes();
  unmark_large_planes(scene, 0.14);
  EXPECT_LT(share_wanted(scene, 110, 310, 130, 195), 0.02);  // floor
  EXPECT_LT(share_wanted(scene, 5, 95, 5, 195), 0.02);       // wall
  EXPECT_GT(share_wanted(scene, 123, 197, 63, 117), 0.98);   // boxes, whose tops lie in one plane
  EXPECT_GT(share_wanted(scene, 218, 292, 63, 117), 0.98);
}

TEST(LargePlanes, APartAsLargeAsThePlaneMayBeIt) {
  Scene scene = floor_and_boxes();
  unmark_large_planes(scene, 0.6);
  EXPECT_GT(share_wanted(scene, 0, 320, 0, 200), 0.99);
}

TEST(LargePlanes, TheSameSceneGivesTheSameAnswer) {
  Scene one = floor_and_boxes(), two = floor_and_boxes();
  unmark_large_planes(one, 0.14);
  unmark_large_planes(two, 0.14);
  for (std::size_t i = 0; i < one.wanted.size(); ++i) ASSERT_EQ(one.wanted[i], two.wanted[i]);
}

TEST(LargePlanes, NothingToSeeIsNoTrouble) {
  Scene scene = floor_and_boxes();
  for (auto& n : scene.normals) n.setZero();
  unmark_large_planes(scene, 0.14);
  EXPECT_EQ(share_wanted(scene, 0, 320, 0, 200), 1);
}

}  // namespace
}  // namespace binpick

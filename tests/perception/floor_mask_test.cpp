// A thin plate on the floor under noise as large as half its thickness: one pixel does not tell, five by five do.
#include "perception/floor_mask.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"

namespace binpick {
namespace {

constexpr double kThickness = 0.004, kSigma = 0.0013;

/// The camera looks down on the floor from 0.6 m; a plate of 60 x 40 px lies in the middle.
Scene plate_on_floor(Seed seed) {
  Scene scene;
  scene.camera = {200, 160, 430, 430, 99.5, 79.5};
  scene.bin = BinSpec();
  scene.X_CB = pose_from(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()).toRotationMatrix(), {0, 0, 0.6});
  scene.depth = Image<float>(200, 160, 0.6f);
  scene.wanted = Image<std::uint8_t>(200, 160, 0);
  for (int v = 60; v < 100; ++v)
    for (int u = 70; u < 130; ++u) scene.depth(u, v) = static_cast<float>(0.6 - kThickness);
  Rng rng = seed.rng();
  for (float& z : scene.depth) z += static_cast<float>(kSigma * rng.normal());
  return scene;
}

TEST(FloorMask, APlateAsThinAsThreeSigmaIsToldFromTheFloor) {
  Scene scene = plate_on_floor(Seed{7});
  mark_low_pixels(scene, {kThickness / 2, 0.011, 0.005});
  int missed = 0, mistaken = 0;
  for (int v = 4; v < 156; ++v)
    for (int u = 4; u < 196; ++u) {
      const bool inside = v >= 60 && v < 100 && u >= 70 && u < 130;
      const bool rim = std::abs(v - 79.5) < 23 && std::abs(u - 99.5) < 33 && !(v >= 63 && v < 97 && u >= 73 && u < 127);
      if (rim) continue;  // a window across the edge: half a pixel either way
      inside ? missed += scene.wanted(u, v) == 0 : mistaken += scene.wanted(u, v) != 0;
    }
  // Half the thickness is 1.5 sigma for a pixel (7 % wrong), 7.7 sigma for the mean of 25.
  EXPECT_EQ(missed, 0);
  EXPECT_EQ(mistaken, 0);
}

TEST(FloorMask, WhatIsHighStaysAsItIs) {
  Scene scene = plate_on_floor(Seed{8});
  for (int v = 10; v < 40; ++v)
    for (int u = 10; u < 60; ++u) scene.depth(u, v) = 0.55f, scene.wanted(u, v) = 1;
  mark_low_pixels(scene, {kThickness / 2, 0.011, 0.005});
  for (int v = 10; v < 40; ++v)
    for (int u = 10; u < 60; ++u) EXPECT_EQ(scene.wanted(u, v), 1);
}

TEST(FloorMask, NothingIsMarkedBesideTheWalls) {
  Scene scene = plate_on_floor(Seed{9});
  scene.bin->inner_size = {0.10, 0.30, 0.2};  // the plate reaches over where this bin's walls stand
  mark_low_pixels(scene, {kThickness / 2, 0.011, 0.02});
  for (int v = 0; v < 160; ++v)
    for (int u = 0; u < 200; ++u)
      if (std::abs(scene.camera.unproject(u, v, scene.depth(u, v)).x()) > 0.03) {
        EXPECT_EQ(scene.wanted(u, v), 0);
      }
}

}  // namespace
}  // namespace binpick

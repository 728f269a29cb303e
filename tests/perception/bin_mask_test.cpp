// What of a bin from CAD stands in the room is no part.
#include "perception/bin_mask.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "core/bin_mesh.hpp"
#include "core/mesh_io.hpp"
#include "tests/core/open_box.hpp"
#include "tests/core/temp_folder.hpp"

namespace binpick {
namespace {

TEST(BinMask, ARibOfTheMeshIsUnmarkedAndAPartBesideItIsNot) {
  const TempFolder folder;
  BinSpec bin;
  bin.inner_size = {0.3, 0.2, 0.1};
  bin.wall = 0.003;
  bin.mesh = folder.at("bin.stl");
  TriangleMesh mesh = open_box(bin.inner_size, bin.wall);
  constexpr double kRibTop = 0.06, kPartTop = 0.03;
  append(mesh, mesh_of(Primitive::box({0.02, 0.04, kRibTop + 0.001}, Pose(Eigen::Translation3d(0, 0, kRibTop / 2)))));
  write_stl(bin.mesh, mesh);
  bin.load();

  Scene scene;
  scene.camera = {200, 160, 430, 430, 99.5, 79.5};
  scene.bin = bin;
  scene.X_CB = pose_from(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()).toRotationMatrix(), {0, 0, 0.5});
  scene.depth = Image<float>(200, 160, 0.5f - static_cast<float>(kPartTop));
  scene.wanted = Image<std::uint8_t>(200, 160, 1);
  const auto on_rib = [&](int u, int v) {
    const Eigen::Vector3d p = scene.X_CB.inverse() * scene.camera.unproject(u, v, 0.5 - kRibTop);
    return std::abs(p.x()) < 0.01 && std::abs(p.y()) < 0.02;
  };
  for (int v = 0; v < 160; ++v)
    for (int u = 0; u < 200; ++u)
      if (on_rib(u, v)) scene.depth(u, v) = 0.5f - static_cast<float>(kRibTop);
  unmark_bin(scene, 0.004);
  int rib = 0, part = 0;
  for (int v = 0; v < 160; ++v)
    for (int u = 0; u < 200; ++u) {
      const Eigen::Vector3d p = scene.X_CB.inverse() * scene.camera.unproject(u, v, scene.depth(u, v));
      if (on_rib(u, v)) {
        EXPECT_FALSE(scene.wanted(u, v)) << u << " " << v;
        ++rib;
      } else if (std::abs(p.x()) > 0.02 && std::abs(p.x()) < 0.14 && std::abs(p.y()) < 0.09) {
        EXPECT_TRUE(scene.wanted(u, v)) << u << " " << v;
        ++part;
      }
    }
  EXPECT_GT(rib, 500);
  EXPECT_GT(part, 5000);
}

}  // namespace
}  // namespace binpick

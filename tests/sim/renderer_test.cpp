// Every exact renderer against paper geometry and against the independent rasteriser of core.
#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "core/bin_spec.hpp"
#include "core/error.hpp"
#include "core/primitive.hpp"
#include "core/random.hpp"
#include "core/zbuffer.hpp"
#include "sim/depth_renderer.hpp"
#include "sim/visibility.hpp"

// Read by LeakSanitizer only: OSMesa never frees some 200 bytes of every context's window.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libOSMesa"; }

namespace binpick {
namespace {

PinholeCamera off_centre_camera() {
  PinholeCamera camera;
  camera.width = 320;
  camera.height = 200;
  camera.fx = 210;
  camera.fy = 225;
  camera.cx = 141.3;
  camera.cy = 118.6;
  return camera;
}

std::shared_ptr<const TriangleMesh> share(TriangleMesh mesh) {
  return std::make_shared<const TriangleMesh>(std::move(mesh));
}

RenderItem item(TriangleMesh mesh, const Pose& X_WO, std::int32_t id) {
  return {share(std::move(mesh)), X_WO, id, Material{0.5, 0, 0.3}};
}

Pose at(double x, double y, double z) {
  Pose X = Pose::Identity();
  X.translation() = Eigen::Vector3d(x, y, z);
  return X;
}

// The plane n . p = distance of C as two big triangles.
TriangleMesh wide_plane(const Eigen::Vector3d& normal, double distance, double reach) {
  const Eigen::Vector3d n = normal.normalized();
  const Eigen::Vector3d x = n.cross(Eigen::Vector3d::UnitY()).normalized(), y = n.cross(x), o = n * distance;
  return {{o - reach * x - reach * y, o + reach * x - reach * y, o + reach * x + reach * y, o - reach * x + reach * y},
          {{0, 1, 2}, {0, 2, 3}}};
}

class Renderer : public testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<DepthRenderer> renderer_ = make_renderer(GetParam());
};

TEST_P(Renderer, FrontalPlaneIsExactAtEveryPixel) {
  const PinholeCamera camera = off_centre_camera();
  RenderScene scene;
  scene.items = {item(wide_plane({0, 0, 1}, 0.6, 2), Pose::Identity(), 3)};
  const ExactFrame frame = renderer_->render(scene, camera, Pose::Identity(), 0.1, 2);
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    ASSERT_NEAR(frame.depth[i], 0.6, 1e-6) << i;
    ASSERT_EQ(frame.ids[i], 3);
    ASSERT_NEAR(frame.normals_C[i].z(), -1, 1e-6);
    ASSERT_EQ(frame.materials[frame.ids[i]].albedo, 0.5);
  }
}

TEST_P(Renderer, TiltedPlaneTellsTheCameraModel) {
  const PinholeCamera camera = off_centre_camera();
  const Eigen::Vector3d normal = Eigen::Vector3d(0.6, -0.4, -1).normalized();
  const Pose X_WC = at(0.3, -0.2, 1.1) * pose_from_xyz_rpy({0, 0, 0}, {2.5, 0.3, -0.7});
  RenderScene scene;
  scene.items = {item(wide_plane(normal, -0.7, 4), X_WC, 0)};  // the plane is given in C
  const ExactFrame frame = renderer_->render(scene, camera, X_WC, 0.1, 5);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      // Half a pixel of error in the pixel centre would be 1.5 mm here.
      const double z = -0.7 / normal.dot(camera.ray(u, v));
      ASSERT_NEAR(frame.depth(u, v), z, 3e-6 * z) << u << "," << v;
      ASSERT_LT((frame.normals_C(u, v).cast<double>() - normal).norm(), 1e-5);
    }
}

TEST_P(Renderer, NothingThereIsNan) {
  const ExactFrame frame = renderer_->render({}, off_centre_camera(), Pose::Identity(), 0.1, 2);
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    ASSERT_TRUE(std::isnan(frame.depth[i]));
    ASSERT_EQ(frame.ids[i], kIdNothing);
    ASSERT_EQ(frame.normals_C[i].norm(), 0.0f);
  }
}

// A plate lying flat under a camera that looks straight down: its outline is known to the pixel.
TEST_P(Renderer, FlatPlateCoversItsRectangle) {
  PinholeCamera camera = off_centre_camera();
  camera.fx = camera.fy = 200;
  camera.cx = 160.25;
  camera.cy = 100.25;
  const Pose X_WC = at(0, 0, 1.01) * pose_from_xyz_rpy({0, 0, 0}, {M_PI, 0, 0});
  RenderScene scene;
  scene.items = {item(mesh_of(Primitive::box({4, 4, 0.1})), at(0, 0, -0.05), kIdTable),
                 item(mesh_of(Primitive::box({0.3, 0.2, 0.01})), at(0, 0, 0.005), 0)};
  const ExactFrame frame = renderer_->render(scene, camera, X_WC, 0.1, 2);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const bool plate = std::abs(u - 160.25) < 30 && std::abs(v - 100.25) < 20;  // 200 px/m at z = 1
      ASSERT_EQ(frame.ids(u, v), plate ? 0 : kIdTable) << u << "," << v;
      ASSERT_NEAR(frame.depth(u, v), plate ? 1.0 : 1.01, 2e-6);
    }
}

TEST_P(Renderer, AgreesWithTheZBuffer) {
  const PinholeCamera camera;
  const Pose X_WC = at(0.05, -0.03, 0.65) * pose_from_xyz_rpy({0, 0, 0}, {M_PI - 0.1, 0.15, 0.4});
  RenderScene scene;
  TriangleMesh bin;
  for (const Primitive& box : bin_boxes(BinSpec{}, 0.005)) append(bin, mesh_of(box));
  scene.items.push_back(item(std::move(bin), Pose::Identity(), kIdBin));
  const auto ball = share(mesh_of(Primitive::sphere(0.04), 96));
  const auto can = share(mesh_of(Primitive::cylinder(0.03, 0.09), 96));
  Rng rng(Seed{7}.child("agreement").key);
  for (int i = 0; i < 14; ++i) {
    Pose X_WP = at(rng.uniform(-0.18, 0.18), rng.uniform(-0.13, 0.13), rng.uniform(0.03, 0.12));
    X_WP.linear() = rng.rotation().toRotationMatrix();
    scene.items.push_back({i % 2 ? ball : can, X_WP, i, Material{0.5, 0, 0.3}});
  }
  const ExactFrame frame = renderer_->render(scene, camera, X_WC, 0.1, 2);
  ZBuffer reference(camera, 0.1);
  for (const RenderItem& it : scene.items) reference.draw(*it.mesh_O, X_WC.inverse() * it.X_WO, it.id);
  std::size_t other_id = 0, far_off = 0, both = 0;
  double sum = 0;
  for (std::size_t i = 0; i < frame.ids.size(); ++i) {
    other_id += frame.ids[i] != reference.result().ids[i];
    if (frame.ids[i] == kIdNothing || frame.ids[i] != reference.result().ids[i]) continue;
    const double error = std::abs(frame.depth[i] - reference.result().depth[i]);
    far_off += error > 1e-5;
    sum += error;
    ++both;
  }
  ASSERT_GT(both, frame.ids.size() / 4);
  EXPECT_LT(other_id, frame.ids.size() / 2000);  // silhouettes: corners are rounded to 1/256 px there
  EXPECT_LT(far_off, frame.ids.size() / 2000);
  EXPECT_LT(sum / static_cast<double>(both), 1e-6);
}

TEST_P(Renderer, SameBitsAgainInAnotherContextAndInAnotherThread) {
  RenderScene scene;
  scene.items = {item(mesh_of(Primitive::sphere(0.1), 64), at(0.02, 0.01, 0.5), 1),
                 item(wide_plane({0.2, 0.1, 1}, 0.6, 2), Pose::Identity(), 2)};
  const auto draw = [&](DepthRenderer& r) { return r.render(scene, off_centre_camera(), Pose::Identity(), 0.1, 2); };
  const ExactFrame first = draw(*renderer_);
  const ExactFrame again = draw(*renderer_);
  ExactFrame elsewhere;
  std::thread([&] { elsewhere = draw(*make_renderer(GetParam())); }).join();
  const auto second_context = make_renderer(GetParam());
  const ExactFrame other = draw(*second_context);
  for (const ExactFrame* frame : std::initializer_list<const ExactFrame*>{&again, &other, &elsewhere}) {
    EXPECT_TRUE(std::equal(first.depth.begin(), first.depth.end(), frame->depth.begin()));
    EXPECT_TRUE(std::equal(first.ids.begin(), first.ids.end(), frame->ids.begin()));
  }
}

TEST_P(Renderer, SmallImageAfterALargeOneIsTheSame) {
  RenderScene scene;
  scene.items = {item(mesh_of(Primitive::sphere(0.1), 64), at(0.02, 0.01, 0.5), 1)};
  const ExactFrame first = renderer_->render(scene, off_centre_camera(), Pose::Identity(), 0.1, 2);
  renderer_->render(scene, PinholeCamera{}, Pose::Identity(), 0.1, 2);
  const ExactFrame after = renderer_->render(scene, off_centre_camera(), Pose::Identity(), 0.1, 2);
  EXPECT_TRUE(std::equal(first.ids.begin(), first.ids.end(), after.ids.begin()));
  for (std::size_t i = 0; i < first.depth.size(); ++i) {
    ASSERT_TRUE(first.depth[i] == after.depth[i] || (std::isnan(first.depth[i]) && std::isnan(after.depth[i])));
  }
}

// A mesh freed between two frames must not lend its address to the next one.
TEST_P(Renderer, FreedMeshesAreForgotten) {
  for (int i = 0; i < 20; ++i) {
    const double z = 0.4 + 0.01 * i;
    RenderScene scene;
    scene.items = {item(wide_plane({0, 0, 1}, z, 2), Pose::Identity(), i)};
    const ExactFrame frame = renderer_->render(scene, off_centre_camera(), Pose::Identity(), 0.1, 2);
    ASSERT_NEAR(frame.depth(10, 10), z, 1e-6);
  }
}

// ---- visibility
// --------------------------------------------------------------------------------------------------------

Visibility seen(DepthRenderer& renderer, const RenderScene& scene, const PinholeCamera& camera) {
  const ExactFrame frame = renderer.render(scene, camera, Pose::Identity(), 0.05, 3);
  return part_visibility(renderer, scene, frame, camera, Pose::Identity(), 1).at(0);
}

TEST_P(Renderer, HalfOccludedPlateIsHalfVisible) {
  PinholeCamera camera;
  camera.fx = camera.fy = 400;
  camera.cx = 400.5;
  camera.cy = 240.5;
  RenderScene scene;
  scene.items = {item(mesh_of(Primitive::box({0.5, 0.3, 0.01})), at(0, 0, 1.005), 0)};  // 200 x 120 px
  const Visibility alone = seen(*renderer_, scene, camera);
  EXPECT_EQ(alone.silhouette_pixels, 200 * 120);
  EXPECT_EQ(alone.visible_pixels, 200 * 120);
  scene.items.push_back(item(mesh_of(Primitive::box({1, 1, 0.01})), at(0.5, 0, 0.505), kIdArm));  // covers u > 400.5
  const Visibility half = seen(*renderer_, scene, camera);
  EXPECT_EQ(half.silhouette_pixels, 200 * 120);
  EXPECT_EQ(half.visible_pixels, 100 * 120);
  EXPECT_DOUBLE_EQ(half.fraction(), 0.5);
}

TEST_P(Renderer, WhatLiesOutsideTheImageCounts) {
  PinholeCamera camera;
  camera.fx = camera.fy = 400;
  camera.cx = 400.5;
  camera.cy = 240.5;
  RenderScene scene;
  // The plate spans u from -49.5 to 150.5: columns 0 .. 150 of 200 are in the image.
  scene.items = {item(mesh_of(Primitive::box({0.5, 0.3, 1e-4})), at(-0.875, 0, 1 + 0.5e-4), 0)};
  const Visibility part = seen(*renderer_, scene, camera);
  EXPECT_EQ(part.silhouette_pixels, 200 * 120);
  EXPECT_EQ(part.visible_pixels, 151 * 120);
  scene.items[0].X_WO = at(-4, 0, 1.005);
  EXPECT_EQ(seen(*renderer_, scene, camera).visible_pixels, 0);
}

TEST_P(Renderer, BuriedAndMissingPartsHaveFractionZero) {
  const PinholeCamera camera;
  RenderScene scene;
  scene.items = {item(mesh_of(Primitive::sphere(0.02)), at(0, 0, 0.8), 0),
                 item(mesh_of(Primitive::box({2, 2, 0.01})), at(0, 0, 0.5), kIdBin)};
  const ExactFrame frame = renderer_->render(scene, camera, Pose::Identity(), 0.05, 3);
  const auto result = part_visibility(*renderer_, scene, frame, camera, Pose::Identity(), 2);
  EXPECT_EQ(result[0].visible_pixels, 0);
  // A sphere's image is an ellipse; its area here differs from the circle's by less than 0.1 %.
  const double radius = 430.1 * 0.02 / std::sqrt(0.8 * 0.8 - 0.02 * 0.02);
  EXPECT_NEAR(result[0].silhouette_pixels, M_PI * radius * radius, 0.03 * M_PI * radius * radius);
  EXPECT_EQ(result[1].silhouette_pixels, 0);
  EXPECT_EQ(result[1].fraction(), 0);
}

TEST_P(Renderer, PictureHasTheSizeAndShowsTheParts) {
  PinholeCamera camera = off_centre_camera();
  RenderScene scene;
  scene.items = {item(mesh_of(Primitive::box({2, 2, 0.1})), at(0, 0, 0.8), kIdTable),
                 item(mesh_of(Primitive::sphere(0.1)), at(0, 0, 0.6), 0)};
  const Image<Rgb> picture = renderer_->picture(scene, camera, Pose::Identity());
  ASSERT_EQ(picture.width(), camera.width);
  ASSERT_EQ(picture.height(), camera.height);
  const Rgb part = picture(141, 118), table = picture(20, 20);
  EXPECT_GT(int{part[2]} - int{part[0]}, 20);              // part 0 is blue
  EXPECT_LT(std::abs(int{table[2]} - int{table[0]}), 20);  // the table is grey
}

INSTANTIATE_TEST_SUITE_P(Registry, Renderer, testing::ValuesIn(renderer_names()),
                         [](const auto& name) { return name.param; });

TEST(RendererNames, UnknownOnesSayWhatIsNear) {
  try {
    make_renderer("raycaster");
    FAIL();
  } catch (const SpecError& e) {
    EXPECT_NE(std::string(e.what()).find("'raycast'"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace binpick

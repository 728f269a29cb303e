#include "perception/scene_crop.hpp"

#include <gtest/gtest.h>

#include "perception/preprocess.hpp"
#include "tests/perception/scene_maker.hpp"

namespace binpick {
namespace {

using namespace testing_scene;

/// Any camera above the bin that sees it, some of them askew.
Pose looking_at_bin(Rng& rng) {
  const Pose above = camera_above(rng.uniform(0.5, 0.8));
  return pose_from(exp_so3(0.25 * rng.uniform() * rng.unit_vector()) * above.linear(),
                   above.translation() + Eigen::Vector3d(rng.uniform(-0.05, 0.05), rng.uniform(-0.05, 0.05), 0));
}

TEST(BinKernel, AgreesWithTheTransformedPoint) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Rng rng(seed);
    const PinholeCamera camera;
    const Pose X_CB = looking_at_bin(rng).inverse();
    const BinRays rays = bin_rays(camera, X_CB);
    const BinBox box{0.19f, 0.14f, 0.01f, 0.2f};
    std::vector<float> depth(static_cast<std::size_t>(camera.width));
    for (float& z : depth) z = rng.uniform() < 0.1 ? std::nanf("") : static_cast<float>(rng.uniform(0.3, 0.8));
    const int v = static_cast<int>(rng.below(480));
    std::vector<std::uint8_t> inside(depth.size());
    mark_inside({depth.data(), v, camera.width}, rays, box, inside.data());
    int first = -1, last = -1, low = camera.width, high = -1;
    const bool any = inside_span({depth.data(), v, camera.width}, rays, box, first, last);
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector3d p_B = X_CB.inverse() * camera.unproject(u, v, depth[u]);
      const double into = std::min(
          {box.half_x - std::abs(p_B.x()), box.half_y - std::abs(p_B.y()), p_B.z() - box.low, box.high - p_B.z()});
      if (std::abs(into) > 1e-6) {
        EXPECT_EQ(inside[u] != 0, into > 0) << "seed " << seed << " u " << u;
      }
      if (inside[u]) low = std::min(low, u), high = u;
    }
    EXPECT_EQ(any, high >= 0) << "seed " << seed;
    if (any) {
      EXPECT_EQ(first, low) << "seed " << seed;
      EXPECT_EQ(last, high) << "seed " << seed;
    }
  }
}

TEST(BinKernel, FloorDifferencesAreThoseOfTheRaysOnTheFloor) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Rng rng(seed);
    const PinholeCamera camera;
    const Pose X_CB = looking_at_bin(rng).inverse();
    const BinBox box{0.19f, 0.14f};
    const int v = static_cast<int>(rng.below(480)), stride = 1 + static_cast<int>(rng.below(3));
    std::vector<float> depth(static_cast<std::size_t>(camera.width)), out(depth.size());
    std::vector<double> expected(depth.size(), 0.0);
    int on_floor = 0, met = 0;
    const Eigen::Vector3d normal_C = X_CB.linear().col(2);
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector3d ray = camera.ray(u, v);
      const double floor = normal_C.dot(X_CB.translation()) / normal_C.dot(ray);
      const Eigen::Vector3d p_B = X_CB.inverse() * (floor * ray);
      const bool on = floor > 0 && std::abs(p_B.x()) <= box.half_x && std::abs(p_B.y()) <= box.half_y;
      expected[u] = on ? rng.uniform(-0.02, 0.02) : std::nan("");
      depth[u] = static_cast<float>(1 / (1 / floor + expected[u]));
      if (u % stride == 0) on_floor += on;
    }
    const int count =
        floor_differences({depth.data(), v, camera.width}, stride, bin_rays(camera, X_CB), box, out.data(), met);
    EXPECT_EQ(count, (camera.width + stride - 1) / stride);
    EXPECT_NEAR(met, on_floor, 2) << "seed " << seed;  // rounding at the two ends
    for (int k = 0; k < count; ++k)
      if (!std::isnan(out[k]) && !std::isnan(expected[k * stride])) {
        EXPECT_NEAR(out[k], expected[k * stride], 2e-6) << "seed " << seed;
      }
  }
}

TEST(SceneCrop, KeepsEveryWantedPixelAndItsPoint) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Rng rng(seed);
    const Part ring = ring_part();
    std::vector<Instance> heap = make_heap(ring, HeapOptions(), Seed{seed});
    heap.push_back({0, pose_from(Eigen::Matrix3d::Identity(), {0.14, 0.09, 0.28}), 0, 0});  // far above the rim
    const HeapScene photo = photograph(ring, heap, HeapOptions(), Seed{seed}, looking_at_bin(rng));
    const PixelBox box = pixels_of_bin(photo.frame, *photo.view.bin, photo.view.X_CB, 0.015, 0.15);
    const DepthFrame crop = cropped(photo.frame, box);
    EXPECT_LT(crop.depth.size(), photo.frame.depth.size());
    const Eigen::Vector3d half = photo.view.bin->inner_size / 2;
    const Pose X_BC = photo.view.X_CB.inverse();
    int wanted = 0, above = 0;
    for (int v = 0; v < photo.frame.depth.height(); ++v)
      for (int u = 0; u < photo.frame.depth.width(); ++u) {
        const float z = photo.frame.depth(u, v);
        if (!(z > 0)) continue;
        const Eigen::Vector3d p_B = X_BC * photo.frame.camera.unproject(u, v, z);
        if (std::abs(p_B.x()) >= half.x() || std::abs(p_B.y()) >= half.y() || p_B.z() < 0 || p_B.z() > 0.349) continue;
        ++wanted;
        above += p_B.z() > 0.2;
        ASSERT_TRUE(u >= box.u0 && u < box.u1 && v >= box.v0 && v < box.v1) << "seed " << seed << " " << u << " " << v;
        const int a = u - box.u0, b = v - box.v0;
        ASSERT_EQ(crop.depth(a, b), z);
        ASSERT_LT((crop.camera.unproject(a, b, z) - photo.frame.camera.unproject(u, v, z)).norm(), 1e-9);
      }
    EXPECT_GT(wanted, 20000) << "seed " << seed;
    EXPECT_GT(above, 500) << "seed " << seed;
  }
}

TEST(SceneCrop, IsTheWholeImageWhereTheBinReachesBehindTheCamera) {
  DepthFrame frame;
  frame.depth = Image<float>(frame.camera.width, frame.camera.height, 0.5f);
  const PixelBox box = pixels_of_bin(frame, BinSpec(), camera_above(0.1).inverse(), 0.015, 0.15);
  EXPECT_EQ(box.u1 - box.u0, frame.camera.width);
  EXPECT_EQ(box.v1 - box.v0, frame.camera.height);
}

}  // namespace
}  // namespace binpick

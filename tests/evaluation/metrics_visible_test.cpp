// VSD against the BOP toolkit's own figures, VSD and CUS of a plate that is shifted.
#include "evaluation/metrics_visible.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/evaluation/bop_cases.hpp"

namespace binpick {
namespace {

/// The disc of the toolkit's cases, as the file's note defines its image: the plane's depth where the hit lies within.
DistancePatch disc_patch(const PinholeCamera& camera, const Pose& X_CP, double radius) {
  DistancePatch patch;
  patch.rect = {0, 0, camera.width, camera.height};
  const Eigen::Vector3d normal_C = X_CP.linear().col(2);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector3d ray = camera.ray(u, v);
      const double z = normal_C.dot(X_CP.translation()) / normal_C.dot(ray);
      const bool hit = z > 0 && (z * ray - X_CP.translation()).norm() <= radius;
      patch.distance.push_back(hit ? z * ray.norm() : 0);
    }
  return patch;
}

TEST(Vsd, TheToolkitsFiguresAreReproduced) {
  const nlohmann::json vsd = examples::bop_cases()["vsd"];
  PinholeCamera camera = examples::bop_camera(vsd["K"]);
  camera.width = vsd["width"], camera.height = vsd["height"];
  VsdSettings settings;
  settings.delta = 1e-3 * vsd["delta"].get<double>();
  settings.taus = vsd["taus"].get<std::vector<double>>();
  std::size_t count = 0;
  for (const nlohmann::json& c : vsd["cases"]) {
    Image<double> seen(camera.width, camera.height, 0);
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const double z = 1e-3 * c["depth_test_row_major_mm"][i].get<double>();
      const int u = static_cast<int>(i) % camera.width, v = static_cast<int>(i) / camera.width;
      seen[i] = z * camera.ray(u, v).norm();
    }
    const std::vector<double> errors = vsd_errors(disc_patch(camera, examples::bop_pose(c["R_est"], c["t_est"]), 0.040),
                                                  disc_patch(camera, examples::bop_pose(c["R_gt"], c["t_gt"]), 0.040),
                                                  seen, 1e-3 * vsd["diameter"].get<double>(), settings);
    EXPECT_EQ(errors, c["errors"].get<std::vector<double>>()) << "case " << count;
    ++count;
  }
  EXPECT_EQ(count, 12u);
}

class Plate : public testing::Test {
 protected:
  Plate() {
    camera_.width = 200, camera_.height = 160, camera_.fx = camera_.fy = 400, camera_.cx = 99.5, camera_.cy = 79.5;
  }
  /// 100 x 60 mm square to the camera, 1 m away, `shift` to the right: 40 x 24 pixels.
  DistancePatch plate(const Eigen::Vector3d& shift) {
    const TriangleMesh mesh = mesh_of(Primitive::box({0.1, 0.06, 0.001}));
    return PatchRenderer(camera_).draw(mesh, examples::moved_to(shift.x(), shift.y(), 1.0005 + shift.z()));
  }
  Image<double> wall(float depth) { return ray_lengths(Image<float>(200, 160, depth), camera_); }
  PinholeCamera camera_;
};

TEST_F(Plate, ShiftedByAQuarterOfItself) {
  const DistancePatch truth = plate({0, 0, 0}), est = plate({0.025, 0, 0});  // 10 of 40 columns
  ASSERT_EQ(truth.rect.width() >= 40 && truth.rect.height() >= 24, true);
  EXPECT_DOUBLE_EQ(cus_error(est, truth), 20.0 / 50.0);
  // Where both are, the depth is the same: the error is what is not shared, whatever tau is.
  for (const double e : vsd_errors(est, truth, wall(1.5f), 0.12, {})) EXPECT_NEAR(e, 20.0 / 50.0, 1e-12);
  EXPECT_EQ(cus_error(truth, truth), 0);
}

TEST_F(Plate, MovedAwayIsWrongFromItsShareOfTheDiameterOn) {
  const DistancePatch truth = plate({0, 0, 0}), est = plate({0, 0, 0.024});
  VsdSettings settings;
  settings.taus = {0.19, 0.21};
  const std::vector<double> errors = vsd_errors(est, truth, wall(1.5f), 0.12, settings);  // a fifth of the diameter
  EXPECT_GT(errors[0], 0.9);
  EXPECT_LT(errors[1], 0.2);  // only the rim, where the farther plate is smaller
}

TEST_F(Plate, BehindSomethingElseItCountsAsInvisible) {
  const DistancePatch truth = plate({0, 0, 0}), est = plate({0, 0, 0});
  EXPECT_EQ(vsd_errors(est, truth, wall(0.5f), 0.12, {})[0], 1);           // nothing of it is seen
  EXPECT_EQ(vsd_errors(est, truth, wall(0.99f), 0.12, {})[0], 0);          // within delta
  EXPECT_EQ(vsd_errors(est, truth, wall(std::nanf("")), 0.12, {})[0], 0);  // no depth counts as visible
}

// Not visible in the image, but where the truth is visible the estimate is taken as visible too (ECCVW 2016, eq. 14).
TEST_F(Plate, AnEstimateBehindTheVisibleTruthIsCompared) {
  const DistancePatch truth = plate({0, 0, 0}), est = plate({0, 0, 0.1});
  VsdSettings settings;
  settings.taus = {0.9};
  EXPECT_LT(vsd_errors(est, truth, wall(1.0f), 0.12, settings)[0], 0.5);  // off by 0.83 diameters, which is let pass
  EXPECT_EQ(vsd_errors(est, plate({0.1, 0, 0.1}), wall(1.0f), 0.12, settings)[0], 1);
}

TEST_F(Plate, OutsideTheImageBothErrorsAreOne) {
  const DistancePatch nothing = plate({5, 0, 0});
  EXPECT_EQ(cus_error(nothing, nothing), 1);
  EXPECT_EQ(vsd_errors(nothing, nothing, wall(1.5f), 0.12, {})[0], 1);
}

}  // namespace
}  // namespace binpick

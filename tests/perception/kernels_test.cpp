// The wide kernels against their formulas, point by point, and the back half of the search on several threads.
#include <gtest/gtest.h>

#include <cstring>

#include "perception/icp_points.hpp"
#include "perception/part_refinement.hpp"
#include "perception/preprocess.hpp"
#include "tests/perception/scene_maker.hpp"

namespace binpick {
namespace {

using namespace testing_scene;

/// A noisy heap of brackets and a model of one.
struct Heap {
  Part part = bracket_part();
  SurfaceModel surface{part.mesh_P, 0.02 * part.diameter, 0.1 * part.diameter};
  HeapScene photo = make_scene(part, HeapOptions(), Seed{11}, camera_above(0.6));
  Scene scene = binpick::make_scene(photo.view, PreprocessConfig(), NormalsConfig(), 0.006);

  Pose near_instance(Rng& rng) const {
    std::vector<Instance> seen;
    std::copy_if(photo.instances.begin(), photo.instances.end(), std::back_inserter(seen),
                 [](const Instance& i) { return i.visible_fraction > 0.5; });
    const Instance& one = seen[rng.below(seen.size())];
    Vector6d twist;
    twist << 0.004 * rng.unit_vector(), 0.08 * rng.unit_vector();
    return photo.X_WC.inverse() * one.X_WP * exp_se3(twist);
  }
};

const Heap& heap() {
  static const Heap one;
  return one;
}

void fill(const Eigen::Isometry3f& X, float (&R)[9], float (&p)[3]) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) R[3 * row + column] = X.linear()(row, column);
    p[row] = X.translation()[row];
  }
}

/// The second point of the pair in the grid.
int other_side(const SurfaceGrid& grid, const Eigen::Vector3f& p) {
  int c[3];
  for (int k = 0; k < 3; ++k) c[k] = static_cast<int>((p[k] - grid.low[k]) * grid.inverse_cell);
  return grid.cells[2 * ((c[2] * grid.size[1] + c[1]) * grid.size[0] + c[0]) + 1];
}

TEST(SurfaceKernel, AddsUpThePlainNormalEquations) {
  const Heap& h = heap();
  Rng rng = Seed{3}.rng();
  int compared = 0;
  for (int trial = 0; trial < 30; ++trial) {
    const Pose X_CP = h.near_instance(rng);
    const IcpPoints points(h.scene, h.surface, X_CP, 0.01, 300 + 17 * trial);
    const ScenePointsView view = points.view();
    ASSERT_EQ(view.count % 8, 0);
    const Eigen::Isometry3f X_PC = X_CP.inverse().cast<float>();
    const Eigen::Vector3f eye = X_PC.translation();
    SurfaceQuery query;
    fill(X_PC, query.R_PC, query.p_PC);
    query.view = h.surface.view_of((eye - h.surface.center()).normalized());
    query.gate = 0.006f * 0.006f, query.sideways = 0.007f * 0.007f, query.agreement = 0.5f, query.scale = 0.001f;
    SurfaceSums sums;
    add_surface_points(view, h.surface.grid(), query, sums);

    Matrix6d A = Matrix6d::Zero();
    Vector6d b = Vector6d::Zero();
    double count = 0, sum_abs = 0, weighted_squares = 0;
    for (int i = 0; i < view.count; ++i) {
      const Eigen::Vector3f p_C(view.x[i], view.y[i], view.z[i]), s_C(view.nx[i], view.ny[i], view.nz[i]);
      if (!p_C.allFinite()) continue;
      const Eigen::Vector3f p = X_PC * p_C;
      int k = h.surface.nearest(p);
      if (k < 0) continue;
      if (!h.surface.visible(static_cast<std::size_t>(k), query.view)) k = other_side(h.surface.grid(), p);
      if (k < 0 || !h.surface.visible(static_cast<std::size_t>(k), query.view)) continue;
      const Eigen::Vector3d q = h.surface.points()[k].cast<double>(), n = h.surface.normals()[k].cast<double>();
      const Eigen::Vector3d off = p.cast<double>() - q;
      const double r = n.dot(off), x = r / (1.5 * query.scale);
      if (n.dot(eye.cast<double>() - q) <= 0 || r * r > query.gate) continue;
      if (off.squaredNorm() - r * r > query.sideways) continue;
      if (!s_C.isZero() && n.dot((X_PC.linear() * s_C).cast<double>()) < query.agreement) continue;
      Vector6d a;
      a << n, p.cast<double>().cross(n);
      const double w = 1 / (query.scale * query.scale * (1 + x * x));
      A += w * a * a.transpose();
      b += w * r * a;
      count += 1;
      sum_abs += std::abs(r);
      weighted_squares += w * r * r;
    }
    if (count < 30) continue;  // a part on edge
    ++compared;
    // A point right on a gate may fall to either side in float.
    ASSERT_NEAR(sums.points, count, 1) << trial;
    const double tolerance = 2e-5 + 2 * std::abs(sums.points - count) / count;
    for (int row = 0, t = 0; row < 6; ++row) {
      for (int column = 0; column <= row; ++column, ++t)
        EXPECT_NEAR(sums.A[t], A(row, column), tolerance * std::sqrt(A(row, row) * A(column, column))) << trial;
      EXPECT_NEAR(sums.b[row], b[row], tolerance * std::sqrt(A(row, row) * weighted_squares))
          << trial;  // b is a scalar product
    }
    EXPECT_NEAR(sums.sum_abs, sum_abs, tolerance * count * 0.006);
  }
  EXPECT_GE(compared, 20);
}

TEST(SurfaceKernel, PointsBeyondTheGridOrUnknownCountForNothing) {
  const Heap& h = heap();
  const float far = 5, nan = std::numeric_limits<float>::quiet_NaN();
  const float x[8] = {far, -far, 0, 0, 0, 0, nan, nan}, y[8] = {0, 0, far, -far, 0, 0, nan, 0},
              z[8] = {0, 0, 0, 0, far, -far, nan, nan}, none[8] = {};
  SurfaceQuery query;
  fill(Eigen::Isometry3f::Identity(), query.R_PC, query.p_PC);
  query.gate = query.sideways = 100;
  SurfaceSums sums;
  add_surface_points({x, y, z, none, none, none, 8}, h.surface.grid(), query, sums);
  EXPECT_EQ(sums.points, 0);
  for (const double a : sums.A) EXPECT_EQ(a, 0);
  for (const double b : sums.b) EXPECT_EQ(b, 0);
}

/// The formula of hypothesis_check.hpp, one point after the other.
CheckCounts plain_rays(const Scene& scene, const SurfaceModel& model, const Pose& X_CP, const CheckConfig& config) {
  const Eigen::Isometry3f X = X_CP.cast<float>();
  const auto& seen = model.seen_from(model.view_of((X.inverse().translation() - model.center()).normalized()));
  CheckCounts out;
  for (std::size_t k = 0; k < std::min<std::size_t>(seen.size(), (config.points + 7) / 8 * 8); ++k) {
    const Eigen::Vector3f p = X * model.points()[seen[k]], n = X.linear() * model.normals()[seen[k]];
    const float facing = -n.dot(p) / p.norm();
    if (!(p.z() > 0) || !(facing > 0.05f)) continue;
    out.tried += facing;
    const int u = static_cast<int>(std::lround(p.x() / p.z() * scene.camera.fx + scene.camera.cx));
    const int v = static_cast<int>(std::lround(p.y() / p.z() * scene.camera.fy + scene.camera.cy));
    const float depth = scene.depth.contains(u, v) ? scene.depth(u, v) : std::numeric_limits<float>::quiet_NaN();
    const float tolerance = depth_tolerance(scene, p.z(), config) / std::max(0.35f, facing);
    if (std::isnan(depth)) {
      out.unknown += facing;
    } else if (depth - p.z() > tolerance) {
      out.through += facing;
    } else if (depth - p.z() < -tolerance) {
      out.occluded += facing;
    } else if (!scene.wanted(u, v)) {
      out.unknown += facing;
    } else {
      const Eigen::Vector3f& s = scene.normals(u, v);
      (s.isZero() || s.dot(n) >= std::cos(config.normal_tolerance) ? out.inliers : out.off) += facing;
    }
  }
  return out;
}

TEST(RayKernel, CountsWhatTheFormulaCounts) {
  const Heap& h = heap();
  Rng rng = Seed{5}.rng();
  double moved = 0;
  for (int trial = 0; trial < 200; ++trial) {
    Pose X_CP = h.near_instance(rng);
    if (trial % 4 == 1) X_CP.translation() += 0.03 * rng.unit_vector();
    if (trial % 4 == 2) X_CP.translation().x() += 0.4;  // partly outside the image
    if (trial % 8 == 3) X_CP.translation().z() = -0.5;  // behind the camera
    const CheckConfig config;
    const CheckCounts wide = check_rays(h.scene, h.surface, X_CP, config);
    const CheckCounts plain = plain_rays(h.scene, h.surface, X_CP, config);
    EXPECT_NEAR(wide.tried, plain.tried, 1e-4f * plain.tried) << trial;
    // A point that projects onto the border of two pixels may be read from either.
    const float one_point = 1.0f + 1e-4f * plain.tried;
    EXPECT_NEAR(wide.inliers, plain.inliers, one_point) << trial;
    EXPECT_NEAR(wide.through, plain.through, one_point) << trial;
    EXPECT_NEAR(wide.occluded, plain.occluded, one_point) << trial;
    EXPECT_NEAR(wide.unknown, plain.unknown, one_point) << trial;
    EXPECT_NEAR(wide.off, plain.off, one_point) << trial;
    moved += std::abs(wide.inliers - plain.inliers) > 1e-4f * plain.tried;
  }
  EXPECT_LE(moved, 10);
}

template <class T>
void expect_same_bits(const T& a, const T& b, const std::string& where) {
  EXPECT_EQ(std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())), 0) << where;
}

TEST(PartRefinement, AnswersAlikeOnAnyNumberOfThreads) {
  const Heap& h = heap();
  PpfSettings settings;
  PreparedPart part;
  part.diameter = h.part.diameter;
  part.surface = h.surface;
  part.center_P = h.part.box_center_P;
  Rng rng = Seed{9}.rng();
  std::vector<PoseHypothesis> voted;
  for (int k = 0; k < 120; ++k) voted.push_back({h.near_instance(rng), 1.0 * k});
  std::vector<Candidate> first;
  std::vector<PoseHypothesis> first_verified;
  for (const int threads : {1, 2, 3, 7}) {
    Scene scene = h.scene;
    scene.threads = threads;
    const std::vector<PoseHypothesis> verified = verified_poses(scene, part, voted, settings);
    const std::vector<Candidate> found = refined_poses(scene, part, verified, settings);
    if (threads == 1) {
      first = found;
      first_verified = verified;
      ASSERT_GE(first.size(), 5u);
    }
    ASSERT_EQ(verified.size(), first_verified.size());
    for (std::size_t i = 0; i < verified.size(); ++i)
      expect_same_bits(verified[i].X_CP.matrix(), first_verified[i].X_CP.matrix(), "verified");
    ASSERT_EQ(found.size(), first.size()) << threads << " threads";
    for (std::size_t i = 0; i < found.size(); ++i) {
      expect_same_bits(found[i].fit.X_CP.matrix(), first[i].fit.X_CP.matrix(), "pose");
      expect_same_bits(found[i].fit.covariance, first[i].fit.covariance, "covariance");
      EXPECT_EQ(found[i].check.explained, first[i].check.explained);
    }
  }
}

}  // namespace
}  // namespace binpick

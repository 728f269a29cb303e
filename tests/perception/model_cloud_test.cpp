#include "perception/model_cloud.hpp"

#include <gtest/gtest.h>

#include <set>

#include "core/part.hpp"
#include "perception/edge_points.hpp"
#include "perception/hidden_points.hpp"
#include "perception/surface_model.hpp"
#include "tests/perception/scene_maker.hpp"

namespace binpick {
namespace {

using testing_scene::bearing_with_balls;
using testing_scene::ring_mesh;

std::set<std::size_t> as_set(const std::vector<std::size_t>& v) { return {v.begin(), v.end()}; }

/// HPR against the truth along rays: shares of visible points kept and of hidden points let through.
std::pair<double, double> against_rays(const TriangleMesh& mesh, const Eigen::Vector3d& eye, double spacing) {
  const PointCloud cloud = sample_surface(mesh, spacing, Seed{3});
  const auto kept = as_set(visible_points(cloud.points, eye, ModelCloudConfig().radius_factor));
  const MeshQuery query(mesh);
  int visible = 0, visible_kept = 0, hidden = 0, hidden_kept = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d to_eye = eye - cloud.points[i], direction = to_eye.normalized();
    const double facing = cloud.normals[i].dot(direction);
    if (std::abs(facing) < 0.15) continue;  // grazing points are nobody's truth
    const bool free = facing > 0 && !query.ray(cloud.points[i] + 1e-6 * cloud.normals[i], direction, to_eye.norm());
    (free ? visible : hidden) += 1;
    (free ? visible_kept : hidden_kept) += static_cast<int>(kept.count(i));
  }
  return {static_cast<double>(visible_kept) / visible, static_cast<double>(hidden_kept) / hidden};
}

TEST(HiddenPoints, AgreeWithRaysOnASphereABoxAndARing) {
  const Eigen::Vector3d above(0, 0, 0.2), aslant(0.12, 0.05, 0.15);
  const std::vector<TriangleMesh> meshes = {mesh_of(Primitive::sphere(0.05), 96),
                                            mesh_of(Primitive::box({0.1, 0.06, 0.04})), ring_mesh(0.035, 0.05, 0.016)};
  for (std::size_t m = 0; m < meshes.size(); ++m)
    for (const Eigen::Vector3d& eye : {above, aslant}) {
      const auto [kept, leaked] = against_rays(meshes[m], eye, 0.002);
      EXPECT_GT(kept, 0.95) << "mesh " << m << " eye " << eye.transpose();
      EXPECT_LT(leaked, 0.05) << "mesh " << m << " eye " << eye.transpose();
    }
}

TEST(HiddenPoints, TooFewPointsAreAllReturned) {
  const std::vector<Eigen::Vector3d> three = {{0, 0, 1}, {0.1, 0, 1}, {0, 0.1, 1}};
  EXPECT_EQ(visible_points(three, Eigen::Vector3d::Zero(), 100).size(), 3u);
  EXPECT_TRUE(visible_points({}, Eigen::Vector3d::Zero(), 100).empty());
}

TEST(ModelCloud, BallsInsideABearingVanish) {
  const TriangleMesh mesh = bearing_with_balls();
  const PointCloud all = sample_surface(mesh, 0.002, Seed{1}), seen = model_cloud(mesh, 0.1013, ModelCloudConfig());
  const auto inside = [](const PointCloud& cloud) {
    return std::count_if(cloud.points.begin(), cloud.points.end(), [](const Eigen::Vector3d& p) {
      return std::abs(p.head<2>().norm() - 0.0425) < 0.0055 && std::abs(p.z()) < 0.006;
    });
  };
  EXPECT_GT(inside(all), 500);  // the balls are there
  EXPECT_LT(static_cast<double>(inside(seen)), 0.01 * static_cast<double>(seen.size()));
  const SurfaceModel surface(mesh, 0.002, 0.008);
  for (const Eigen::Vector3f& p : surface.points())
    EXPECT_FALSE(std::abs(p.head<2>().norm() - 0.0425f) < 0.0055f && std::abs(p.z()) < 0.006f) << p.transpose();
  const std::size_t outer = ring_mesh(0.035, 0.05, 0.016).triangles.size();
  EXPECT_GE(surface.shell().triangles.size(), outer);
  EXPECT_LT(surface.shell().triangles.size(), outer + (mesh.triangles.size() - outer) / 20);  // hardly any of a ball's
}

TEST(ModelCloud, EveryOuterFaceOfTheRingIsCovered) {
  const PointCloud seen = model_cloud(ring_mesh(0.035, 0.05, 0.016), 0.1013, ModelCloudConfig());
  int top = 0, bottom = 0, outer = 0, bore = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Eigen::Vector3d &p = seen.points[i], &n = seen.normals[i];
    top += n.z() > 0.9, bottom += n.z() < -0.9;
    if (std::abs(n.z()) < 0.1) (n.head<2>().dot(p.head<2>()) > 0 ? outer : bore) += 1;
  }
  // Areas 4006 mm^2 a face, 5027 and 3519 mm^2 the walls, one point on about 4.1 mm^2.
  EXPECT_GT(top, 850);
  EXPECT_GT(bottom, 850);
  EXPECT_GT(outer, 900);
  EXPECT_GT(bore, 500);
}

TEST(ModelCloud, NoPointOfTheBearingOfTheAssetsLiesInside) {
  const Part bearing = load_part(read_part_spec(BINPICK_SOURCE_DIR "/assets/parts/bearing_6914/part.yaml"));
  const PointCloud seen = model_cloud(bearing.mesh_P, bearing.diameter, ModelCloudConfig());
  ASSERT_GT(seen.size(), 1000u);
  const auto deep = std::count_if(seen.points.begin(), seen.points.end(), [](const Eigen::Vector3d& p) {
    const double r = p.head<2>().norm();  // seals lie up to 2 mm under the faces
    return r > 0.038 && r < 0.047 && std::abs(p.z()) < 0.005;
  });
  EXPECT_LT(static_cast<double>(deep), 0.01 * static_cast<double>(seen.size()));
}

TEST(SurfaceModel, NearestAnswersWithinTheReachOnly) {
  const SurfaceModel model(mesh_of(Primitive::box({0.1, 0.06, 0.04})), 0.002, 0.01);
  const int top = model.nearest({0.01f, 0.01f, 0.025f});
  ASSERT_GE(top, 0);
  EXPECT_NEAR(model.points()[top].z(), 0.02f, 1e-6f);
  EXPECT_NEAR(model.normals()[top].z(), 1.0f, 1e-6f);
  EXPECT_LT((model.points()[top] - Eigen::Vector3f(0.01f, 0.01f, 0.02f)).norm(), 0.004f);
  EXPECT_EQ(model.nearest({0, 0, 0.2f}), -1);
  EXPECT_EQ(model.nearest({0, 0, 0}), -1);  // 20 mm from any face
}

TEST(EdgePoints, OfABoxLieOnItsEdgesAndPointOffTheirFaces) {
  const TriangleMesh box = mesh_of(Primitive::box({0.1, 0.06, 0.04}));
  const PointCloud outside = sample_surface(box, 0.002, Seed{1});
  const PointCloud edges = model_edges(box, outside, 0.004);
  ASSERT_GT(edges.size(), 200u);  // 800 mm of edges, two faces each, 4 mm apart: about 400
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Eigen::Array3d off = Eigen::Array3d(0.05, 0.03, 0.02) - edges.points[i].array().abs();
    int on = 0, outward = 0;
    for (int k = 0; k < 3; ++k) {
      on += std::abs(off[k]) < 0.0025;
      outward += edges.normals[i][k] * edges.points[i][k] > 0 && std::abs(edges.normals[i][k]) > 0.7;
    }
    EXPECT_GE(on, 2) << edges.points[i].transpose();
    EXPECT_EQ(outward, 1) << edges.normals[i].transpose();
  }
}

}  // namespace
}  // namespace binpick

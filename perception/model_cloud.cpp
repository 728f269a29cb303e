#include "perception/model_cloud.hpp"

#include <array>

#include "core/error.hpp"
#include "core/mesh_properties.hpp"
#include "core/parallel.hpp"
#include "core/sample_surface.hpp"
#include "perception/hidden_points.hpp"

namespace binpick {
namespace {

constexpr int kThreads = 2;  // for the six views, put together by view

}  // namespace

void ModelCloudConfig::visit(ConfigVisitor& v) {
  v.field("spacing", spacing, Unit::kNone, "distance of the samples of the CAD surface, of the part's diameter");
  v.field("view_distance", view_distance, Unit::kNone, "distance of the six viewpoints from the part, of its diameter");
  v.field("radius_factor", radius_factor, Unit::kNone, "hidden-point removal: sphere radius / largest distance");
  v.field("covisible", covisible, "of the model's pairs only those whose two points some view shows together");
}

void ModelCloudConfig::validate() const {
  if (!(spacing >= 0.002 && spacing <= 0.1)) throw SpecError("model.spacing: must lie between 0.002 and 0.1");
  if (!(view_distance >= 0.6 && view_distance <= 100))
    throw SpecError("model.view_distance: must lie between 0.6 and 100");
  if (!(radius_factor > 1 && radius_factor <= 1e5)) throw SpecError("model.radius_factor: must lie between 1 and 1e5");
}

PointCloud model_cloud(const TriangleMesh& mesh_P, double diameter, const ModelCloudConfig& config) {
  const PointCloud all_P = sample_surface(mesh_P, config.spacing * diameter, Seed{0x6d6f64656cull});
  const Eigen::Vector3d center_P = bounding_box(mesh_P).center();
  std::array<std::vector<std::size_t>, 6> seen_by;
  parallel_for(seen_by.size(), kThreads, [&](std::size_t k) {
    const double side = k % 2 == 0 ? -1 : 1;
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(static_cast<Eigen::Index>(k / 2));
    const Eigen::Vector3d eye_P = center_P + side * config.view_distance * diameter * axis;
    for (const std::size_t i : visible_points(all_P.points, eye_P, config.radius_factor))
      // What is on the hull but turned away is the far wall of a bore seen between samples: not visible.
      if (all_P.normals[i].dot(eye_P - all_P.points[i]) > 0) seen_by[k].push_back(i);
  });
  std::vector<char> seen(all_P.size(), 0);
  for (const std::vector<std::size_t>& view : seen_by)
    for (const std::size_t i : view) seen[i] = 1;
  PointCloud model_P;
  for (std::size_t i = 0; i < all_P.size(); ++i) {
    if (!seen[i]) continue;
    model_P.points.push_back(all_P.points[i]);
    model_P.normals.push_back(all_P.normals[i]);
  }
  return model_P;
}

}  // namespace binpick

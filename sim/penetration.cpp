#include "sim/penetration.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "core/bin_mesh.hpp"
#include "core/check.hpp"
#include "core/sample_surface.hpp"
#include "sim/bin.hpp"

namespace binpick {
namespace {

constexpr double kSharp = 0.35;  // rad between the normals of two faces: their edge is sampled, it digs deepest

using Edge = std::pair<std::uint32_t, std::uint32_t>;

Eigen::Vector3d normal_of(const TriangleMesh& mesh, std::size_t triangle) {
  const auto& t = mesh.triangles[triangle];
  const Eigen::Vector3d& a = mesh.vertices[t[0]];
  return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).normalized();
}

/// Points along the sharp edges, `spacing` apart, ends included.
void add_sharp_edges(const TriangleMesh& mesh, double spacing, std::vector<Eigen::Vector3d>& samples) {
  std::map<Edge, std::vector<std::size_t>> sides;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[i][k], b = mesh.triangles[i][(k + 1) % 3];
      sides[{std::min(a, b), std::max(a, b)}].push_back(i);
    }
  for (const auto& [edge, triangles] : sides) {
    const bool flat =
        triangles.size() == 2 && normal_of(mesh, triangles[0]).dot(normal_of(mesh, triangles[1])) > std::cos(kSharp);
    if (flat) continue;
    const Eigen::Vector3d &a = mesh.vertices[edge.first], &b = mesh.vertices[edge.second];
    const int steps = std::max(1, static_cast<int>(std::ceil((b - a).norm() / spacing)));
    for (int i = 0; i <= steps; ++i) samples.push_back(a + (b - a) * i / steps);
  }
}

/// Depth of a point in a box, 0 outside.
double depth_in(const Primitive& box, const Eigen::Vector3d& p_B) {
  const Eigen::Vector3d p_S = box.X_OS.inverse() * p_B;
  return std::max(0.0, (box.size / 2 - p_S.cwiseAbs()).minCoeff());
}

double pressing_force(const World& world, BodyId a, BodyId b) {
  for (const World::BodyContact& contact : world.contacts(a))
    if (contact.other == b) return contact.force;
  return 0;
}

/// Of every solid in the bin: the true mesh of one from CAD, else the boxes that collide.
void add_bin_depths(std::span<const SolidProbe* const> probes, const BinSpec& bin, std::span<const Pose> X_BP,
                    std::vector<double>& depths) {
  constexpr double kCoarse = 0.05;  // m: the bin's own samples are not asked for
  std::optional<SolidProbe> solid;
  if (!bin.mesh.empty()) {
    BinSpec loaded = bin;
    loaded.load();
    solid.emplace(loaded.solid->mesh_B, kCoarse);
  }
  const std::vector<Primitive> boxes = bin_boxes(bin, kThickWall);
  for (std::size_t i = 0; i < probes.size(); ++i) {
    const double depth = solid ? solid->deepest_of(*probes[i], X_BP[i]) : probes[i]->deepest_in(boxes, X_BP[i]);
    if (depth > 0) depths.push_back(depth);
  }
}

}  // namespace

SolidProbe::SolidProbe(const TriangleMesh& closed_mesh_P, double spacing)
    : query_(closed_mesh_P), box_P_(bounding_box(closed_mesh_P)), center_P_(box_P_.center()) {
  samples_P_ = sample_surface(closed_mesh_P, spacing, Seed{0}.child("penetration")).points;
  add_sharp_edges(closed_mesh_P, spacing / 2, samples_P_);
  for (const Eigen::Vector3d& v : closed_mesh_P.vertices) radius_ = std::max(radius_, (v - center_P_).norm());
}

/// Parity along a skew direction, so that no ray runs in a face of a machined part.
bool SolidProbe::contains(const Eigen::Vector3d& p_P) const {
  const Eigen::Vector3d direction = Eigen::Vector3d(0.2719, 0.4637, 0.8431).normalized();
  const double step = 1e-9;  // m past a crossing
  Eigen::Vector3d origin = p_P;
  bool odd = false;
  for (int crossings = 0; crossings < 256; ++crossings) {
    const auto hit = query_.ray(origin, direction, 3 * radius_);
    if (!hit) break;
    odd = !odd;
    origin = hit->point + step * direction;
  }
  return odd;
}

bool SolidProbe::far_from(const SolidProbe& other, const Pose& X_PO) const {
  return (X_PO * other.center_P_ - center_P_).norm() > radius_ + other.radius_;
}

double SolidProbe::deepest_of(const SolidProbe& other, const Pose& X_PO) const {
  double deepest = 0;
  for (const Eigen::Vector3d& sample_O : other.samples_P_) {
    const Eigen::Vector3d p_P = X_PO * sample_O;
    if (!box_P_.contains(p_P)) continue;
    const auto surface = query_.closest(p_P, kDeepest);
    // The nearest face decides on the side; parity is asked where it would matter, an edge can mislead the face.
    if (!surface || surface->distance <= deepest || (p_P - surface->point).dot(surface->normal) >= 0) continue;
    if (contains(p_P)) deepest = surface->distance;
  }
  return deepest;
}

double SolidProbe::deepest_in(std::span<const Primitive> boxes_B, const Pose& X_BP) const {
  double deepest = 0;
  for (const Eigen::Vector3d& sample_P : samples_P_) {
    const Eigen::Vector3d p_B = X_BP * sample_P;
    for (const Primitive& box : boxes_B) deepest = std::max(deepest, depth_in(box, p_B));
  }
  return deepest;
}

std::vector<double> penetrations(const World& world, std::span<const BodyId> bodies,
                                 std::span<const SolidProbe* const> probes, const BinSpec& bin, const Pose& X_WB) {
  BP_CHECK(bodies.size() == probes.size());
  std::vector<double> depths;
  const auto add = [&](double depth, double force) {
    if (depth > 0 || force > 0) depths.push_back(depth);
  };
  std::vector<Pose> X_WP;
  for (const BodyId body : bodies) X_WP.push_back(world.pose(body));
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (std::size_t j = i + 1; j < bodies.size(); ++j) {
      const Pose X_ij = X_WP[i].inverse() * X_WP[j];
      if (probes[i]->far_from(*probes[j], X_ij)) continue;
      const double depth =
          std::max(probes[i]->deepest_of(*probes[j], X_ij), probes[j]->deepest_of(*probes[i], X_ij.inverse()));
      add(depth, pressing_force(world, bodies[i], bodies[j]));
    }
  for (std::size_t i = 0; i < bodies.size(); ++i) X_WP[i] = X_WB.inverse() * X_WP[i];
  add_bin_depths(probes, bin, X_WP, depths);
  return depths;
}

}  // namespace binpick

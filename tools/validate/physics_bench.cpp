#include "tools/validate/physics_bench.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/convex_hull.hpp"
#include "core/parallel.hpp"
#include "sim/settle.hpp"

namespace binpick {
namespace {

constexpr double kFloor = 40;        // m, side of the floor: a rolling cylinder needs room
constexpr double kAluminium = 2700;  // kg/m^3
constexpr int kQuickShare = 6;       // the quick form throws a sixth as often per seed
constexpr int kFacets = 32;          // of a cylinder: 64 corners, as many as a hull may have

double lowest(const std::vector<Eigen::Vector3d>& points_P, const Eigen::Matrix3d& R_WP) {
  double z = INFINITY;
  for (const Eigen::Vector3d& p : points_P) z = std::min(z, R_WP.row(2).dot(p));
  return z;
}

std::vector<Eigen::Vector3d> face_normals(const CollisionShape& shape) {
  std::vector<Eigen::Vector3d> points;
  for (const TriangleMesh& piece : shape.pieces_P)
    points.insert(points.end(), piece.vertices.begin(), piece.vertices.end());
  for (const Primitive& solid : shape.solids_P)
    for (const Eigen::Vector3d& v : mesh_of(solid).vertices) points.push_back(v);
  const TriangleMesh hull = convex_hull(points);
  std::vector<Eigen::Vector3d> normals;
  for (const auto& t : hull.triangles) {
    const Eigen::Vector3d& a = hull.vertices[t[0]];
    const Eigen::Vector3d n = (hull.vertices[t[1]] - a).cross(hull.vertices[t[2]] - a);
    if (n.norm() > 1e-14) normals.push_back(n.normalized());
  }
  return normals;
}

/// How a body lies on the floor.
class RestJudge {
 public:
  explicit RestJudge(const Solid& solid)
      : corners_P(hull_vertices(solid.part.mesh_P)), normals_P_(face_normals(solid.shape)) {
    if (solid.part.symmetry.axis) axis_P_ = solid.part.symmetry.axis->direction_P;
  }
  Rest judge(bool at_rest, const Pose& X_WP, double scale) const {
    Rest rest{at_rest, X_WP, std::numbers::pi, 0};
    const Eigen::Vector3d down_P = -X_WP.linear().row(2).transpose();
    for (const Eigen::Vector3d& n : normals_P_) rest.tilt = std::min(rest.tilt, between(n, down_P));
    rest.gap = (lowest(corners_P, X_WP.linear()) + X_WP.translation().z()) / scale;
    return rest;
  }
  const std::vector<Eigen::Vector3d> corners_P;

 private:
  /// A round part may lie on any line of its side: its facets are turned about its axis as is best.
  double between(const Eigen::Vector3d& normal_P, const Eigen::Vector3d& down_P) const {
    const auto angle = [](double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)); };
    if (axis_P_) return std::abs(angle(normal_P.dot(*axis_P_)) - angle(down_P.dot(*axis_P_)));
    return angle(normal_P.dot(down_P));
  }
  const std::vector<Eigen::Vector3d> normals_P_;
  std::optional<Eigen::Vector3d> axis_P_;
};

Rest throw_judged(const Solid& solid, const RestJudge& judge, const ThrowSetting& setting, Rng& rng) {
  const double s = setting.scale;
  World world(setting.physics);
  const Primitive floor = Primitive::box({kFloor * s, kFloor * s, s}, Pose(Eigen::Translation3d(0, 0, -s / 2)));
  world.add_fixed({&floor, 1}, Pose::Identity(), {setting.friction, setting.restitution});
  const Eigen::Matrix3d R_WP = rng.rotation().toRotationMatrix();
  const double z = s * setting.height - lowest(judge.corners_P, R_WP);
  Part part = solid.part;
  part.friction = setting.friction, part.restitution = setting.restitution;
  const BodyId body = world.add_free(part, solid.shape, pose_from(R_WP, {0, 0, z}));
  world.set_velocity(body, Eigen::Vector3d::Zero(), setting.spin * rng.unit_vector());
  SettleConfig settle;
  settle.motion *= s;
  const bool at_rest = settle_report(world, settle).at_rest;
  return judge.judge(at_rest, world.pose(body), s);
}

}  // namespace

Solid finished(Part part, const PhysicsSetting& setting) {
  part.envelope_P = part.mesh_P;
  part.density = kAluminium;
  part.mass = mass_properties(part.mesh_P, part.density);
  part.diameter = mesh_diameter(part.mesh_P);
  part.box_center_P = bounding_box(part.mesh_P).center();
  CollisionShape shape = setting.shape(part);
  return {std::move(part), std::move(shape)};
}

Part cuboid_part(const Eigen::Vector3d& edges) {
  Part part;
  part.name = "cuboid";
  part.mesh_P = mesh_of(Primitive::box(edges));
  part.pieces_P = {part.mesh_P};
  return part;
}

Part cylinder_part(double diameter, double height) {
  Part part;
  part.name = "cylinder";
  const double angle = 2 * std::numbers::pi / kFacets;
  const double radius = diameter / 2 * std::sqrt(angle / std::sin(angle));
  part.mesh_P = mesh_of(Primitive::cylinder(radius, height), kFacets);
  part.pieces_P = {part.mesh_P};
  part.symmetry = make_symmetry({.type = "revolution"});
  return part;
}

Solid ball(double radius, double density, double off) {
  Solid solid;
  Part& part = solid.part;
  part.name = "ball";
  part.mesh_P = part.envelope_P = mesh_of(Primitive::sphere(radius));
  part.density = density;
  part.diameter = 2 * radius;
  part.mass.volume = 4 * std::numbers::pi / 3 * std::pow(radius, 3);
  part.mass.mass = density * part.mass.volume;
  part.mass.center_P = {0, 0, -off};
  part.mass.inertia_P = 0.4 * part.mass.mass * radius * radius * Eigen::Matrix3d::Identity();
  solid.shape.solids_P = {Primitive::sphere(radius)};
  return solid;
}

ThrowSetting laid_down(const PhysicsConfig& physics) {
  ThrowSetting setting;
  setting.physics = physics;
  return setting;
}

ThrowSetting thrown(const PhysicsConfig& physics) {
  ThrowSetting setting;
  setting.physics = physics;
  setting.height = 0.3, setting.spin = 30;
  setting.friction = 0.3, setting.restitution = 0.3;
  return setting;
}

PhysicsConfig scaled(PhysicsConfig physics, double scale) {
  physics.gravity *= scale;
  physics.fast_speed *= scale;
  physics.margin *= scale;
  physics.contact_threshold *= scale;
  physics.rolling_friction *= scale;
  return physics;
}

Rest throw_once(const Solid& solid, const ThrowSetting& setting, Rng& rng) {
  return throw_judged(solid, RestJudge(solid), setting, rng);
}

int PhysicsBench::count(int full) const { return std::max(1, full * draws_ / kFullDraws / (quick_ ? kQuickShare : 1)); }

Seed PhysicsBench::seed(const char* check, std::size_t i) const {
  const auto draws = static_cast<std::size_t>(draws_);
  return Seed{first_ + i % draws}.child(check, i / draws);
}

Rng PhysicsBench::rng(const char* check, std::size_t i) const { return seed(check, i).rng(); }

std::vector<double> PhysicsBench::each(const char* check, int count,
                                       const std::function<double(Rng&, std::size_t)>& measure) const {
  std::vector<double> values(static_cast<std::size_t>(count));
  parallel_for(values.size(), threads_, [&](std::size_t i) {
    Rng rng = this->rng(check, i);
    values[i] = measure(rng, i);
  });
  return values;
}

std::vector<Rest> PhysicsBench::throws(const char* check, int count, const Solid& solid,
                                       const ThrowSetting& setting) const {
  const RestJudge judge(solid);
  std::vector<Rest> rests(static_cast<std::size_t>(count));
  parallel_for(rests.size(), threads_, [&](std::size_t i) {
    Rng rng = this->rng(check, i);
    rests[i] = throw_judged(solid, judge, setting, rng);
  });
  return rests;
}

void PhysicsBench::note(const std::vector<Rest>& rests) { noted_.insert(noted_.end(), rests.begin(), rests.end()); }

double share_error(double share, int total) { return std::sqrt(std::max(share * (1 - share), 0.0) / total); }

}  // namespace binpick

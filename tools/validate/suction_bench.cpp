#include "tools/validate/suction_bench.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/yaml.hpp"
#include "robot/pick_sites.hpp"
#include "sim/collision_shape.hpp"

namespace binpick {
namespace {

constexpr double kStart = 0.002;             // m over contact
constexpr double kPressSpeed = 0.02;         // m/s
constexpr double kRaiseSpeed = 0.05;         // m/s
constexpr double kRaiseAcceleration = 0.25;  // m/s^2
constexpr double kRest = 0.05;               // s, until the plungers are at rest
constexpr double kTimeConstants = 9;         // after these the vacuum is within 0.013 % of its steady value
constexpr double kProbeBack = 0.02;          // m, behind the probe points
constexpr double kProbeReach = 0.03;         // m

Part finished(Part part, double mass) {
  part.envelope_P = part.mesh_P;
  part.density = 1;
  part.density = mass / mass_properties(part.mesh_P, 1).mass;
  part.mass = mass_properties(part.mesh_P, part.density);
  part.diameter = mesh_diameter(part.mesh_P);
  part.box_center_P = bounding_box(part.mesh_P).center();
  part.restitution = 0;
  return part;
}

}  // namespace

std::unique_ptr<Gripper> suction_tool(const std::string& yaml) {
  std::unique_ptr<Gripper> tool = make_gripper("suction");
  read_yaml_text(yaml, "suction tool", "", [&](ConfigVisitor& v) { tool->visit(v); });
  tool->validate();
  return tool;
}

Part plate_part(double mass, double side, double thickness) {
  Part part;
  part.name = "plate";
  part.mesh_P = mesh_of(Primitive::box({side, side, thickness}));
  part.pieces_P = {part.mesh_P};
  return finished(std::move(part), mass);
}

Part sphere_part(double radius, double mass) {
  Part part;
  part.name = "sphere";
  part.mesh_P = mesh_of(Primitive::sphere(radius), 192);  // vertices on the true surface: the facets sag by 1e-4 R
  part.pieces_P = {mesh_of(Primitive::sphere(radius), 16)};
  return finished(std::move(part), mass);
}

Part ring_part(double inner, double outer, double height, double density) {
  constexpr int kSectors = 240, kWedges = 12;
  const Eigen::Vector2d corners[] = {
      {inner, -height / 2}, {outer, -height / 2}, {outer, height / 2}, {inner, height / 2}};
  const auto corner = [&](int sector, int k) {
    const double angle = 2 * std::numbers::pi * sector / kSectors;
    return Eigen::Vector3d(corners[k].x() * std::cos(angle), corners[k].x() * std::sin(angle), corners[k].y());
  };
  Part part;
  part.name = "ring";
  for (int s = 0; s < kSectors; ++s)
    for (int k = 0; k < 4; ++k) part.mesh_P.vertices.push_back(corner(s, k));
  for (std::uint32_t s = 0; s < kSectors; ++s)
    for (std::uint32_t k = 0; k < 4; ++k) {
      const std::uint32_t next = (s + 1) % kSectors, a = 4 * s + k, b = 4 * s + (k + 1) % 4, c = 4 * next + (k + 1) % 4,
                          d = 4 * next + k;
      part.mesh_P.triangles.push_back({a, c, b});
      part.mesh_P.triangles.push_back({a, d, c});
    }
  for (int w = 0; w < kWedges; ++w) {
    TriangleMesh piece;
    for (int i = 0; i <= 4; ++i)
      for (int k = 0; k < 4; ++k) piece.vertices.push_back(corner(kSectors / kWedges * w + 5 * i, k));
    part.pieces_P.push_back(piece);
  }
  return finished(part, density * mass_properties(part.mesh_P, 1).mass);
}

Pose tool_down(const Eigen::Vector3d& p_W) {
  return pose_from(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()).toRotationMatrix(), p_W);
}

LiftBench::LiftBench(const Part& part, const Pose& X_WP, const Gripper& tool, const Pose& X_WG,
                     const LiftSetting& setting)
    : part_(part), tool_(tool), X_WG_(X_WG), setting_(setting), world_([&] {
        PhysicsConfig physics;
        physics.gravity = setting.gravity;
        return physics;
      }()) {
  const double bottom = bounding_box(transformed(X_WP, part.mesh_P)).min().z();
  const Primitive slab = Primitive::box({2, 2, 0.1}, Pose(Eigen::Translation3d(0, 0, bottom - 0.05)));
  world_.add_fixed({&slab, 1}, Pose::Identity(), {0.4, 0});
  body_ = world_.add_free(part, collision_shape(part), X_WP);
  shift_W_ = -kStart * X_WG_.linear().col(2);
  const std::vector<Primitive> body_G = tool.body_G();
  tool_body_ = world_.add_moved(body_G, Pose(Eigen::Translation3d(shift_W_)) * X_WG_, {0.4, 0});
  world_.set_collides(tool_body_, body_, false);  // what counts here is the cups' own reaction
  hold_ = std::make_unique<CupHold>(world_, tool_body_, tool.cups(), setting.hold);
}

LiftBench::~LiftBench() = default;

void LiftBench::step_to(const Eigen::Vector3d& shift_W) {
  shift_W_ = shift_W;
  world_.move_to(tool_body_, Pose(Eigen::Translation3d(shift_W)) * X_WG_);
  hold_->step(setting_.step);
  for (const CupState& cup : hold_->cups()) {
    if (!cup.part) continue;
    peaks_.pull = std::max(peaks_.pull, cup.pull);
    peaks_.shear = std::max(peaks_.shear, cup.shear);
    peaks_.moment = std::max(peaks_.moment, cup.moment);
    peaks_.torsion = std::max(peaks_.torsion, cup.torsion);
  }
}

void LiftBench::press() {
  const Eigen::Vector3d along = X_WG_.linear().col(2);
  for (double s = -kStart; s < setting_.press; s += kPressSpeed * setting_.step) step_to(s * along);
  wait(kRest);
}

Contact LiftBench::seal() {
  const Pose X_PG = world_.pose(body_).inverse() * world_.pose(tool_body_);
  const Contact contact = tool_.judge(probe_mesh(MeshQuery(part_.mesh_P), tool_, X_PG, kProbeBack, kProbeReach));
  sealed_ = contact.cup_sealed;
  for (std::size_t c = 0; c < sealed_.size(); ++c)
    if (sealed_[c]) hold_->attach(c, body_, contact.cup_vacuum[c]);
  return contact;
}

void LiftBench::evacuate() {
  double slowest = 0;
  for (const CupSpec& cup : tool_.cups()) slowest = std::max(slowest, cup.time_constant);
  wait(kTimeConstants * slowest);
}

void LiftBench::raise(double height) {
  const double start = shift_W_.z();
  for (double speed = 0; shift_W_.z() < start + height;) {
    speed = std::min(speed + kRaiseAcceleration * setting_.step, kRaiseSpeed);
    step_to(shift_W_ + Eigen::Vector3d(0, 0, speed * setting_.step));
  }
}

double LiftBench::accelerate(const Eigen::Vector3d& direction, const std::function<double(double)>& acceleration,
                             double duration) {
  const double dt = setting_.step;
  double speed = 0;
  for (double t = 0; t < duration; t += dt) {
    speed += acceleration(t) * dt;
    step_to(shift_W_ + speed * dt * direction);
    if (!holds_all()) return acceleration(t - setting_.hold.break_time);
  }
  return acceleration(duration);
}

void LiftBench::wait(double duration) {
  for (double t = 0; t < duration; t += setting_.step) step_to(shift_W_);
}

bool LiftBench::holds_all() const {
  bool any = false;
  for (std::size_t c = 0; c < sealed_.size(); ++c) {
    if (!sealed_[c]) continue;
    any = true;
    if (!hold_->cups()[c].part) return false;
  }
  return any;
}

double LiftBench::lever(std::size_t cup) const {
  const Pose X_WU = hold_->X_WU(cup);
  return (X_WU.inverse() * world_.mass_center(body_)).head<2>().norm();
}

std::vector<double> SuctionBench::each(const char* check, const std::function<double(Rng&)>& measure) const {
  std::vector<double> values;
  for (std::size_t draw = 0; draw < static_cast<std::size_t>(draws_); ++draw) {
    Rng rng = this->rng(check, draw);
    values.push_back(measure(rng));
  }
  return values;
}

void SuctionBench::mean_line(Verdict line, const std::vector<double>& values) {
  verdicts_.push_back(binpick::mean_line(std::move(line), values));
}

void SuctionBench::share_line(Verdict line, std::size_t hits, std::size_t total) {
  verdicts_.push_back(binpick::share_line(std::move(line), hits, total));
}

}  // namespace binpick

#include "sim/hold.hpp"

#include <algorithm>
#include <cmath>

#include "core/check.hpp"
#include "sim/world_impl.hpp"

namespace binpick {
namespace {

using Coupling = btGeneric6DofSpring2Constraint;
constexpr double kLipThickness = 0.002;  // m
constexpr double kLipInertia = 1e-4;     // kg m^2; the plunger guides the lip, so it only steadies the solver
constexpr double kStopErp = 0.5;         // share of a plunger's overrun that one step takes back
// Bullet iterates a joint row with its cfm relative to the row's inverse mass and diverges above 1.
constexpr double kLargestCfm = 0.5;

/// A spring and damper as an implicitly integrated row: v = -erp x / dt - gamma impulse.
struct SoftRow {
  double erp, cfm;
};

SoftRow soft_row(double stiffness, double damping_ratio, double inverse_mass, double dt) {
  const double mass = 1 / inverse_mass;
  double damping = 2 * damping_ratio * std::sqrt(stiffness * mass);
  damping = std::max(damping, mass / (kLargestCfm * dt) - dt * stiffness);  // more damping, never more stiffness
  return {dt * stiffness / (dt * stiffness + damping), mass / (dt * (dt * stiffness + damping))};
}

void set_plunger(Coupling& joint, const CupSpec& cup, double moving_mass) {
  joint.setLinearLowerLimit({0, 0, -cup.stroke});
  joint.setLinearUpperLimit({0, 0, 0});
  joint.setAngularLowerLimit({0, 0, 0});
  joint.setAngularUpperLimit({0, 0, 0});
  joint.enableSpring(2, true);
  joint.setStiffness(2, cup.stiffness);
  joint.setDamping(2, 2 * 0.7 * std::sqrt(cup.stiffness * moving_mass));
  joint.setEquilibriumPoint(2, cup.stiffness > 0 ? cup.preload / cup.stiffness : 0);
  joint.setParam(BT_CONSTRAINT_STOP_ERP, kStopErp, 2);
}

}  // namespace

struct CupHold::Impl {
  struct Cup {
    CupSpec spec;
    HoldLimits limits;
    BodyId lip = -1;
    std::unique_ptr<Coupling> plunger;   ///< tool - lip, while free
    std::unique_ptr<Coupling> coupling;  ///< tool - part, while sealed
    btJointFeedback feedback;
    Pose X_PU = Pose::Identity();                         ///< lip in the held part
    double sealed_for = 0, violated_for = 0, steady = 1;  ///< s; s; share of the full vacuum that a leak leaves
  };

  Impl(World& w, BodyId t, const HoldConfig& c) : world(w), tool(t), config(c) {}
  void add_cup(const CupSpec& spec);
  void free_lip(std::size_t i, const Pose& X_WU);
  void set_lip(Coupling& joint, const CupSpec& spec, BodyId part) const;
  void set_plane(Cup& cup, BodyId part, double dt) const;
  void read_free(std::size_t i);
  void read_sealed(std::size_t i, double dt);
  void detach(std::size_t i);
  std::optional<HoldLimit> violated(const Cup& cup, CupState& state) const;
  btDiscreteDynamicsWorld& engine() const { return *world.impl().world; }
  btRigidBody& rigid(BodyId body) const { return *world.impl().at(body).rigid; }

  World& world;
  BodyId tool;
  HoldConfig config;
  std::vector<Cup> cups;
  std::vector<CupState> states;
  std::vector<BodyId> lips;
};

void CupHold::Impl::add_cup(const CupSpec& spec) {
  cups.emplace_back();
  Cup& cup = cups.back();
  cup.spec = spec;
  cup.limits = spec.limits();
  const Primitive disc =
      Primitive::cylinder(spec.radius, kLipThickness, Pose(Eigen::Translation3d(0, 0, -kLipThickness / 2)));
  World::Impl::Body body;
  body.kind = World::BodyKind::kLip;
  body.geometry = world.impl().primitive_geometry({&disc, 1});
  const Pose X_WU = world.pose(tool) * spec.X_GU;
  cup.lip = world.impl().add(std::move(body), config.lip_mass, Eigen::Vector3d::Constant(kLipInertia), X_WU,
                             {spec.friction, 0});
  lips.push_back(cup.lip);
  states.emplace_back();
  free_lip(cups.size() - 1, X_WU);
}

/// The lip moves on its plunger again, from X_WU on and with the tool's speed.
void CupHold::Impl::free_lip(std::size_t i, const Pose& X_WU) {
  Cup& cup = cups[i];
  world.set_present(cup.lip, false);
  world.teleport(cup.lip, X_WU);
  world.set_present(cup.lip, true);
  const Eigen::Vector3d arm = X_WU.translation() - world.pose(tool).translation();
  world.set_velocity(cup.lip, world.velocity(tool) + world.angular_velocity(tool).cross(arm),
                     world.angular_velocity(tool));
  rigid(cup.lip).setGravity({0, 0, 0});
  rigid(cup.lip).forceActivationState(DISABLE_DEACTIVATION);
  cup.plunger =
      std::make_unique<Coupling>(rigid(tool), rigid(cup.lip), to_bullet(cup.spec.X_GU), btTransform::getIdentity());
  set_plunger(*cup.plunger, cup.spec, config.lip_mass);
  engine().addConstraint(cup.plunger.get(), true);
}

/// A sealed lip in rotation: springs in bending (k r^2 / 2) and torsion (k r^2), damped for the part it holds.
void CupHold::Impl::set_lip(Coupling& joint, const CupSpec& spec, BodyId part) const {
  const btRigidBody& body = rigid(part);
  const Pose X_WU = world.pose(tool) * spec.X_GU;
  const btVector3 lever = to_bullet(Eigen::Vector3d(X_WU.translation())) - body.getCenterOfMassPosition();
  for (int axis = 3; axis < 6; ++axis) {
    const btVector3 n = to_bullet(Eigen::Vector3d(X_WU.linear().col(axis - 3)));
    const double inertia =
        1 / n.dot(body.getInvInertiaTensorWorld() * n) + lever.cross(n).length2() / body.getInvMass();
    const double stiffness = spec.lip_stiffness * spec.radius * spec.radius * (axis == 5 ? 1.0 : 0.5);
    joint.setLimit(axis, 1, -1);  // free but for the spring
    joint.enableSpring(axis, true);
    joint.setStiffness(axis, stiffness);
    joint.setDamping(axis, 2 * config.damping_ratio * std::sqrt(stiffness * inertia));
    joint.setEquilibriumPoint(axis, 0);
  }
}

/// A sealed lip in its plane, for this step; of four cups or more on a part also along its axis beyond the plunger's
/// stops: rigid stops would leave the shares of the load to the solver, which hangs it all on two of them.
void CupHold::Impl::set_plane(Cup& cup, BodyId part, double dt) const {
  const btRigidBody& body = rigid(part);
  const btTransform X_WU = to_bullet(Pose(world.pose(tool) * cup.spec.X_GU));
  const btVector3 lever =
      to_bullet(Eigen::Vector3d(world.pose(part) * cup.X_PU.translation())) - body.getCenterOfMassPosition();
  const bool shared = std::ranges::count(states, std::optional(part), &CupState::part) > 3;
  for (int axis = 0; axis < 3; ++axis) {
    const btVector3 turning = lever.cross(X_WU.getBasis().getColumn(axis));
    const double inverse_mass = body.getInvMass() + turning.dot(body.getInvInertiaTensorWorld() * turning);
    const double k = axis < 2 ? config.lateral_stiffness : cup.spec.lip_stiffness;
    const bool soft = axis < 2 || shared;
    const SoftRow row = soft ? soft_row(k, config.damping_ratio, inverse_mass, dt) : SoftRow{kStopErp, 0};
    cup.coupling->setParam(BT_CONSTRAINT_STOP_ERP, row.erp, axis);
    cup.coupling->setParam(BT_CONSTRAINT_STOP_CFM, row.cfm, axis);
  }
}

void CupHold::Impl::read_free(std::size_t i) {
  const Cup& cup = cups[i];
  const Pose X_GL = world.pose(tool).inverse() * world.pose(cup.lip);
  states[i].compression = -(cup.spec.X_GU.inverse() * X_GL).translation().z();
  states[i].press = 0;
  for (const World::BodyContact& contact : world.contacts(cup.lip)) states[i].press += contact.force;
}

void CupHold::Impl::read_sealed(std::size_t i, double dt) {
  Cup& cup = cups[i];
  CupState& state = states[i];
  const BodyId part = *state.part;
  const Pose X_WU = world.pose(part) * cup.X_PU;
  world.teleport(cup.lip, X_WU);
  // The engine gives the torque about the part's mass centre: shift it to the lip centre.
  const Eigen::Vector3d force_W = from_bullet(cup.feedback.m_appliedForceBodyB);
  const Eigen::Vector3d lever = X_WU.translation() - world.mass_center(part);
  const Eigen::Vector3d moment_W = from_bullet(cup.feedback.m_appliedTorqueBodyB) - lever.cross(force_W);
  const Eigen::Vector3d force_U = X_WU.linear().transpose() * force_W;
  const Eigen::Vector3d moment_U = X_WU.linear().transpose() * moment_W;
  state.pull = -force_U.z();
  state.shear = force_U.head<2>().norm();
  state.moment = moment_U.head<2>().norm();
  state.torsion = std::abs(moment_U.z());
  state.compression = -((world.pose(tool) * cup.spec.X_GU).inverse() * X_WU).translation().z();
  state.press = std::max(0.0, force_U.z());
  cup.sealed_for += dt;
  state.vacuum_share = cup.steady * (1 - std::exp(-cup.sealed_for / cup.spec.time_constant));
  const std::optional<HoldLimit> limit = violated(cup, state);
  cup.violated_for = limit ? cup.violated_for + dt : 0;
  if (cup.violated_for < config.break_time) return;
  state.broken_by = limit;
  detach(i);
}

std::optional<HoldLimit> CupHold::Impl::violated(const Cup& cup, CupState& state) const {
  const HoldLimits& full = cup.limits;
  const double vacuum_force = full.pull * state.vacuum_share;
  const double kept_on = vacuum_force - state.pull;  // N = V - W
  state.use = vacuum_force > 0 ? std::max(0.0, state.pull / vacuum_force) : 0;
  if (kept_on < 0 || !(full.pull > 0)) return HoldLimit::kPull;
  if (state.vacuum_share < config.grip_share) return std::nullopt;
  const double shear = state.shear / (full.shear / full.pull * kept_on);
  const double moment = state.moment / (full.moment / full.pull * kept_on);
  const double torsion = state.torsion / (full.torsion / full.pull * kept_on);
  // M / (r N) = 1 where W / V + M / (r V) = 1, and so for shear: the form that does not run away as N goes to zero.
  const double pull = state.pull / vacuum_force;
  state.use = std::max(state.use, pull + std::max({shear, moment, torsion}) * (1 - pull));
  if (moment > 1 && moment >= shear && moment >= torsion) return HoldLimit::kMoment;
  if (shear > 1 && shear >= torsion) return HoldLimit::kShear;
  if (torsion > 1) return HoldLimit::kTorsion;
  return std::nullopt;
}

void CupHold::Impl::detach(std::size_t i) {
  Cup& cup = cups[i];
  CupState& state = states[i];
  if (!state.part) return;
  const BodyId part = *state.part;
  engine().removeConstraint(cup.coupling.get());
  cup.coupling.reset();
  state.part.reset();
  state.vacuum_share = state.pull = state.shear = state.moment = state.torsion = state.use = 0;
  const auto holds = [&](const CupState& other) { return other.part == part; };
  if (std::none_of(states.begin(), states.end(), holds)) {
    rigid(part).forceActivationState(ACTIVE_TAG);
    rigid(part).setDeactivationTime(0);
  }
  const double travel = std::clamp(-state.compression, -cup.spec.stroke, 0.0);
  free_lip(i, world.pose(tool) * cup.spec.X_GU * Eigen::Translation3d(0, 0, travel));
}

CupHold::CupHold(World& world, BodyId tool, std::span<const CupSpec> cups, const HoldConfig& config)
    : impl_(std::make_unique<Impl>(world, tool, config)) {
  impl_->cups.reserve(cups.size());
  for (const CupSpec& cup : cups) impl_->add_cup(cup);
}

CupHold::~CupHold() {
  if (!impl_) return;
  for (Impl::Cup& cup : impl_->cups) {
    if (cup.coupling) impl_->engine().removeConstraint(cup.coupling.get());
    if (cup.plunger) impl_->engine().removeConstraint(cup.plunger.get());
  }
}

CupHold::CupHold(CupHold&&) noexcept = default;

const std::vector<BodyId>& CupHold::lips() const { return impl_->lips; }
const std::vector<CupState>& CupHold::cups() const { return impl_->states; }
Pose CupHold::X_WU(std::size_t cup) const { return impl_->world.pose(impl_->lips[cup]); }

void CupHold::attach(std::size_t i, BodyId part, double vacuum) {
  Impl::Cup& cup = impl_->cups[i];
  CupState& state = impl_->states[i];
  BP_CHECK(!state.part, "cup " << i << " already holds body " << *state.part);
  World& world = impl_->world;
  world.wake(part);
  const Pose X_WU0 = world.pose(impl_->tool) * cup.spec.X_GU;
  const double travel = std::clamp((X_WU0.inverse() * X_WU(i)).translation().z(), -cup.spec.stroke, 0.0);
  cup.X_PU = world.pose(part).inverse() * X_WU0 * Eigen::Translation3d(0, 0, travel);
  impl_->engine().removeConstraint(cup.plunger.get());
  cup.plunger.reset();
  world.set_present(cup.lip, false);
  const Pose X_MU = world.impl().at(part).X_OM.inverse() * cup.X_PU;
  btRigidBody &tool = impl_->rigid(impl_->tool), &held = impl_->rigid(part);
  cup.coupling = std::make_unique<Coupling>(tool, held, to_bullet(cup.spec.X_GU), to_bullet(X_MU));
  set_plunger(*cup.coupling, cup.spec, 1 / held.getInvMass());
  impl_->set_lip(*cup.coupling, cup.spec, part);
  cup.coupling->setJointFeedback(&cup.feedback);
  impl_->engine().addConstraint(cup.coupling.get(), false);
  held.forceActivationState(DISABLE_DEACTIVATION);
  cup.sealed_for = cup.violated_for = 0, cup.steady = vacuum;
  state = CupState{};
  state.part = part;
  state.compression = -travel;
}

void CupHold::release_all() {
  for (std::size_t i = 0; i < impl_->cups.size(); ++i) {
    impl_->detach(i);
    impl_->states[i].broken_by.reset();
  }
}

void CupHold::reset_lips() {
  release_all();
  for (std::size_t i = 0; i < impl_->cups.size(); ++i) {
    impl_->engine().removeConstraint(impl_->cups[i].plunger.get());
    impl_->free_lip(i, impl_->world.pose(impl_->tool) * impl_->cups[i].spec.X_GU);
  }
}

void CupHold::set_config(const HoldConfig& config) { impl_->config = config; }

bool CupHold::holds_any() const {
  return std::any_of(impl_->states.begin(), impl_->states.end(), [](const CupState& s) { return s.part.has_value(); });
}

void CupHold::step(double dt) {
  for (std::size_t i = 0; i < impl_->cups.size(); ++i)
    if (impl_->states[i].part) impl_->set_plane(impl_->cups[i], *impl_->states[i].part, dt);
  impl_->world.step(dt);
  for (std::size_t i = 0; i < impl_->cups.size(); ++i) {
    if (impl_->states[i].part)
      impl_->read_sealed(i, dt);
    else
      impl_->read_free(i);
  }
}

}  // namespace binpick

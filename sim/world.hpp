// The physics world: free, fixed and moved bodies, a step that follows the state by a stated rule, poses, rays, state
// hash. SI outside; scale, margin and P <-> M stay inside (bullet_convert.hpp). A fresh World for every trial; never
// reset one.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/config.hpp"
#include "core/part.hpp"
#include "core/primitive.hpp"
#include "sim/collision_shape.hpp"

namespace binpick {

/// Settings of reference bullet_settings.md, each with its reason in world.cpp.
struct PhysicsConfig {
  double gravity = 9.81;             ///< m/s^2
  double fine_step = 1.0 / 1000;     ///< s, while any awake part is fast
  double coarse_step = 1.0 / 240;    ///< s
  double fast_speed = 0.3;           ///< m/s: |v| + |w| R above which a part is fast
  int fine_iterations = 15;          ///< of the contact solver, in a fine step
  int coarse_iterations = 150;       ///< in a coarse step
  int iterations = 50;               ///< in a step of a stated length: in lockstep with the arm
  double margin = 0.2e-3;            ///< m, collision margin, planes inset by it
  double contact_threshold = 2e-3;   ///< m
  double rolling_friction = 0.1e-3;  ///< m, lever arm on parts
  bool freeze_far = true;            ///< sleeping parts are frozen while the arm works (freeze_sleeping())
  double wake_weights = 2;           ///< a frozen part wakes at a contact force this many weights above that at rest
  double wake_motion = 0.1e-3;       ///< m (and m of R x rotation): and when a part it touched has moved more
  void visit(ConfigVisitor& v);
  void validate() const;
};

struct SurfaceMaterial {
  double friction = 0.4;
  double restitution = 0.1;
};

using BodyId = int;  ///< index in the order of addition

class World {
 public:
  explicit World(const PhysicsConfig& config);
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  BodyId add_free(const Part& part, const CollisionShape& shape, const Pose& X_WP);
  BodyId add_fixed(std::span<const Primitive> shapes_O, const Pose& X_WO, const SurfaceMaterial& material);
  BodyId add_fixed_hulls(std::span<const TriangleMesh> convex_O, const Pose& X_WO, const SurfaceMaterial& material);
  /// Moved along a given path (kinematic): arm links, tools.
  BodyId add_moved(std::span<const Primitive> shapes_O, const Pose& X_WO, const SurfaceMaterial& material);
  /// Where a moved body shall be at the end of the next step.
  void move_to(BodyId body, const Pose& X_WO);
  void set_collides(BodyId a, BodyId b, bool collides);
  /// Takes a body out of the simulation (it keeps its id and pose) or puts it back.
  void set_present(BodyId body, bool present);
  /// Puts a body elsewhere at once, at rest.
  void teleport(BodyId body, const Pose& X_WO);
  void set_velocity(BodyId body, const Eigen::Vector3d& linear, const Eigen::Vector3d& angular);
  /// Damping of all free bodies, share of the speed lost in one second.
  void set_damping(double linear, double angular);
  /// Velocity zero and asleep: frozen until something touches or wakes it.
  void put_to_sleep(BodyId body);

  /// From now on a free body that sleeps is frozen: the solver sees it as fixed and its island stays asleep, so that a
  /// pick pays for the parts it moves, not for the heap. What is frozen wakes, and moves as ever, when
  ///   a lip comes within contact_threshold: with what it touches and all parts within two bounding radii of it;
  ///   a moved body does, or a part presses with ten weights: with all that touches it, to the last part;
  ///   an awake part presses on it by more than `wake_weights` weights above the force at rest;
  ///   a part that touched it has moved more than `wake_motion`, or one that has comes within contact_threshold (so
  ///   loads and lost supports pass from part to part). No part is ever a wall for longer than one step.
  /// Nothing happens unless `freeze_far`.
  void freeze_sleeping();
  /// What is frozen just sleeps again.
  void end_freezing();
  int frozen_count() const;

  double step();           ///< one step; returns its length in s
  double step(double dt);  ///< one step of a stated length (motion in lockstep with the arm)
  double time() const;
  int body_count() const;
  enum class BodyKind { kFree, kFixed, kMoved, kLip };  ///< a lip is dynamic, but no part (hold.hpp)
  BodyKind kind(BodyId body) const;
  bool present(BodyId body) const;
  Eigen::Vector3d mass_center(BodyId body) const;       ///< in W
  double bounding_radius(BodyId body) const;            ///< m, about the mass centre
  Pose pose(BodyId body) const;                         ///< X_WO or X_WP
  Eigen::Vector3d velocity(BodyId body) const;          ///< m/s, of the mass centre
  Eigen::Vector3d angular_velocity(BodyId body) const;  ///< rad/s, in W
  double kinetic_energy(BodyId body) const;             ///< J, of a free body
  double gravity() const;                               ///< m/s^2, along -z of W
  void wake(BodyId body);
  bool awake(BodyId body) const;
  /// Awake from now on, or free to fall asleep again.
  void set_may_sleep(BodyId body, bool may);
  double deepest_contact() const;  ///< m, deepest penetration among current contacts, >= 0
  /// Contacts of a body now: the other body, normal force (N, mean over the last step) and depth (m).
  struct BodyContact {
    BodyId other;
    double force;
    double depth;
  };
  std::vector<BodyContact> contacts(BodyId body) const;
  /// How deep two bodies overlap where the step itself makes no contacts (moved against fixed), m, >= 0.
  double overlap(BodyId a, BodyId b);
  std::uint64_t state_hash() const;  ///< of every body's pose and velocity bits

  struct Impl;  ///< shared with hold.cpp through sim/world_impl.hpp, private to sim
  Impl& impl() { return *impl_; }
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace binpick

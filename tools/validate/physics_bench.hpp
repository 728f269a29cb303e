// Single bodies in our World, as the checks V-E1..V-E5 throw, slide and swing them, and what they share: solids known
// on paper, a throw onto a floor, how a body rests. World: z up, the floor's top at z = 0.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/part.hpp"
#include "core/random.hpp"
#include "sim/collision_shape.hpp"
#include "sim/drop.hpp"
#include "tools/validate/verdict.hpp"

namespace binpick {

/// What every check is measured with; a test may put something wrong here and see that the checks notice.
struct PhysicsSetting {
  PhysicsConfig physics;
  std::function<CollisionShape(const Part&)> shape = collision_shape;
  std::string parts = "assets/parts";                ///< folder of the shipped parts
  std::string bearings = "scenes/bearing_bin.yaml";  ///< scene of V-E7
};

/// A part and what it collides with. Frame P in the middle of its box.
struct Solid {
  Part part;
  CollisionShape shape;
};
Solid finished(Part part, const PhysicsSetting& setting);
Part cuboid_part(const Eigen::Vector3d& edges);
/// 32 facets on the true circle's area; axis z.
Part cylinder_part(double diameter, double height);
/// A true ball whose mass centre lies `off` (m) below its middle, with the inertia of an even ball about its middle.
Solid ball(double radius, double density, double off = 0);

struct ThrowSetting {
  PhysicsConfig physics;
  double height = 1e-3;  ///< m, of the lowest point over the floor
  double spin = 0;       ///< rad/s, about a random axis
  double friction = 0.5, restitution = 0;
  double scale = 1;  ///< of all lengths that are not the solid's: the same throw in another unit
};
/// The quasi-static limit of V-E1 and V-E2, and the throw of V-E3 and of the reference's own Bullet rows.
ThrowSetting laid_down(const PhysicsConfig& physics);
ThrowSetting thrown(const PhysicsConfig& physics);
/// The settings in which the same motion runs with all lengths times `scale`.
PhysicsConfig scaled(PhysicsConfig physics, double scale);

struct Rest {
  bool at_rest = false;
  Pose X_WP = Pose::Identity();
  double tilt = 0;  ///< rad, between the nearest face of the hull of what collides and the floor; a round part's side
                    ///< is a face all round
  double gap = 0;   ///< m, of the true mesh's lowest point over the floor; negative: it sank
};
/// Random orientation, one fresh World.
Rest throw_once(const Solid& solid, const ThrowSetting& setting, Rng& rng);

class PhysicsBench {
 public:
  static constexpr int kFullDraws = 20, kQuickDraws = 4;

  PhysicsBench(std::uint64_t first_seed, int draws, bool quick, int threads, PhysicsSetting setting = {})
      : first_(first_seed), draws_(draws), quick_(quick), threads_(threads), setting_(std::move(setting)) {}

  const PhysicsSetting& setting() const { return setting_; }
  bool quick() const { return quick_; }
  /// How often something is done that the full form does `full` times; the quick form does it a sixth as often per
  /// seed.
  int count(int full) const;
  /// The random stream of item i of a check: over the seeds first, within a seed then.
  Rng rng(const char* check, std::size_t i) const;
  Seed seed(const char* check, std::size_t i) const;
  /// `measure` of every item, on the bench's threads.
  std::vector<double> each(const char* check, int count, const std::function<double(Rng&, std::size_t)>& measure) const;
  std::vector<Rest> throws(const char* check, int count, const Solid& solid, const ThrowSetting& setting) const;

  void add(Verdict line) { verdicts_.push_back(std::move(line)); }
  const std::vector<Verdict>& verdicts() const { return verdicts_; }

  /// Every throw at rest goes into the lines of V-E4 on faces and heights.
  void note(const std::vector<Rest>& rests);
  const std::vector<Rest>& noted() const { return noted_; }

 private:
  std::uint64_t first_;
  int draws_;
  bool quick_;
  int threads_;
  PhysicsSetting setting_;
  std::vector<Verdict> verdicts_;
  std::vector<Rest> noted_;
};

/// Standard error of a share.
double share_error(double share, int total);

// The checks, each appending its lines.
void check_invariance(PhysicsBench& bench);      ///< V-E4
void check_rest(PhysicsBench& bench);            ///< V-E4; after those that throw: what they noted is judged too
void check_single_body(PhysicsBench& bench);     ///< V-E5
void check_cylinders(PhysicsBench& bench);       ///< V-E1
void check_cuboids(PhysicsBench& bench);         ///< V-E2
void check_thrown_cuboids(PhysicsBench& bench);  ///< V-E3
void check_spheres(PhysicsBench& bench);         ///< V-E6
void check_bearings(PhysicsBench& bench);        ///< V-E7

/// Shares of V-E1 and V-E3 over the shape, beside theory and dice, from `lines`. False when gnuplot is not installed.
bool plot_physics(const std::vector<Verdict>& lines, const std::string& folder);

}  // namespace binpick

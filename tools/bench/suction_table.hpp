// Cup diameter x number of cups x vacuum x lift acceleration -> share of grasps that hold a ring-shaped part, measured
// in the physics world beside what statics says of the very same grasps.
//
// Set-up: the part lies flat; one cup stands over the middle of its land, several on that circle about the part's axis.
// A grasp is off by a normal error in x and y and by a tilt about a random horizontal axis. Statics: a grasp seals when
// every rim lies on the land, inner + r <= |p| <= outer - r. With W = m (g + a) and c the mass centre seen from the
// tool's axis, cup i of n on the circle R carries W_i = W/n (1 + k c.p_i / R^2), k = 1 for two cups and 2 for more, and
// holds while W_i + M_i / r <= V (physical_models B1), with M_1 = W l for one cup at the distance l from the mass
// centre, M_i = W |c x p| / (2 R) for two, and 0 for more.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/part.hpp"
#include "core/random.hpp"

namespace binpick {

/// A ring-shaped part with its axis along z through its origin.
struct RingSubject {
  Part part;
  double inner = 0.035, outer = 0.050;  ///< m, of the flat land
  double land_radius() const { return (inner + outer) / 2; }
};
/// The paper's bearing, 70 x 100 x 16 mm, 0.173 kg, as a ring with sharp edges.
RingSubject paper_ring();

struct SuctionTableConfig {
  std::vector<double> diameters = {0.008, 0.010, 0.012, 0.014};  ///< m
  std::vector<int> cups = {1, 2, 3, 4};
  std::vector<double> vacuums = {40e3, 60e3, 80e3};          ///< Pa
  std::vector<double> accelerations = {2.5, 5, 10, 20, 40};  ///< m/s^2
  int draws = 50;
  std::uint64_t seed = 5000;    ///< draws seed .. seed + draws - 1
  double lateral_sigma = 1e-3;  ///< m, in x and y each
  double tilt_sigma = 0.0087;   ///< rad (0.5 deg)
};

struct SuctionCell {
  double diameter = 0, vacuum = 0, acceleration = 0;
  int cups = 0;
  int draws = 0, sealed = 0, held = 0;     ///< measured: all cups sealed; all of them held throughout the lift
  int sealed_theory = 0, held_theory = 0;  ///< of the same grasps, by statics
  int same = 0;                            ///< grasps on which both agree: held or not
  double moment = 0;         ///< N m, median over the sealed grasps of the largest on one cup until it let go
  double moment_theory = 0;  ///< N m, the same by statics
};

/// The acceleration at which a centred grasp comes off, ramped up slowly; negative by theory: not even at rest.
struct SuctionLimit {
  double diameter = 0, vacuum = 0;
  int cups = 0;
  double measured = 0, theory = 0;  ///< m/s^2; measured is NaN when it did not hold at rest
};

struct SuctionTable {
  std::vector<SuctionCell> cells;
  std::vector<SuctionLimit> limits;
};
SuctionTable suction_table(const RingSubject& ring, const SuctionTableConfig& config);

std::string text_of(const SuctionTable& table, const SuctionTableConfig& config);
std::string json_of(const SuctionTable& table, const SuctionTableConfig& config);

}  // namespace binpick

// One suction cup of a tool, as geometry and data sheet. Frame U of a cup: lip centre, +z leaves the tool.
#pragma once

#include "core/config.hpp"
#include "core/hold_limits.hpp"
#include "core/pose.hpp"

namespace binpick {

struct CupSpec {
  Pose X_GU = Pose::Identity();       ///< lip centre in the gripper tip frame, plunger fully out
  double radius = 0.005;              ///< m, sealing lip
  double effective_area_ratio = 1.0;  ///< A_eff / (pi r^2); bellows 0.7-0.9
  double vacuum = 60e3;               ///< Pa below ambient, steady state
  double time_constant = 0.05;        ///< s, p(t) = p_inf (1 - exp(-t / tau))
  double friction = 0.5;              ///< lip against part
  double stroke = 0.010;              ///< m, spring plunger travel
  double stiffness = 300;             ///< N/m, plunger spring
  double preload = 0.5;               ///< N, plunger spring force when fully out
  double lip_compliance = 0.0005;     ///< m, height variation along the rim that the lip closes
  double lip_stiffness = 3000;  ///< N/m of the rim along its axis, 1-3 N/mm (physical_models B3): bending k r^2 / 2
  double max_tilt = 0.26;       ///< rad, between the lip's axis and the surface normal
  /// m, mean gap along the rim, beyond what the lip closes, that leaves no vacuum: p = p_inf (1 - gap / this)
  /// (physical_models B3). 0: any such gap opens the cup.
  double leak_gap = 0;

  HoldLimits limits() const;     ///< physical_models B1
  void visit(ConfigVisitor& v);  ///< `model: NAME` (cup_models.hpp) sets all but the pose, then the other keys
  void validate() const;
};

}  // namespace binpick

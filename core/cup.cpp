#include "core/cup.hpp"

#include <numbers>

#include "core/cup_models.hpp"
#include "core/error.hpp"

namespace binpick {

HoldLimits CupSpec::limits() const {
  HoldLimits limits;
  // physical_models B1: F = dp A_eff, Coulomb on the lip, peel about the lip's edge, twist about its rim.
  limits.pull = vacuum * effective_area_ratio * std::numbers::pi * radius * radius;
  limits.shear = friction * limits.pull;
  limits.moment = limits.pull * radius;
  limits.torsion = friction * limits.pull * radius;
  return limits;
}

void CupSpec::visit(ConfigVisitor& v) {
  if (v.reading() && v.has("model")) {
    std::string model;
    v.choice("model", model, cup_model_names(), "cup to start from");
    const Pose kept = X_GU;
    *this = cup_model(model).spec;
    X_GU = kept;
  }
  v.field("pose", X_GU, "lip centre in the gripper tip frame, plunger fully out; +z leaves the tool");
  v.field("radius", radius, Unit::kLength, "radius of the sealing lip");
  v.field("effective_area_ratio", effective_area_ratio, Unit::kNone, "effective area / lip area; bellows 0.7-0.9");
  v.field("vacuum", vacuum, Unit::kPressure, "steady pressure below ambient");
  v.field("time_constant", time_constant, Unit::kTime, "vacuum builds as 1 - exp(-t / this)");
  v.field("friction", friction, Unit::kNone, "Coulomb coefficient of lip against part");
  v.field("stroke", stroke, Unit::kLength, "travel of the spring plunger");
  v.field("stiffness", stiffness, Unit::kStiffness, "plunger spring");
  v.field("preload", preload, Unit::kForce, "plunger spring force when fully out");
  v.field("lip_compliance", lip_compliance, Unit::kLength, "height variation along the rim that the lip closes");
  v.field("lip_stiffness", lip_stiffness, Unit::kStiffness,
          "of the rim along its axis; a sealed lip bends with k r^2 / 2");
  v.field("max_tilt", max_tilt, Unit::kAngle, "largest angle between lip axis and surface normal, along the whole rim");
  v.field("leak_gap", leak_gap, Unit::kLength, "mean gap beyond the lip's compliance that leaves no vacuum; 0: any");
}

void CupSpec::validate() const {
  const auto need = [](bool good, const char* message) {
    if (!good) throw SpecError(std::string("cup.") + message);
  };
  need(is_rigid(X_GU, 1e-6), "pose: must be a finite pose");
  need(radius >= 0.0005 && radius <= 0.2, "radius: must lie between 0.5 and 200 mm");
  need(effective_area_ratio > 0 && effective_area_ratio <= 1.2, "effective_area_ratio: must lie in (0, 1.2]");
  need(vacuum > 0 && vacuum <= 101325, "vacuum: must lie between 0 and 101325 Pa (below ambient)");
  need(time_constant >= 0 && time_constant <= 10, "time_constant: must lie between 0 and 10 s");
  need(friction >= 0 && friction <= 2, "friction: must lie between 0 and 2");
  need(stroke >= 0 && stroke <= 0.1, "stroke: must lie between 0 and 100 mm");
  need(stiffness > 0 && stiffness <= 1e6, "stiffness: must lie between 0 and 1e6 N/m");
  need(preload >= 0 && preload <= 1000, "preload: must lie between 0 and 1000 N");
  need(lip_compliance >= 0 && lip_compliance <= radius, "lip_compliance: must lie between 0 and the lip's radius");
  need(lip_stiffness > 0 && lip_stiffness <= 1e6, "lip_stiffness: must lie between 0 and 1e6 N/m");
  need(leak_gap >= 0 && leak_gap <= 0.001, "leak_gap: must lie between 0 and 1 mm");
  need(max_tilt > 0 && max_tilt < 1.2, "max_tilt: must lie between 0 and 1.2 rad");
}

}  // namespace binpick

#include "trials/calibration/calibration_config.hpp"

#include "core/error.hpp"
#include "trials/calibration/calibration_trial.hpp"

namespace binpick {
namespace {

// Bare numbers are SI: more than this is an offset in millimetres or degrees whose unit was forgotten.
constexpr double kMostShift = 0.1;  // m
constexpr double kMostTurn = 0.35;  // rad
constexpr double kMostScale = 20;

void visit_offset(ConfigVisitor& v, CalibrationConfig& config) {
  v.section_with(
      "offset",
      [&](ConfigVisitor& in) {
        in.field("translation", config.translation, Unit::kLength, "along the axes of the camera");
        in.field("rotation", config.rotation, Unit::kAngle, "roll, pitch, yaw in the camera's frame");
      },
      "the error itself, from the camera to where it is believed");
}

}  // namespace

void CalibrationConfig::visit(ConfigVisitor& v) {
  const bool all = !v.reading() && perfect();  // a stored scene leaves `perfect` out: this is the table of keys
  if (v.reading() && v.has("offset")) {
    if (v.has("method")) v.fail("offset", "is a calibration of its own; leave out method");
    method = "offset";
  } else if (v.reading() && !v.has("method")) {
    v.fail("method", "is missing: chain or hand_eye (or give offset)");
  } else if (method != "offset") {
    v.choice("method", method, {"perfect", "chain", "hand_eye"}, "perfect, the paper's chain, or hand-eye (Park)");
  }
  if (all || method == "offset") visit_offset(v, *this);
  if (!perfect() || all) v.field("scale", scale, Unit::kNone, "times the error that comes out");
  if (method == "hand_eye" || all) v.field("poses", poses, "looks at the plate, hand_eye only");
  if (by_measurement() || all)
    v.section_with(
        "errors", [&](ConfigVisitor& in) { errors.visit_calibration(in); }, "what is wrong while it is calibrated");
}

void CalibrationConfig::validate() const {
  if (!(scale >= 0 && scale <= kMostScale)) throw SpecError("scale: must lie between 0 and 20");
  if (poses < 3 || poses > 100) throw SpecError("poses: must lie between 3 and 100");
  if (!(translation.norm() <= kMostShift))
    throw SpecError("offset.translation: more than 0.1 m; a bare number is in metres");
  if (!(rotation.norm() <= kMostTurn))
    throw SpecError("offset.rotation: more than 0.35 rad; a bare number is in radians");
  errors.validate();
}

Pose calibration_offset(const CalibrationConfig& config, const CalibrationSetup* setup, Seed trial_seed) {
  Pose X_CC = Pose::Identity();
  if (config.by_measurement()) {
    const CalibrationMethod method = config.method == "chain" ? CalibrationMethod::kChain : CalibrationMethod::kPark;
    X_CC = calibration_offset(*setup, config.errors, method, trial_seed);
  } else if (config.method == "offset") {
    X_CC = pose_from_xyz_rpy(config.translation, config.rotation);
  }
  return config.scale == 1 ? X_CC : exp_se3(config.scale * log_se3(X_CC));
}

}  // namespace binpick

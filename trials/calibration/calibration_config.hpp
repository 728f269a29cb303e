// `calibration:` of a scene: with which error its cell knows where the camera is. The cell's `camera.pose` is what the
// cell believes; the camera itself stands where that error puts it. Frame C: the camera's own.
#pragma once

#include <string>

#include "core/random.hpp"
#include "trials/calibration/calibration_errors.hpp"

namespace binpick {

struct CalibrationSetup;

struct CalibrationConfig {
  std::string method = "perfect";  ///< perfect | chain | hand_eye (Park) | offset
  double scale = 1;                ///< times the error that the method has
  int poses = 15;                  ///< looks of hand_eye
  CalibrationErrors errors;        ///< of chain and hand_eye; the depth camera's bias is the sensor's business here
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< m, of `offset`, in C
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();     ///< rad, of `offset`: roll, pitch, yaw in C

  bool perfect() const { return method == "perfect"; }
  bool by_measurement() const { return method == "chain" || method == "hand_eye"; }
  void visit(ConfigVisitor& v);
  void validate() const;
};

/// X_CC from where the camera is to where the cell believes it. With chain and hand_eye the calibration that
/// `binpick calibrate` makes of the same seed; `setup` may be null for the others. Throws SpecError when the looks of
/// hand_eye turn about one axis only.
Pose calibration_offset(const CalibrationConfig& config, const CalibrationSetup* setup, Seed trial_seed);

}  // namespace binpick

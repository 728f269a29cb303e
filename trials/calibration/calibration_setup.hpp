// Where arm, plates and the fixed 2D camera stand while the camera on the flange is calibrated (paper 5.1). Frames: D
// the fixed camera, Q a plate, F the flange, C the camera on it, R the robot's base.
#pragma once

#include <memory>
#include <vector>

#include "core/camera.hpp"
#include "robot/cell.hpp"
#include "trials/calibration/marker_plate.hpp"

namespace binpick {

class PlateImages;

struct CalibrationSetup {
  const Cell* cell = nullptr;
  /// Where corners come from: found in rendered grey images; null: projected, and disturbed by the stated corner noise.
  std::shared_ptr<const PlateImages> images;
  MarkerPlate plate;
  PinholeCamera camera_C{1280, 720,   920,
                         920,  639.5, 359.5};  ///< of the grey image of the camera on the flange (a D4xx's)
  PinholeCamera camera_D{1280, 960, 920, 920, 639.5, 479.5};
  Pose X_WD = Pose::Identity();
  Pose X_FQ = Pose::Identity();         ///< the plate on the flange, as drawn
  Pose X_WQ = Pose::Identity();         ///< the plate that both cameras see
  Vector6d q_shown = Vector6d::Zero();  ///< rad: the plate on the flange before the fixed camera
  Vector6d q_look = Vector6d::Zero();   ///< rad: the camera on the flange over the other plate
  Vector6d q_pick = Vector6d::Zero();   ///< rad: the tip on a part in the middle of the bin
  std::vector<Vector6d> q_hand_eye;     ///< rad: looks at the other plate from several sides
};

/// What may be chosen of it.
struct CalibrationPlaces {
  int poses = 15;         ///< looks of the hand-eye calibration; 0: none
  double above = 1.1;     ///< m, of the fixed camera over the floor of the bin
  double nearest = 0.45;  ///< m, of those looks from the plate; the farthest are 150 mm farther
};

/// Finds postures within reach, limits and free of collision with the cell (the tool is taken off for the plate, whose
/// place it has). Throws SpecError when the cell has no camera on the
/// flange, or says what cannot be reached.
CalibrationSetup calibration_setup(const Cell& cell, const CalibrationPlaces& places);

}  // namespace binpick

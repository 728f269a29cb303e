// One calibration of the camera on the flange in a cell that is not as drawn, and what its error does to a pick.
#pragma once

#include "core/random.hpp"
#include "trials/calibration/calibration_errors.hpp"
#include "trials/calibration/calibration_setup.hpp"
#include "trials/calibration/hand_eye.hpp"

namespace binpick {

enum class CalibrationMethod { kChain, kPark, kHoraud };
inline constexpr std::array kCalibrationMethods = {CalibrationMethod::kChain, CalibrationMethod::kPark,
                                                   CalibrationMethod::kHoraud};
std::string to_string(CalibrationMethod method);

/// Of the estimated camera against the true one, and of a part taken with it.
struct CalibrationError {
  Pose X_CC = Pose::Identity();  ///< from the true camera C to where it is believed, in C
  double shift = 0, turn = 0;    ///< m, rad, of it
  double tip = 0, tip_turn = 0;  ///< m, rad: the tip where the part is believed, against where the part is
};

/// The paper's chain (5.1, eq. 5-8): a plate on the flange before a fixed 2D camera gives X_WD; a standing plate before
/// both cameras gives X_DC; together with the joint angles at that moment X_FC. Or cv::calibrateHandEye from looks at
/// the standing plate. Numbers are drawn from `normal` in a fixed order, whichever errors are 0.
Pose calibrate(const CalibrationSetup& setup, const CalibrationErrors& errors, CalibrationMethod method,
               const Normals& normal);

/// The same with the numbers of a seed: X_CC from the true camera to where it is believed, in C.
Pose calibration_offset(const CalibrationSetup& setup, const CalibrationErrors& errors, CalibrationMethod method,
                        Seed seed);

/// calibrate(), then a pick in the same cell: a part in the middle of the bin is measured from the look pose with the
/// depth camera's bias, and the tip sent to it by the drawn arm.
CalibrationError calibration_error(const CalibrationSetup& setup, const CalibrationErrors& errors,
                                   CalibrationMethod method, const Normals& normal);
CalibrationError calibration_error(const CalibrationSetup& setup, const CalibrationErrors& errors,
                                   CalibrationMethod method, Seed seed);

/// Root mean squares over the calibrations of seeds first_seed .. first_seed + draws - 1.
struct CalibrationSpread {
  double shift = 0, turn = 0, tip = 0, tip_turn = 0;
  std::vector<double> shifts, tips;  ///< m, of each
};
CalibrationSpread calibration_spread(const CalibrationSetup& setup, const CalibrationErrors& errors,
                                     CalibrationMethod method, std::uint64_t first_seed, int draws);

/// Root mean square of shift and turn to first order: the sum over all numbers drawn of the squared derivatives, each
/// by a central difference.
struct PredictedError {
  double shift = 0, turn = 0, tip = 0;
};
PredictedError predicted_error(const CalibrationSetup& setup, const CalibrationErrors& errors,
                               CalibrationMethod method);

}  // namespace binpick

// What is wrong in a calibration, source by source. Standard deviations of normal errors (physical_models D: injection
// defaults; field values of marker calibration and of arms that are not calibrated).
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "core/camera.hpp"
#include "core/config.hpp"
#include "robot/arm.hpp"

namespace binpick {

struct CalibrationErrors {
  double corner = 0.2;                             ///< px, of a corner along each axis
  double focal = 0.002;                            ///< relative, of the focal lengths together
  double centre = 1;                               ///< px, of the principal point along each axis
  double plate_shift = 0.2e-3;                     ///< m, of the plate on the flange along each axis
  double plate_turn = 0.1 / 57.29577951308232;     ///< rad, about each axis
  double joint_offset = 0.02 / 57.29577951308232;  ///< rad, of each joint
  double link = 0.1e-3;                            ///< m, of each link along each axis
  double repeatability = 0.02e-3;                  ///< m, of the flange along each axis at each stop
  double disparity_bias = 0.3;  ///< px, of the depth camera: no part of the calibration, but of what a pick meets

  void visit(ConfigVisitor& v);
  void visit_calibration(ConfigVisitor& v);  ///< without disparity_bias
  void validate() const;
};

/// The groups a table splits by; each is one or more of the numbers above.
enum class ErrorSource { kCorners, kIntrinsics, kPlate, kJoints, kRepeatability, kDepthBias };
inline constexpr std::array kErrorSources = {ErrorSource::kCorners,       ErrorSource::kIntrinsics,
                                             ErrorSource::kPlate,         ErrorSource::kJoints,
                                             ErrorSource::kRepeatability, ErrorSource::kDepthBias};
std::string to_string(ErrorSource source);
CalibrationErrors no_errors();
/// Everything else 0.
CalibrationErrors only(const CalibrationErrors& errors, ErrorSource source);

/// Standard normal numbers, asked for in a fixed order: a seed's stream, or all 0 but one (derivatives).
using Normals = std::function<double()>;

/// An arm that is not built as drawn, and does not come back to the same place.
class BuiltArm {
 public:
  BuiltArm(const Arm& drawn, const CalibrationErrors& errors, const Normals& normal);
  /// X_RF of the flange, without what differs from stop to stop.
  Pose forward(const Vector6d& q) const;
  /// The same at one stop.
  Pose stop(const Vector6d& q, const CalibrationErrors& errors, const Normals& normal) const;

 private:
  const Arm* drawn_;
  Vector6d offset_;                                ///< rad
  std::array<Eigen::Vector3d, 7> length_error_{};  ///< m, of each link in its own frame
};

/// The camera as it is, where `stated` is what its calibration says.
PinholeCamera built_camera(const PinholeCamera& stated, const CalibrationErrors& errors, const Normals& normal);

}  // namespace binpick

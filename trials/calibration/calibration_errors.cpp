#include "trials/calibration/calibration_errors.hpp"

#include "core/error.hpp"

namespace binpick {

void CalibrationErrors::visit(ConfigVisitor& v) {
  visit_calibration(v);
  v.field("disparity_bias", disparity_bias, Unit::kNone, "px, of the depth camera that picks are made with");
}

void CalibrationErrors::visit_calibration(ConfigVisitor& v) {
  v.field("corner", corner, Unit::kNone, "px, standard deviation of a marker's corner along each axis");
  v.field("focal", focal, Unit::kNone, "relative, of the focal length");
  v.field("centre", centre, Unit::kNone, "px, of the principal point along each axis");
  v.field("plate_shift", plate_shift, Unit::kLength, "of the plate on the flange along each axis");
  v.field("plate_turn", plate_turn, Unit::kAngle, "of the plate on the flange about each axis");
  v.field("joint_offset", joint_offset, Unit::kAngle, "of each joint");
  v.field("link", link, Unit::kLength, "of each link along each axis");
  v.field("repeatability", repeatability, Unit::kLength, "of the flange along each axis at each stop");
}

void CalibrationErrors::validate() const {
  for (const double value :
       {corner, focal, centre, plate_shift, plate_turn, joint_offset, link, repeatability, disparity_bias})
    if (!(value >= 0 && value < 20)) throw SpecError("calibration errors: each must be 0 or more, and below 20");
  if (!(focal < 0.1)) throw SpecError("focal: must be below 0.1");
}

std::string to_string(ErrorSource source) {
  switch (source) {
    case ErrorSource::kCorners:
      return "corner noise";
    case ErrorSource::kIntrinsics:
      return "intrinsics";
    case ErrorSource::kPlate:
      return "plate on the flange";
    case ErrorSource::kJoints:
      return "joint offsets and links";
    case ErrorSource::kRepeatability:
      return "repeatability";
    case ErrorSource::kDepthBias:
      return "depth bias";
  }
  return "";
}

CalibrationErrors no_errors() { return {0, 0, 0, 0, 0, 0, 0, 0, 0}; }

CalibrationErrors only(const CalibrationErrors& errors, ErrorSource source) {
  CalibrationErrors one = no_errors();
  if (source == ErrorSource::kCorners) one.corner = errors.corner;
  if (source == ErrorSource::kIntrinsics) one.focal = errors.focal, one.centre = errors.centre;
  if (source == ErrorSource::kPlate) one.plate_shift = errors.plate_shift, one.plate_turn = errors.plate_turn;
  if (source == ErrorSource::kJoints) one.joint_offset = errors.joint_offset, one.link = errors.link;
  if (source == ErrorSource::kRepeatability) one.repeatability = errors.repeatability;
  if (source == ErrorSource::kDepthBias) one.disparity_bias = errors.disparity_bias;
  return one;
}

BuiltArm::BuiltArm(const Arm& drawn, const CalibrationErrors& errors, const Normals& normal) : drawn_(&drawn) {
  for (int j = 0; j < 6; ++j) offset_[j] = errors.joint_offset * normal();
  for (Eigen::Vector3d& error : length_error_)
    for (int k = 0; k < 3; ++k) error[k] = errors.link * normal();
}

Pose BuiltArm::forward(const Vector6d& q) const {
  const Vector6d turned = q + offset_;
  const std::vector<Pose> links = drawn_->link_poses(turned);
  Pose X_RF = Pose::Identity();
  for (std::size_t l = 0; l < length_error_.size(); ++l) {
    const Pose next = l + 1 < links.size() ? links[l + 1] : drawn_->forward(turned);
    X_RF = X_RF * Eigen::Translation3d(length_error_[l]) * (links[l].inverse() * next);
  }
  return links[0] * X_RF;
}

Pose BuiltArm::stop(const Vector6d& q, const CalibrationErrors& errors, const Normals& normal) const {
  Pose X_RF = forward(q);
  for (int k = 0; k < 3; ++k) X_RF.translation()[k] += errors.repeatability * normal();
  return X_RF;
}

PinholeCamera built_camera(const PinholeCamera& stated, const CalibrationErrors& errors, const Normals& normal) {
  PinholeCamera built = stated;
  const double stretch = 1 + errors.focal * normal();
  built.fx *= stretch, built.fy *= stretch;
  built.cx += errors.centre * normal();
  built.cy += errors.centre * normal();
  return built;
}

}  // namespace binpick

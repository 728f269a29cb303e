#include "trials/calibration/calibration_trial.hpp"

#include <cmath>

#include "core/error.hpp"
#include "core/hash.hpp"
#include "robot/inverse_kinematics.hpp"
#include "trials/calibration/plate_images.hpp"

namespace binpick {
namespace {

constexpr double kBaseline = 0.050;  // m, of the depth camera (D435)

/// The cell as it is built, and what its cameras make of a plate.
class BuiltCell {
 public:
  BuiltCell(const CalibrationSetup& setup, const CalibrationErrors& errors, const Normals& normal)
      : setup_(setup), errors_(errors), normal_(normal), arm_(*setup.cell->arm, errors, normal) {
    camera_C_ = built_camera(setup.camera_C, errors, normal);
    camera_D_ = built_camera(setup.camera_D, errors, normal);
    Vector6d twist;
    for (int k = 0; k < 3; ++k) twist[k] = errors.plate_shift * normal();
    for (int k = 3; k < 6; ++k) twist[k] = errors.plate_turn * normal();
    X_FQ_ = setup.X_FQ * exp_se3(twist);
  }

  Pose flange_at_stop(const Vector6d& q) const { return setup_.cell->X_WR * arm_.stop(q, errors_, normal_); }
  const Pose& X_FQ() const { return X_FQ_; }

  /// The plate's pose as the fixed camera, or the one on the flange, measures it.
  Pose seen_by_D(const Pose& X_DQ) const { return seen(X_DQ, setup_.camera_D, camera_D_); }
  Pose seen_by_C(const Pose& X_CQ) const { return seen(X_CQ, setup_.camera_C, camera_C_); }

 private:
  Pose seen(const Pose& X_CQ, const PinholeCamera& stated, const PinholeCamera& built) const {
    const std::vector<SeenCorner> corners = setup_.images ? found_corners(X_CQ, built) : disturbed_corners(X_CQ, built);
    const std::optional<Pose> pose = plate_pose(corners, setup_.plate, stated);
    if (!pose) throw SpecError("calibration: no marker of the plate is found in an image");
    return *pose;
  }

  /// Another calibration has another number, another image another pose: its noise is its own.
  std::vector<SeenCorner> found_corners(const Pose& X_CQ, const PinholeCamera& built) const {
    return setup_.images->corners(X_CQ, built, Seed{Hasher().add(X_CQ).add(normal_()).value()});
  }

  std::vector<SeenCorner> disturbed_corners(const Pose& X_CQ, const PinholeCamera& built) const {
    std::vector<SeenCorner> corners;
    const std::vector<Eigen::Vector3d> corners_Q = setup_.plate.corners_Q();
    for (std::size_t i = 0; i < corners_Q.size(); ++i) {
      Eigen::Vector2d pixel = built.project(X_CQ * corners_Q[i]);
      for (int k = 0; k < 2; ++k) pixel[k] += errors_.corner * normal_();
      corners.push_back({i, pixel});
    }
    return corners;
  }

  const CalibrationSetup& setup_;
  const CalibrationErrors& errors_;
  const Normals& normal_;
  BuiltArm arm_;
  PinholeCamera camera_C_, camera_D_;
  Pose X_FQ_;
};

Pose drawn_flange(const CalibrationSetup& setup, const Vector6d& q) {
  return setup.cell->X_WR * setup.cell->arm->forward(q);
}

Pose by_chain(const CalibrationSetup& setup, const BuiltCell& built) {
  const Pose X_WF_shown = built.flange_at_stop(setup.q_shown);
  const Pose X_DQ_shown = built.seen_by_D(setup.X_WD.inverse() * X_WF_shown * built.X_FQ());
  const Pose X_WD = drawn_flange(setup, setup.q_shown) * setup.X_FQ * X_DQ_shown.inverse();  // eq. 6
  const Pose X_WC = built.flange_at_stop(setup.q_look) * setup.cell->camera.pose;
  const Pose X_DQ = built.seen_by_D(setup.X_WD.inverse() * setup.X_WQ);
  const Pose X_CQ = built.seen_by_C(X_WC.inverse() * setup.X_WQ);
  const Pose X_DC = X_DQ * X_CQ.inverse();                           // eq. 7
  return drawn_flange(setup, setup.q_look).inverse() * X_WD * X_DC;  // eq. 8
}

Pose by_hand_eye(const CalibrationSetup& setup, const BuiltCell& built, HandEyeMethod method) {
  std::vector<Pose> X_RF, X_CQ;
  for (const Vector6d& q : setup.q_hand_eye) {
    const Pose X_WC = built.flange_at_stop(q) * setup.cell->camera.pose;
    X_RF.push_back(setup.cell->arm->forward(q));
    X_CQ.push_back(built.seen_by_C(X_WC.inverse() * setup.X_WQ));
  }
  const HandEyeResult result = hand_eye(X_RF, X_CQ, method);
  if (result.degenerate) throw SpecError("hand-eye calibration: the looks turn about one axis only");
  return result.X_FC;
}

Pose by_method(const CalibrationSetup& setup, const BuiltCell& built, CalibrationMethod method) {
  if (method == CalibrationMethod::kChain) return by_chain(setup, built);
  return by_hand_eye(setup, built, method == CalibrationMethod::kPark ? HandEyeMethod::kPark : HandEyeMethod::kHoraud);
}

/// A point as a stereo camera with a constant disparity offset measures it.
Eigen::Vector3d with_depth_bias(const Eigen::Vector3d& p_C, double focal, double bias) {
  const double disparity = focal * kBaseline / p_C.z();
  return p_C * (disparity / (disparity + bias));
}

/// Where the tip comes to stand, against where it should.
void take_part(const CalibrationSetup& setup, const BuiltCell& built, const Pose& X_FC, double bias,
               CalibrationError& error) {
  const Cell& cell = *setup.cell;
  const Pose X_WG = cell.tip_pose(setup.q_pick);  // of the part's grasp
  const Pose X_CG = (built.flange_at_stop(setup.q_look) * cell.camera.pose).inverse() * X_WG;
  const Pose measured = pose_from(X_CG.linear(), with_depth_bias(X_CG.translation(), cell.camera.intrinsics.fx, bias));
  const Pose believed_W = drawn_flange(setup, setup.q_look) * X_FC * measured;
  const Pose X_RF = cell.X_WR.inverse() * believed_W * cell.gripper->X_FG().inverse();
  const std::optional<Vector6d> q = following_solution(*cell.arm, X_RF, setup.q_pick);
  if (!q) throw SpecError("calibration: so far off that the arm cannot go where the part is believed");
  const Pose reached = built.flange_at_stop(*q) * cell.gripper->X_FG();
  error.tip = distance_between(reached, X_WG);
  error.tip_turn = angle_between(reached.linear(), X_WG.linear());
}

CalibrationError error_of(const CalibrationSetup& setup, const Pose& X_FC) {
  CalibrationError error;
  error.X_CC = setup.cell->camera.pose.inverse() * X_FC;
  error.shift = error.X_CC.translation().norm();
  error.turn = angle_between(error.X_CC.linear(), Eigen::Matrix3d::Identity());
  return error;
}

}  // namespace

std::string to_string(CalibrationMethod method) {
  switch (method) {
    case CalibrationMethod::kChain:
      return "chain";
    case CalibrationMethod::kPark:
      return "park";
    case CalibrationMethod::kHoraud:
      return "horaud";
  }
  return "";
}

Pose calibrate(const CalibrationSetup& setup, const CalibrationErrors& errors, CalibrationMethod method,
               const Normals& normal) {
  return by_method(setup, BuiltCell(setup, errors, normal), method);
}

Pose calibration_offset(const CalibrationSetup& setup, const CalibrationErrors& errors, CalibrationMethod method,
                        Seed seed) {
  Rng rng = seed.child("calibration").rng();
  const Pose X_FC = calibrate(setup, errors, method, [&rng] { return rng.normal(); });
  return setup.cell->camera.pose.inverse() * X_FC;
}

CalibrationError calibration_error(const CalibrationSetup& setup, const CalibrationErrors& errors,
                                   CalibrationMethod method, const Normals& normal) {
  const BuiltCell built(setup, errors, normal);
  const Pose X_FC = by_method(setup, built, method);
  CalibrationError error = error_of(setup, X_FC);
  take_part(setup, built, X_FC, errors.disparity_bias * normal(), error);
  return error;
}

CalibrationError calibration_error(const CalibrationSetup& setup, const CalibrationErrors& errors,
                                   CalibrationMethod method, Seed seed) {
  Rng rng = seed.child("calibration").rng();
  return calibration_error(setup, errors, method, [&rng] { return rng.normal(); });
}

CalibrationSpread calibration_spread(const CalibrationSetup& setup, const CalibrationErrors& errors,
                                     CalibrationMethod method, std::uint64_t first_seed, int draws) {
  CalibrationSpread spread;
  for (int k = 0; k < draws; ++k) {
    const CalibrationError e =
        calibration_error(setup, errors, method, Seed{first_seed + static_cast<std::uint64_t>(k)});
    spread.shift += e.shift * e.shift / draws, spread.turn += e.turn * e.turn / draws;
    spread.tip += e.tip * e.tip / draws, spread.tip_turn += e.tip_turn * e.tip_turn / draws;
    spread.shifts.push_back(e.shift), spread.tips.push_back(e.tip);
  }
  for (double* square : {&spread.shift, &spread.turn, &spread.tip, &spread.tip_turn}) *square = std::sqrt(*square);
  return spread;
}

PredictedError predicted_error(const CalibrationSetup& setup, const CalibrationErrors& errors,
                               CalibrationMethod method) {
  std::size_t count = 0;
  calibration_error(setup, errors, method, [&count] { return ++count, 0.0; });
  constexpr double kPart = 0.05;  // of a standard deviation: straight enough, and far above rounding
  const auto with = [&](std::size_t which, double value) {
    std::size_t k = 0;
    return calibration_error(setup, errors, method, [&] { return k++ == which ? value : 0.0; });
  };
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < count; ++k) {
    const CalibrationError plus = with(k, kPart), minus = with(k, -kPart);
    const Pose X = minus.X_CC.inverse() * plus.X_CC;
    squares +=
        Eigen::Vector3d(X.translation().squaredNorm(), log_so3(X.linear()).squaredNorm(), 0) / (4 * kPart * kPart);
    squares.z() += std::pow((plus.tip + minus.tip) / (2 * kPart), 2);
  }
  return {std::sqrt(squares.x()), std::sqrt(squares.y()), std::sqrt(squares.z())};
}

}  // namespace binpick

#include "trials/calibration/hand_eye.hpp"

#include <Eigen/SVD>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

#include "core/check.hpp"
#include "core/error.hpp"

namespace binpick {
namespace {

constexpr double kLeastTurn = 0.05;  // rad, of the second of the three spread axes: below it noise decides

/// Second largest spread (rad, root mean square) of the rotations between the first pose and the others: two axes that
/// are not parallel are needed (Tsai, Lenz 1989).
double second_spread(std::span<const Pose> X_RF) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const Pose& X : X_RF) {
    const Eigen::Vector3d turn = log_so3(X_RF[0].linear().transpose() * X.linear());
    sum += turn * turn.transpose() / static_cast<double>(X_RF.size());
  }
  return std::sqrt(Eigen::JacobiSVD<Eigen::Matrix3d>(sum).singularValues()[1]);
}

cv::HandEyeCalibrationMethod cv_method(HandEyeMethod method) {
  switch (method) {
    case HandEyeMethod::kTsai:
      return cv::CALIB_HAND_EYE_TSAI;
    case HandEyeMethod::kPark:
      return cv::CALIB_HAND_EYE_PARK;
    case HandEyeMethod::kHoraud:
      return cv::CALIB_HAND_EYE_HORAUD;
    case HandEyeMethod::kAndreff:
      return cv::CALIB_HAND_EYE_ANDREFF;
    case HandEyeMethod::kDaniilidis:
      return cv::CALIB_HAND_EYE_DANIILIDIS;
  }
  BP_CHECK(false);
  return cv::CALIB_HAND_EYE_PARK;
}

void add(const Pose& X, std::vector<cv::Mat>& rotations, std::vector<cv::Mat>& translations) {
  cv::Mat R, t;
  cv::eigen2cv(Eigen::Matrix3d(X.linear()), R);
  cv::eigen2cv(Eigen::Vector3d(X.translation()), t);
  rotations.push_back(R);
  translations.push_back(t);
}

}  // namespace

std::string to_string(HandEyeMethod method) {
  switch (method) {
    case HandEyeMethod::kTsai:
      return "tsai";
    case HandEyeMethod::kPark:
      return "park";
    case HandEyeMethod::kHoraud:
      return "horaud";
    case HandEyeMethod::kAndreff:
      return "andreff";
    case HandEyeMethod::kDaniilidis:
      return "daniilidis";
  }
  return "";
}

HandEyeResult hand_eye(std::span<const Pose> X_RF, std::span<const Pose> X_CQ, HandEyeMethod method) {
  BP_CHECK(X_RF.size() == X_CQ.size());
  if (X_RF.size() < 3) throw SpecError("hand-eye calibration needs three poses at least");
  HandEyeResult result;
  result.degenerate = second_spread(X_RF) < kLeastTurn;
  if (result.degenerate) return result;
  std::vector<cv::Mat> R_RF, t_RF, R_CQ, t_CQ;
  for (std::size_t i = 0; i < X_RF.size(); ++i) {
    add(X_RF[i], R_RF, t_RF);
    add(X_CQ[i], R_CQ, t_CQ);
  }
  cv::Mat R_FC, t_FC;
  cv::calibrateHandEye(R_RF, t_RF, R_CQ, t_CQ, R_FC, t_FC, cv_method(method));
  Eigen::Matrix3d R;
  Eigen::Vector3d t;
  cv::cv2eigen(R_FC, R);
  cv::cv2eigen(t_FC, t);
  result.X_FC = orthonormalised(pose_from(R, t));
  return result;
}

}  // namespace binpick

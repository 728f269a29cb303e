// Where a camera sits on the flange, from several looks at one plate that stands still.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/pose.hpp"

namespace binpick {

enum class HandEyeMethod { kTsai, kPark, kHoraud, kAndreff, kDaniilidis };
std::string to_string(HandEyeMethod method);

struct HandEyeResult {
  Pose X_FC = Pose::Identity();
  /// The turns between the poses are too small or about one axis only: the rest of X_FC is anything.
  bool degenerate = false;
};

/// X_FC from poses of the flange (X_RF) and of the plate in the camera (X_CQ) at the same times, by
/// cv::calibrateHandEye. In the OpenCV 4.6 of Debian 12 kTsai, kDaniilidis and, for many X_FC, kHoraud miss exact data
/// when looks are turned far against each other (tests/trials/hand_eye_test.cpp); kPark does not. Throws SpecError for
/// fewer than three poses.
HandEyeResult hand_eye(std::span<const Pose> X_RF, std::span<const Pose> X_CQ, HandEyeMethod method);

}  // namespace binpick

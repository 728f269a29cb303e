// The seed paper's Tables 1 to 4 beside ours, with intervals. Markdown in mm, deg and ms; JSON in SI.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/pose.hpp"
#include "evaluation/trial_record.hpp"

namespace binpick {

/// One turn of the paper's verification (5.2): the pose of the tool at the part to be picked, in the robot's base R, as
/// the teach pendant shows it, and as recognition asks for it.
struct VerifiedPose {
  std::uint64_t seed = 0;
  Pose X_RG_taught = Pose::Identity();
  std::optional<Pose> X_RG_found;  ///< nothing: the part was not recognised
  std::string failure;             ///< why there is none
};

/// Absolute differences of position (m) and of roll, pitch, yaw (rad, wrapped); of recognised parts only.
struct VerifiedErrors {
  std::vector<Eigen::Vector3d> xyz, rpy;
};
VerifiedErrors verified_errors(std::span<const VerifiedPose> poses);
/// The paper's five poses, as the coordinates that it prints differ.
VerifiedErrors paper_errors();

/// The verification with one estimator and one calibration.
struct PaperVerification {
  std::string name;
  std::vector<VerifiedPose> poses;
};
/// Rounds of picking until the bin is empty, one a seed.
struct PaperRounds {
  std::string name;
  std::vector<TrialRecord> records;
};
struct PaperComparison {
  std::vector<PaperVerification> verifications;
  std::vector<PaperRounds> rounds;
};

/// Tables 1 to 4, and what is wrong in the paper's own arithmetic.
std::string paper_tables(const PaperComparison& ours);
std::string paper_json(const PaperComparison& ours);

}  // namespace binpick

// What a pose estimator returns: every instance it believes in, best first, and where its time went.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/bin_spec.hpp"
#include "core/depth_frame.hpp"
#include "core/point_cloud.hpp"
#include "core/pose.hpp"

namespace binpick {

/// What an estimator is given: all as believed by the cell, never the truth.
struct SceneView {
  std::variant<DepthFrame, PointCloud> seen;  ///< a cloud is in C
  std::optional<BinSpec> bin;
  Pose X_CB = Pose::Identity();  ///< believed pose of the bin; meaningful only with `bin`
  StatedNoise cloud_noise;       ///< of a cloud's points along z of C; a frame brings its own
  /// Of a frame: the pixels that show parts (not 0), where somebody has segmented it; else the estimator does. Type ppf
  /// takes it for what it is; others look for themselves.
  std::shared_ptr<const Image<std::uint8_t>> segmentation;
  int threads = 1;  ///< that the estimator may use; its answer does not depend on it

  const StatedNoise& noise() const {
    const auto* frame = std::get_if<DepthFrame>(&seen);
    return frame ? frame->noise : cloud_noise;
  }
};

struct PoseEstimate {
  std::size_t part = 0;  ///< index into the parts given to prepare()
  Pose X_CP = Pose::Identity();
  double score = 0;                        ///< 0 .. 1, larger is better
  bool ambiguous = false;                  ///< another pose of the part looks the same from here (beyond its symmetry)
  double fit_rms = 0;                      ///< m, RMS distance of explained scene points from the model's surface
  double inlier_fraction = 0;              ///< explained / visible model points
  Matrix6d covariance = Matrix6d::Zero();  ///< of log_se3(X_CP^-1 X_CP_true) twists: translation m, rotation rad, in P
};

/// Wall times in seconds, named as in the paper's Table 4. They decide nothing and enter no hash.
struct StageTimes {
  double preprocess = 0;
  double voting = 0;
  double verification = 0;
  double icp = 0;
  double total = 0;
};

enum class EstimateStatus { kFound, kNothingFound, kFailed };

struct EstimateResult {
  EstimateStatus status = EstimateStatus::kNothingFound;
  std::vector<PoseEstimate> estimates;  ///< best first
  StageTimes wall;
  std::string message;  ///< why it failed or found nothing, where that is known
};

}  // namespace binpick

// Estimates against truth: errors modulo symmetry, one-to-one matching, and the counts behind recall and precision.
// Definitions: ARCHITECTURE section 14 (docs/architecture.md): a pose is right when MSSD < 0.1 diameter.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/ground_truth.hpp"
#include "core/part.hpp"
#include "core/pose_estimate.hpp"
#include "evaluation/scoring_model.hpp"

namespace binpick {

/// Errors of one estimate against one instance, at the nearest symmetric twin of the truth.
struct PoseError {
  double mssd = 0;         ///< m, largest vertex distance, least over the symmetries
  double add_s = 0;        ///< m, mean distance of true vertices to the nearest estimated vertex
  double translation = 0;  ///< m, at the mesh's bounding-box centre
  double rotation = 0;     ///< rad
  Eigen::Vector3d abs_xyz = Eigen::Vector3d::Zero();  ///< m, per axis of W, at the bounding-box centre (paper Table 1)
  /// rad, differences of roll, pitch and yaw, wrapped (paper Table 2). Near pitch = 90 deg roll and yaw lose their
  /// meaning one by one and their differences grow; `rotation` does not.
  Eigen::Vector3d abs_rpy = Eigen::Vector3d::Zero();
};

PoseError pose_error(const Pose& X_WP_est, const Pose& X_WP_true, const ScoringModel& model);
PoseError pose_error(const Pose& X_WP_est, const Pose& X_WP_true, const Part& part);  ///< prepares the part each time

struct MatchedEstimate {
  std::size_t estimate = 0;  ///< index into EstimateResult::estimates
  /// Index into GroundTruth::instances: the one it was matched to, or else the nearest (least MSSD) of the same part.
  /// Without any, the errors are NaN.
  std::optional<std::size_t> instance;
  double score = 0;
  double fit_rms = 0;
  PoseError error;           ///< against `instance`
  bool right = false;        ///< MSSD < 0.1 diameter and matched one to one
  bool right_tight = false;  ///< the same at 0.05 diameter
  bool right_2mm = false;    ///< the same at 2 mm
  bool ignored = false;      ///< its instance is visible < 0.1: counts neither way
};

struct PoseCheck {
  std::vector<MatchedEstimate> estimates;  ///< in the order of the result, best first
  std::size_t visible = 0;                 ///< instances visible >= 0.5
  std::size_t found = 0;                   ///< of those, matched by a right estimate
  std::size_t found_tight = 0;             ///< the same at 0.05 diameter
  std::size_t found_2mm = 0;               ///< the same at 2 mm
  std::size_t counted = 0;                 ///< estimates that count for precision
  std::size_t right = 0;                   ///< of those, right
};

/// The parts of a scene, prepared once for scoring.
///
/// Matching, for each of the three thresholds on its own: estimates by descending score (equal scores in their order)
/// take the unmatched instance of their part with the least MSSD strictly below the threshold; instances visible >= 0.1
/// go first, only then the nearly hidden ones, whose estimates are then ignored. A second estimate of one instance is
/// wrong.
class PoseChecker {
 public:
  explicit PoseChecker(std::span<const Part> parts);

  /// X_WC_believed places the estimates in W; the truth knows where things are.
  PoseCheck check(const EstimateResult& result, const Pose& X_WC_believed, const GroundTruth& truth) const;

 private:
  std::vector<ScoringModel> models_;
};

/// The same for one look; prepares the parts each time.
PoseCheck check_poses(const EstimateResult& result, const Pose& X_WC_believed, const GroundTruth& truth,
                      std::span<const Part> parts);

}  // namespace binpick

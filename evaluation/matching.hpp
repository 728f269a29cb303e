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

namespace binpick {

/// Errors of one estimate against one instance, at the nearest symmetric twin of the truth.
struct PoseError {
  double mssd = 0;          ///< m, largest vertex distance, least over the symmetries
  double add_s = 0;         ///< m, mean distance of true vertices to the nearest estimated vertex
  double translation = 0;   ///< m, at the mesh's bounding-box centre
  double rotation = 0;      ///< rad
  Eigen::Vector3d abs_xyz = Eigen::Vector3d::Zero();  ///< m, per axis of W, at the bounding-box centre (paper Table 1)
  Eigen::Vector3d abs_rpy = Eigen::Vector3d::Zero();  ///< rad, per axis, wrapped (paper Table 2)
};

PoseError pose_error(const Pose& X_WP_est, const Pose& X_WP_true, const Part& part);

struct MatchedEstimate {
  std::size_t estimate = 0;              ///< index into EstimateResult::estimates
  std::optional<std::size_t> instance;   ///< index into GroundTruth::instances: the one it was matched to, or the nearest
  double score = 0;
  double fit_rms = 0;
  PoseError error;                       ///< against `instance`
  bool right = false;                    ///< MSSD < 0.1 diameter and matched one to one
  bool right_tight = false;              ///< the same at 0.05 diameter
  bool right_2mm = false;                ///< the same at 2 mm
  bool ignored = false;                  ///< its instance is visible < 0.1: counts neither way
};

struct PoseCheck {
  std::vector<MatchedEstimate> estimates;  ///< in the order of the result, best first
  std::size_t visible = 0;                 ///< instances visible >= 0.5
  std::size_t found = 0;                   ///< of those, matched by a right estimate
  std::size_t counted = 0;                 ///< estimates that count for precision
  std::size_t right = 0;                   ///< of those, right
};

/// X_WC_believed places the estimates in W; the truth knows where things are.
PoseCheck check_poses(const EstimateResult& result, const Pose& X_WC_believed, const GroundTruth& truth,
                      std::span<const Part> parts);

}  // namespace binpick

// The last word on a refined pose: the part is drawn at it and every pixel of its silhouette is compared with the scene
// (inlier, covered, seen through, unknown), and just outside the outline it is asked whether the scene's surface simply
// goes on (then the pose only leans on somebody else's larger face: a leak). Poses that claim the same pixels or the
// same space are settled in favour of the better one. Frame C, metres.
#pragma once

#include <cstdint>
#include <vector>

#include "core/pose_estimate.hpp"
#include "perception/hypothesis_check.hpp"
#include "perception/icp.hpp"
#include "perception/part_view.hpp"
#include "perception/pose_evidence.hpp"

namespace binpick {

struct AcceptConfig {
  double least_quality = 0.5;     ///< inliers / (inliers + contradictions)
  double sure_quality = 0.75;     ///< from here on a pose keeps the search away from its place
  double least_explained = 0.25;  ///< inliers / pixels of the whole silhouette
  int least_pixels = 60;          ///< inliers
  double largest_leak = 0.6;      ///< of the outline that could be judged
  double least_own = 0.6;         ///< of a pose's inliers that no better pose claims
  double largest_overlap = 0.1;   ///< of a pose's surface that may lie inside a better pose

  double largest_side_leak = 0.7;  ///< of one side of the outline, at which the surface goes on unexplained
  /// Probability that the pose, or its twin, is right: below, it is not returned. The score's prior is that the part
  /// may well not be there; where it is (least_presence), 20 of 22 poses scored 0.35 to 0.5 on tuning heaps were right.
  double least_score = 0.35;
  /// Probability that the view holds the part at all, 1 - prod(1 - score) over its poses: below, none is returned. A
  /// heap of the part shows several, or one that is plain to see; what resembles the part shows a doubtful one.
  double least_presence = 0.92;

  void visit(ConfigVisitor& v);
  void validate() const;
};

struct ViewCheck {
  int pixels = 0, inliers = 0, covered = 0, through = 0, unknown = 0, off = 0;
  double leak = 0;                       ///< share of the judged outline at which the surface goes on
  std::vector<std::uint32_t> explained;  ///< indices of the inlier pixels in the image

  double quality() const {
    const double against = 2.0 * through + off;
    return inliers > 0 ? inliers / (inliers + against) : 0;
  }
  double explained_share() const { return pixels > 0 ? static_cast<double>(inliers) / pixels : 0; }
  double score() const { return quality() * explained_share() * (1 - 0.5 * leak); }
};

ViewCheck check_view(const Scene& scene, const SurfaceModel& model, const Pose& X_CP, const CheckConfig& config);

/// Share of the surface points of part `b` that lie inside part `a`, deeper than `slack` (m).
double overlap(const SurfaceModel& a, const Pose& X_Ca, const SurfaceModel& b, const Pose& X_Cb, float slack);
/// The depth inside another part that errors of two poses may feign, m.
float overlap_slack(const Scene& scene, const Pose& X_CP);

bool accepted(const ViewCheck& check, const AcceptConfig& config);

/// A refined pose with what speaks for it.
struct Candidate {
  std::size_t part = 0;
  IcpResult fit;
  ViewCheck check;
  double own = 1;          ///< share of its inliers that no better pose claims
  double overlap = 0;      ///< share of its surface that lies inside a better pose
  PoseEvidence evidence;   ///< once all that stand are known
  double score = 0;        ///< calibrated (score_calibration)
  bool settled = false;    ///< its rivals have been tried (rival_poses)
  bool ambiguous = false;  ///< and one of them explains the view as well
};

/// The candidates that can stand together, best first. `models[c.part]` is the model of candidate c.
std::vector<Candidate> resolve_conflicts(std::vector<Candidate> candidates,
                                         const std::vector<const SurfaceModel*>& models, const Scene& scene,
                                         const AcceptConfig& config);

}  // namespace binpick

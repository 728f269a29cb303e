// What one look at one heap says about one kind of part, in numbers that can be pooled. Definitions: ARCHITECTURE
// section 14; matching and errors are evaluation's (PoseChecker). SI.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "evaluation/matching.hpp"
#include "evaluation/statistics.hpp"

namespace binpick {

/// An instance visible >= 0.5 that no right estimate was given for.
struct MissedInstance {
  std::uint64_t seed = 0;
  std::size_t body = 0;  ///< heap index
  Pose X_CP = Pose::Identity();
  double visible_fraction = 0;
  int visible_pixels = 0;
  bool ambiguous_view = false;
  double nearest_mssd = 0;   ///< m, of the nearest estimate to which no other instance is nearer; NaN: none
  double nearest_score = 0;  ///< its score
};

/// An estimate that is wrong.
struct WrongEstimate {
  std::uint64_t seed = 0;
  std::size_t rank = 0;  ///< 0: the first of the whole result
  double score = 0;
  bool ambiguous = false;       ///< flagged by the estimator
  bool ambiguous_view = false;  ///< the nearest instance's view does not hold the answer
  Pose X_CP = Pose::Identity();
  std::optional<std::size_t> body;  ///< of the nearest instance
  PoseError error;                  ///< against it
  double visible_fraction = 0;
  int visible_pixels = 0;
  bool duplicate = false;  ///< would be right, had the instance not been given away already
};

/// A right estimate's deviation.
struct RightEstimate {
  double translation = 0;  ///< m, at the box centre
  double lateral = 0;      ///< m, of it across the viewing direction
  double z = 0;            ///< m, of it along z of C, signed: estimate minus truth
  double rotation = 0;     ///< rad
};

/// What a calibration of the scores can go by.
struct ScoredEstimate {
  double score = 0;
  bool right = false;
  bool ambiguous = false;  ///< flagged by the estimator
  double inlier_fraction = 0;
  double fit_rms = 0;        ///< m
  std::size_t estimate = 0;  ///< index in the result
};

struct LookScore {
  std::uint64_t seed = 0;
  ClusterCount recall;              ///< instances visible >= 0.5
  ClusterCount recall_clear;        ///< of those, whose view holds the answer
  ClusterCount recall_partly;       ///< 0.3 .. 0.5
  ClusterCount recall_tight;        ///< >= 0.5, at 0.05 diameter
  ClusterCount precision;           ///< estimates that count
  ClusterCount precision_clear;     ///< of those, whose nearest instance is not seen ambiguously
  ClusterCount precision_sure;      ///< of those that count, not flagged as ambiguous by the estimator
  std::optional<bool> top1;         ///< is the first estimate of this part right? Empty: nothing visible, nothing said
  bool top1_in_clear_view = true;   ///< its nearest instance is not seen ambiguously
  std::optional<bool> first_right;  ///< of the search for one pose only: is it right? Empty: not of this part
  std::vector<RightEstimate> right;
  std::vector<MissedInstance> missed;
  std::vector<WrongEstimate> wrong;
  std::vector<ScoredEstimate> scored;                 ///< everything that counts for precision
  std::vector<std::pair<int, bool>> found_by_pixels;  ///< visible pixels and whether found, instances visible >= 0.5
};

/// One part's share of a look. `X_WC` is the camera as believed, the frame of the estimates.
struct LookJudge {
  const GroundTruth& truth;
  const EstimateResult& result;
  const PoseCheck& check;
  const std::vector<Part>& parts;
  const std::vector<bool>& ambiguous;  ///< by instance: its true view does not hold the answer
  Pose X_WC;
  LookScore of_part(std::size_t part, std::uint64_t seed) const;
};

}  // namespace binpick

// The oracle: estimates made from the truth, disturbed by a stated error. It bounds what any estimator can reach,
// proves the rest of the loop, and is the only estimator that reads truth. `estimator: {type: oracle, ..}`.
#pragma once

#include <span>

#include "core/config.hpp"
#include "core/ground_truth.hpp"
#include "core/part.hpp"
#include "core/pose_estimate.hpp"
#include "core/random.hpp"

namespace binpick {

struct OracleConfig {
  double translation_error = 0;  ///< m, standard deviation per axis of C
  double rotation_error = 0;     ///< rad, standard deviation per axis
  double min_visible = 0.3;      ///< instances seen less are not reported
  void visit(ConfigVisitor& v);
  void validate() const;
};

/// Instances visible at least `min_visible`, most visible first, as poses in the believed camera frame.
EstimateResult oracle_estimate(const GroundTruth& truth, std::span<const Part> parts, const OracleConfig& config,
                               Seed seed);

}  // namespace binpick

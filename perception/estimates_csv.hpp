// Poses as a table: what `binpick estimate` writes and what an external estimator answers (docs/external_protocol.md).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/part.hpp"
#include "core/pose_estimate.hpp"

namespace binpick {

/// part,score,fit_rms,inlier_fraction,r11..r33 (row-major),tx,ty,tz of X_CP in metres; one row an estimate, best first.
std::string estimates_csv(const EstimateResult& result);

/// Reads such a table strictly: part, score, r11 .. r33, tx, ty, tz in any order; fit_rms, inlier_fraction, ambiguous,
/// sigma_t (m) and sigma_r (rad) may stand beside them. Best first, whatever the order of the rows. Throws AssetError
/// with file, line and what is wrong: not a number, no rotation, no such part, a score outside 0 .. 1.
std::vector<PoseEstimate> read_estimates_csv(const std::string& path, std::span<const Part> parts);

}  // namespace binpick

// Estimates in BOP's results file: scene_id,im_id,obj_id,score,R,t,time (docs/bop_challenge_2019.md of the BOP
// toolkit). R is nine numbers, row by row, t three in millimetres, time the seconds of the whole image, -1 when
// unknown.
#pragma once

#include <string>
#include <vector>

#include "core/pose.hpp"

namespace binpick {

struct BopEstimate {
  int scene = 0, image = 0, object = 0;
  double score = 0;
  Pose X_CO = Pose::Identity();
  double time = -1;  ///< s
};

/// Strict. The header may be missing, as the toolkit lets it. Throws AssetError that names file and line: not seven
/// fields, not a number, no rotation, times of one image that differ by more than a millisecond.
std::vector<BopEstimate> read_bop_results(const std::string& path);

/// Reads back to the same values, but for the last digit of t.
std::string bop_results_csv(const std::vector<BopEstimate>& estimates);

}  // namespace binpick

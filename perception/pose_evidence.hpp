// What a refined pose that stands among others shows in detail, beyond the counts of view_check: evidence that tells
// the right part from one that merely shares a face with it. The part is drawn at the pose once more and asked
//   - where the outline ends and the scene's own surface runs on, straight or bent (rim_evidence);
//   - where the part should be and the scene is seen behind it, not along edges, but over whole patches;
//   - whether what covers it stands well off, as an occluder does, or grows out of the explained surface or runs along
//     just above it (a shaft of 35 mm covers the shank of a bolt of 24 mm all along);
//   - how much of the cover is itself explained by other poses;
//   - whether the residuals, averaged over patches, are as small as the sensor's stated noise lets them be;
//   - whether the scene's normals turn where the model's do.
// Frame C, metres.
#pragma once

#include <cstdint>
#include <vector>

#include "perception/hypothesis_check.hpp"
#include "perception/rim_evidence.hpp"

namespace binpick {

struct PoseEvidence {
  RimEvidence rims;
  double hollow = 0;        ///< pixels seen through among their likes, of the explained ones
  double smooth_cover = 0;  ///< of the border to what covers the part, without a depth step
  double parallel = 0;      ///< covered pixels that nobody else explains, parallel to and just above the part, of the
                            ///< explained ones
  double foreign = 0;       ///< covered pixels that nobody else explains, of the explained ones
  double residual = 0;      ///< deviation of patch means, in those that the stated noise explains
  double turned = 0;        ///< mean of 1 - cosine between scene and drawn normal
};

/// `taken`: of every pixel, how many poses other than this one, and trusted, explain it.
PoseEvidence gather_evidence(const Scene& scene, const SurfaceModel& model, const Pose& X_CP,
                             const std::vector<std::uint8_t>& taken, const CheckConfig& config);

}  // namespace binpick

// What a refined pose that stands among others shows in detail, beyond the counts of view_check: evidence that tells
// the right part from one that merely shares a face with it. The part is drawn at the pose once more and asked
//   - where the outline ends and the scene's own surface runs on, which nobody else explains (by the worst side, since
//     a bolt laid along a shaft leaks at one end only);
//   - whether what covers it stands well off, as an occluder does, or grows out of the explained surface or lies just
//     above it (a shaft of 35 mm covers the shank of a bolt of 24 mm all along);
//   - whether the residuals, averaged over patches, are as small as the sensor's stated noise lets them be;
//   - whether the scene's normals turn where the model's do.
// Frame C, metres.
#pragma once

#include <cstdint>
#include <vector>

#include "perception/hypothesis_check.hpp"

namespace binpick {

struct PoseEvidence {
  double leak_side = 0;     ///< of the judged outline of the worst of eight sides (outward directions in the image), at
                            ///< which the scene's surface goes on straight and no other pose explains it
  double judged = 0;        ///< of the outline, that could be judged
  double smooth_cover = 0;  ///< of the border to what covers the part, without a depth step
  double thin_cover = 0;    ///< of the silhouette, that lies just under what covers it
  double residual = 0;      ///< deviation of patch means, in those that the stated noise explains
  double turned = 0;        ///< mean of 1 - cosine between scene and drawn normal
};

/// `taken`: of every pixel, how many poses other than this one explain it.
PoseEvidence gather_evidence(const Scene& scene, const SurfaceModel& model, const Pose& X_CP,
                             const std::vector<std::uint8_t>& taken, const CheckConfig& config);

}  // namespace binpick

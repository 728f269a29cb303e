// type: paper_ppf. The paper's pipeline (Le Duc Hanh, Khuong Thanh Gia Hieu), section by section:
//   2    CAD -> points visible from six views                              model_cloud, once a part
//   3.1  crop, floor and walls away, normals, voxel grid                   preprocess
//   4    point pair features, 5 mm or 0.05 diameter and 12 degrees         pair_table, once a part
//   4.1  Hough voting over (model point, alpha), clustering                voting, pose_clustering
//   4.2  verification on a voxel grid, then along the rays                 hypothesis_check
//   4.2  ICP on the visible points until the mean deviation is small       icp, with the silhouette
// What the paper leaves open and this adds: parts of revolution vote once, the floor corrects the sensor's disparity,
// pairs of oriented edge points vote, too, refined poses are drawn and checked pixel by pixel, no two may claim the
// same place (view_check), and a second search looks at what is still unexplained. Deterministic; the seed is not used.
// Parameters and defaults: the sections of visit().
#include <memory>

#include "perception/ppf_pipeline.hpp"

namespace binpick {

std::unique_ptr<PoseEstimator> make_paper_ppf_estimator() {
  PpfSettings settings;
  settings.voting.partners = 0;   // every point around a reference
  settings.voting.full_cell = 1;  // every vote counts the same
  settings.check.normal_tolerance = 0.9;
  settings.accept.least_quality = settings.accept.sure_quality;  // no pose of middling quality
  return std::make_unique<PpfEstimator>(settings);
}

}  // namespace binpick

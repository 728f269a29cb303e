// The truth about a frame. sim writes it, trials and evaluation read it; perception and robot may not include this file.
#pragma once

#include <cstddef>
#include <vector>

#include "core/pose.hpp"

namespace binpick {

struct GroundTruth {
  struct Instance {
    std::size_t part = 0;      ///< index into the scenario's parts
    std::size_t body = 0;      ///< index of the instance in the heap, constant over a trial
    Pose X_WP = Pose::Identity();
    /// Pixels in the noise-free id image / pixels of the whole unoccluded silhouette, outside the image included.
    double visible_fraction = 0;
    int visible_pixels = 0;
  };
  std::vector<Instance> instances;
  Pose X_WC = Pose::Identity();  ///< where the camera really stood
};

}  // namespace binpick

// The frame as the stages share it: depth, normals and what of it may belong to a wanted part. Where the bin is known
// it is the part of the frame about the bin, with a camera to match: pixels are those of the crop. A cloud becomes an
// image of a made-up camera at its origin, so that every later stage knows one form only. Frame C, metres.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "core/bin_spec.hpp"
#include "core/depth_frame.hpp"
#include "core/image.hpp"
#include "core/pose.hpp"

namespace binpick {

struct Scene {
  PinholeCamera camera;
  Image<float> depth;              ///< z of C, corrected by the floor; NaN = unknown
  Image<std::uint8_t> wanted;      ///< 1: inside the bin, neither floor nor wall
  Image<Eigen::Vector3f> normals;  ///< towards the camera; zero where there is none to trust
  StatedNoise noise;
  std::optional<BinSpec> bin;
  /// Without a bin: (normal towards the camera, normal . point) of the large planes in view, and by pixel which one is
  /// seen there, from 1 on; empty where there are none.
  std::vector<Eigen::Vector4f> planes;
  Image<std::uint8_t> plane_of;
  Pose X_CB = Pose::Identity();
  double floor_offset = 0;   ///< 1/m, what the floor showed the inverse depth to be off by (already removed)
  int threads = 1;           ///< that a stage may use; results are put together by index
  double correlated_px = 1;  ///< pixels that share one noise value, as measured in this frame
  double floor_cut = 0;      ///< m, points lower than this above the bin's floor are not wanted

  Eigen::Vector3f point(int u, int v, float z) const {
    return {(static_cast<float>(u) - static_cast<float>(camera.cx)) / static_cast<float>(camera.fx) * z,
            (static_cast<float>(v) - static_cast<float>(camera.cy)) / static_cast<float>(camera.fy) * z, z};
  }
  /// Width of a pixel at a range, m.
  float pixel(float z) const { return z / static_cast<float>(camera.fx); }
  float sigma(float z) const { return static_cast<float>(noise.sigma(z)); }
};

}  // namespace binpick

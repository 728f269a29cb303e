// What `binpick estimate` was asked for, from the command line to a frame an estimator can be given. Private to tools.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "perception/frame_request.hpp"

namespace binpick {

struct EstimateOptions {
  std::string folder;              ///< a recorded frame; then nothing of parts, depth, cloud, camera, bin is named
  std::vector<std::string> parts;  ///< part.yaml or a mesh
  std::string unit;                ///< of meshes named directly; empty: mm
  std::string depth, camera;       ///< 16-bit PNG or float TIFF, and camera.yaml
  std::string cloud;               ///< PLY or PCD
  std::string bin;                 ///< bin.yaml: bin, X_CB
  std::vector<double> noise;       ///< constant, linear, quadratic, fattening_px; over what camera.yaml states
  std::string estimator;           ///< a name, or a YAML file with `type:` and its keys
  std::optional<std::uint64_t> seed;
};

/// Throws SpecError or AssetError in one line.
RecordedFrame read_frame(const EstimateOptions& options);

/// Loads the request's parts; one that is larger than the request's bin is an AssetError.
std::vector<Part> load_parts(const FrameRequest& request);

/// The frame's depth, or that of a made-up camera at the origin of its cloud.
DepthFrame depth_of(const SceneView& view);

/// Why nothing was found, as far as the frame itself tells.
std::string why_nothing(const SceneView& view);

}  // namespace binpick

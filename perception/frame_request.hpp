// A recorded frame as a folder: request.yaml (camera, parts, bin, believed bin pose, seed) and depth.tiff (float
// metres, NaN = no return), or instead of it cloud.ply (points in C, metres). What `binpick trial --out` writes for
// every pictured look, what `binpick estimate` reads, and what any real camera can be brought into.
#pragma once

#include <string>
#include <vector>

#include "core/bin_spec.hpp"
#include "core/config.hpp"
#include "core/part.hpp"
#include "core/pose_estimate.hpp"
#include "core/random.hpp"
#include "perception/estimates_csv.hpp"
#include "perception/pose_estimator.hpp"

namespace binpick {

struct FrameRequest {
  PinholeCamera camera;
  StatedNoise noise;
  std::vector<PartSpec> parts;
  bool has_bin = false;
  BinSpec bin;
  Pose X_CB = Pose::Identity();  ///< believed pose of the bin in the camera frame
  Seed seed;
  double time_limit = 0;  ///< s of the wall clock that an external estimator has; 0: none stated
  std::string estimator_type = "ppf";
  std::shared_ptr<PoseEstimator> estimator;  ///< made while visiting, not prepared

  void visit(ConfigVisitor& v);
  void validate() const;
};

struct RecordedFrame {
  FrameRequest request;
  SceneView view;
};

/// Keys of the stated noise, as a section `noise`; validate_noise throws SpecError.
void visit_noise(ConfigVisitor& v, StatedNoise& noise);
void validate_noise(const StatedNoise& noise);

/// Throws SpecError or AssetError in one line.
RecordedFrame read_frame_folder(const std::string& folder);
/// Throws StorageError.
void write_frame_folder(const std::string& folder, const FrameRequest& request, const SceneView& view);

}  // namespace binpick

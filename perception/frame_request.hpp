// A recorded frame as a folder: request.yaml (camera, parts, bin, believed bin pose, seed) and depth.tiff (float metres, NaN =
// no return), or instead of it cloud.ply (points in C, metres). What `binpick trial --out` writes for every pictured look, what `binpick estimate` reads, and what any real
// camera can be brought into.
#pragma once

#include <string>
#include <vector>

#include "core/bin_spec.hpp"
#include "core/config.hpp"
#include "core/part.hpp"
#include "core/pose_estimate.hpp"
#include "core/random.hpp"
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
  std::string estimator_type = "ppf";
  std::shared_ptr<PoseEstimator> estimator;  ///< made while visiting, not prepared

  void visit(ConfigVisitor& v);
  void validate() const;
};

struct RecordedFrame {
  FrameRequest request;
  SceneView view;
};

/// Throws SpecError or AssetError in one line.
RecordedFrame read_frame_folder(const std::string& folder);
/// Throws StorageError.
void write_frame_folder(const std::string& folder, const FrameRequest& request, const SceneView& view);

/// part,score,fit_rms,inlier_fraction,r11..r33 (row-major),tx,ty,tz of X_CP in metres; one row an estimate, best first.
std::string estimates_csv(const EstimateResult& result);

}  // namespace binpick

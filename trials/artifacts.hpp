// Pictures of a trial: the heap from the side, the depth as the camera saw it, the estimates drawn over the scene, the
// cup holding the part. They are made on the way and change nothing.
#pragma once

#include <string>
#include <vector>

#include "core/pose_estimate.hpp"
#include "perception/frame_request.hpp"
#include "perception/overlay.hpp"
#include "sim/depth_sensor.hpp"
#include "trials/cell_world.hpp"

namespace binpick {

/// Depth error at the ends of noise_picture's scale at depth z: three standard deviations as stated, or 1 mm where the
/// sensor states none.
double noise_scale(const StatedNoise& noise, double z);
/// Depth less exact depth: blue nearer, white right, red farther, full colour at noise_scale(); grey: exact depth but
/// no return; black: nothing there; magenta: a return where nothing is.
Image<Rgb> noise_picture(const DepthFrame& frame, const Image<float>& exact_depth);

/// Collects the pictures of one trial in a folder. A failure to write throws StorageError.
class TrialPictures {
 public:
  /// Pictures of the first `looks` looks and picks; 0: none but those of failed picks.
  TrialPictures(std::string folder, int looks) : folder_(std::move(folder)), looks_(looks) {}

  /// `prefix` goes before the pictures' names; `found` is in the frame's own C.
  void look(int pick, const std::string& prefix, DepthRenderer& renderer, const CellWorld& cell_world,
            const DepthFrame& frame, const EstimateResult& found);
  /// The frame as a folder that `binpick estimate` reads, with the estimates beside it.
  void frame(int pick, const FrameRequest& request, const SceneView& view, const EstimateResult& found);
  void moment(int pick, const char* name, DepthRenderer& renderer, const CellWorld& cell_world);
  const std::vector<std::string>& files() const { return files_; }

 private:
  std::string path(int pick, const std::string& name) const;
  void save(int pick, const std::string& name, const Image<Rgb>& image);
  std::string folder_;
  int looks_;
  std::vector<std::string> files_;
};

}  // namespace binpick

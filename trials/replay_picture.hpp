// Pictures of a replay at any time of it, drawn off screen by the simulator's own renderer: for a ticket or a README.
#pragma once

#include <memory>

#include "sim/depth_renderer.hpp"
#include "trials/replay.hpp"

namespace binpick {

class ReplayPicture {
 public:
  /// Keeps references to both.
  ReplayPicture(const Replay& replay, DepthRenderer& renderer);

  /// From beyond the bin as the robot sees it, a little off the tray's side; bin, tray and arm in the picture.
  Image<Rgb> at(double time, int width, int height) const;
  /// What is drawn: parts that are there, the cell, and the arm once it has come.
  RenderScene scene(double time) const;

 private:
  using Mesh = std::shared_ptr<const TriangleMesh>;
  Pose eye() const;  ///< X_WC
  const Replay& replay_;
  DepthRenderer& renderer_;
  std::vector<Mesh> fixed_, carried_, links_, parts_;
};

/// Where a picture says most: the first moment a part of a pick hangs in the air, else its look, else the end. `pick`
/// < 0: the first that failed, or the first.
double telling_time(const Replay& replay, int pick);
/// From the look of a pick to its end.
std::pair<double, double> span_of(const Replay& replay, int pick);

}  // namespace binpick

// The perceived heap as the robot avoids it: points in W, thinned to a grid, looked up by place. The bin's walls and
// floor are known as solids (collision_check) and are not in here.
#pragma once

#include <cstdint>
#include <vector>

#include "core/pose_estimate.hpp"
#include "core/primitive.hpp"

namespace binpick {

class ObstacleMap {
 public:
  ObstacleMap() = default;
  explicit ObstacleMap(std::vector<Eigen::Vector3d> points_W);

  const std::vector<Eigen::Vector3d>& points_W() const { return points_; }
  std::size_t size() const { return points_.size(); }

  /// Is a point nearer than `clearance` to the primitive (owner's frame O at X_WO)? Points i with ignored[i] != 0 do
  /// not count; `ignored` is empty or has one entry per point.
  bool touches(const Primitive& shape, const Pose& X_WO, double clearance, const std::vector<char>& ignored) const;

  /// Calls visit(index) for every point within the box center +- half.
  template <class Visit>
  void for_each_in(const Eigen::Vector3d& center_W, const Eigen::Vector3d& half, Visit visit) const {
    for (const std::uint32_t i : candidates(center_W, half))
      if (((points_[i] - center_W).cwiseAbs() - half).maxCoeff() <= 0) visit(i);
  }

 private:
  std::vector<std::uint32_t> candidates(const Eigen::Vector3d& center_W, const Eigen::Vector3d& half) const;

  std::vector<Eigen::Vector3d> points_;  ///< sorted by column
  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
  int columns_x_ = 0, columns_y_ = 0;
  std::vector<std::uint32_t> first_;  ///< first point of each column; one more at the end
  std::vector<double> top_;           ///< highest z of each column
};

/// What is seen inside the bin (or anywhere above the table when the view has no bin), without the points that are the
/// bin's own floor and walls: one point per 5 mm cell of a depth frame, where at least three pixels agree.
ObstacleMap perceived_heap(const SceneView& view, const Pose& X_WC);

}  // namespace binpick

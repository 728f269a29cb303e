// Private to icp.cpp: the scene points that may belong to a part near a pose, once for all iterations. Frame C, metres.
#pragma once

#include <vector>

#include "perception/scene.hpp"
#include "perception/surface_model.hpp"

namespace binpick {

class IcpPoints {
 public:
  /// Wanted pixels within `reach` (m) of the part's sphere at the pose, every n-th of a row and column, so that about
  /// `most` can lie on the part.
  IcpPoints(const Scene& scene, const SurfaceModel& model, const Pose& X_CP, double reach, int most);

  ScenePointsView view() const;
  int step() const { return step_; }  ///< px between two points

 private:
  void add(const Eigen::Vector3f& p, const Eigen::Vector3f& n);
  std::vector<float> numbers_[6];  // x y z, normal x y z
  int step_ = 1;
};

}  // namespace binpick

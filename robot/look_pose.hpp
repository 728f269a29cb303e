// Where the arm takes its flange camera for a second look, and when a fit is too poor to pick by (the paper's section
// 6: "move to the position above the object that is considered to be easiest to pick 30 cm, and execute the
// identification again"). Uses what the robot believes and has seen; truth never reaches this file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/part.hpp"
#include "core/pose_estimate.hpp"
#include "robot/cell.hpp"
#include "robot/obstacle_map.hpp"
#include "robot/plan_pick.hpp"

namespace binpick {

/// `second_look:` of a scene; `off` is the same as `when: []`.
struct SecondLookConfig {
  std::vector<std::string> when;  ///< occasions: no_plan, poor_fit, failed
  std::string from = "above";     ///< above | side
  double distance = 0.3;          ///< m, from the part's middle to the camera
  double tilt = 0.5236;           ///< rad, of the camera off the vertical, from a side
  bool fuse = true;               ///< the estimator gets both clouds as one; else the second frame alone
  double score = 0.99;            ///< a fit below is poor
  double deviation = 0.001;       ///< m: a fit is poor when lip_deviation() is above
  void visit(ConfigVisitor& v);
  void validate() const;
};

struct LookRequest {
  Eigen::Vector3d aim_W = Eigen::Vector3d::Zero();      ///< what the camera's axis meets
  Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();  ///< of the surface that is of interest: from a side, this side
  std::string from = "above";                           ///< above | side
  double distance = 0.3;                                ///< m, from the aim to the camera's origin
  double tilt = 0.5236;                                 ///< rad, of the camera's axis off the vertical, from a side
  double clearance = 0.002;                             ///< m, of arm, tool and camera from everything
};

struct LookPlan {
  Vector6d q;             ///< rad, where the arm stands
  JointTrajectory there;  ///< from the look pose; the same way leads back
  double distance = 0;    ///< m, the one asked for, or more where that cannot be reached
};

/// The quickest free way from cell.q_look to a pose of the first camera (on the flange) that looks at the aim; turns of
/// the camera in steps of 30 degrees. Above: straight down. From a side: the side that the normal leans to comes first,
/// and the aim must not be hidden by the bin's walls. Where nothing is free at the distance, up to 200 mm more, in
/// steps of 50 mm. Empty: no such pose.
std::optional<LookPlan> plan_look(const Cell& cell, const LookRequest& request, const ObstacleMap& heap);

/// The heap as seen, without the robot as it stood at q.
ObstacleMap heap_without_robot(const Cell& cell, const SceneView& view, const Pose& X_WC, const Vector6d& q);

/// Standard deviation (m) of the worst known lip of a planned pick against the part, by the estimate's covariance;
/// along its worst direction. Turns about an axis of symmetry do not count. 0 when the estimator states no covariance.
double lip_deviation(const PoseEstimate& estimate, const Pose& X_WC, const PickPlan& plan, const Part& part,
                     const Gripper& gripper);

}  // namespace binpick

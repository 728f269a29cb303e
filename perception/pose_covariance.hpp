// How well a refined pose is known. The estimate solves H x = b with H = S + O, surface and outline; its error comes
// from the noise of both, which is not what their weights assume (neighbours share noise, weights are robust):
//   C = (S + O + P)^-1 (s S + o O + P) (S + O + P)^-1
// with s and o the true variance of one unit of weight and P next to nothing, so that a direction neither speaks about
// comes out as wide as the bin and half a turn instead of as exact. Twists in P (m, rad), translation first.
#pragma once

#include "core/pose.hpp"

namespace binpick {

struct PoseInformation {
  Matrix6d surface = Matrix6d::Zero(), outline = Matrix6d::Zero();  ///< full, symmetric
  double surface_variance = 1, outline_variance = 1;
  Vector6d bias = Vector6d::Zero();  ///< standard deviation of what moves the whole part, as a twist
};

Matrix6d pose_covariance(const PoseInformation& information);

}  // namespace binpick

// Numeric inverse kinematics of any chain of six revolute joints, for arms that have no closed form: Levenberg-
// Marquardt (KDL's LMA) from many starts, then Newton steps, since KDL takes angles below 1e-6 rad for none.
// Repeatable: the starts are drawn from a named stream, and no clock decides.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "core/pose.hpp"

namespace binpick {

struct JointLimits;
struct SerialChain;

/// What a search over many starts has brought.
struct NumericBranches {
  std::vector<Vector6d> q;  ///< rad, distinct solutions in the order found, limits and whole turns ignored
  int restarts = 0;         ///< starts that were tried
  int converged = 0;        ///< of them, how many led to a solution
};

class NumericIk {
 public:
  explicit NumericIk(const SerialChain& chain);

  /// The solution of forward(q) = X_RF to which q_start leads, with a residual below 1e-9 (m and rad); not wrapped, so
  /// that it is q_start itself where that is one. Empty when the search stalls.
  std::optional<Vector6d> near(const Pose& X_RF, const Vector6d& q_start) const;

  /// The same by Newton's method alone, from a start that is all but there; quicker, and empty where it is not.
  std::optional<Vector6d> polished(const Pose& X_RF, const Vector6d& q_start) const;

  /// Every solution. Of arms of the UR type (parallel_axes) the ideal arm's, in closed form, are the starts; of all
  /// others what search() finds.
  NumericBranches branches(const Pose& X_RF, const Vector6d& q_near) const;
  bool has_parallel_axes() const;

  /// Every solution that restarts find: from q_near, from solutions with wrist, elbow or base thrown over, then from
  /// random positions within the limits, until `kQuiet` starts in a row bring nothing new. A chain of six joints has at
  /// most 16, unless it is singular there and has a continuum: then some of that, at most 16.
  NumericBranches search(const Pose& X_RF, const Vector6d& q_near) const;

  static constexpr int kQuiet = 20;     ///< starts in a row without a new solution that end a search
  static constexpr int kHopeless = 12;  ///< starts in a row without any solution: taken as out of reach

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

}  // namespace binpick

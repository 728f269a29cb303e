#include "robot/numeric_ik.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <kdl/chain.hpp>
#include <kdl/chainiksolverpos_lma.hpp>
#include <limits>
#include <numbers>

#include "core/random.hpp"
#include "robot/parallel_axes.hpp"
#include "robot/urdf_reader.hpp"

namespace binpick {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRadianWeight = 0.3;  // m per rad: a turn counts as the way at the end of a forearm
constexpr double kAim = 1e-7;          // weighted residual at which KDL's solver stops
constexpr double kNear = 1e-4;         // weighted residual from which Newton takes over
constexpr double kSmallestStep = 1e-12;
constexpr int kIterations = 60;     // beyond them restarts are worth more (measured: 90 % of starts converge in 17)
constexpr double kDistinct = 1e-3;  // rad, in any joint: nearer solutions of a search are the same one
constexpr double kJoined = 1e-7;    // rad: solutions of a closed form that Newton has brought together

// Newton's steps.
constexpr double kExact = 1e-15;    // m and rad, where rounding begins
constexpr double kGood = 1e-9;      // m and rad, residual of a solution
constexpr double kDamping = 1e-11;  // on the square of J: only directions lost to a singularity feel it
constexpr double kLongest = 0.3;    // rad: a longer step is no polish
constexpr int kSteps = 12;
constexpr std::size_t kMostSolutions = 16;

KDL::Frame to_kdl(const Pose& X) {
  const Eigen::Matrix3d R = X.linear();
  return {KDL::Rotation(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2)),
          KDL::Vector(X.translation().x(), X.translation().y(), X.translation().z())};
}

bool same(const Vector6d& a, const Vector6d& b, double distinct) {
  for (int i = 0; i < 6; ++i)
    if (std::abs(std::remainder(a[i] - b[i], 2 * kPi)) > distinct) return false;
  return true;
}

/// Where the other branches of most arms begin to converge from: wrist, elbow, base thrown over.
void add_hops(const Vector6d& q, std::deque<Vector6d>& starts) {
  const Vector6d wrist = (Vector6d() << q[0], q[1], q[2], q[3] + kPi, -q[4], q[5] + kPi).finished();
  const Vector6d elbow = (Vector6d() << q[0], q[1] + q[2], -q[2], q[3] + q[2], q[4], q[5]).finished();
  const Vector6d base = (Vector6d() << q[0] + kPi, -q[1], -q[2], -q[3], -q[4], q[5]).finished();
  for (const Vector6d& start : {wrist, elbow, base}) starts.push_back(start);
}

}  // namespace

struct NumericIk::Impl {
  std::array<Pose, 6> X_before;
  std::array<Eigen::Vector3d, 6> axes;
  Pose X_6F;
  std::optional<ParallelAxes> parallel;
  KDL::Chain chain;
  Eigen::Matrix<double, 6, 1> weights;
  Vector6d low, high;                                    // rad, between which restarts are drawn
  Eigen::Vector3d p_shoulder = Eigen::Vector3d::Zero();  // of joint 1 in R
  double reach = 0;                                      // m, of the flange from there, at most

  KDL::ChainIkSolverPos_LMA solver() const { return {chain, weights, kAim, kIterations, kSmallestStep}; }

  /// What is left to X_RF at q: metres, then radians, in R; and the Jacobian there.
  Vector6d residual(const Pose& X_RF, const Vector6d& q, Eigen::Matrix<double, 6, 6>& J) const {
    std::array<Eigen::Vector3d, 6> points, directions;
    Pose X = Pose::Identity();
    for (std::size_t i = 0; i < 6; ++i) {
      X = X * X_before[i];
      points[i] = X.translation();
      directions[i] = X.linear() * axes[i];
      X = X * Eigen::AngleAxisd(q[static_cast<int>(i)], axes[i]);
    }
    X = X * X_6F;
    for (std::size_t i = 0; i < 6; ++i)
      J.col(static_cast<int>(i)) << directions[i].cross(X.translation() - points[i]), directions[i];
    Vector6d left;
    left << X_RF.translation() - X.translation(), log_so3(X_RF.linear() * X.linear().transpose());
    return left;
  }

  /// Newton from a start that is all but there; empty when it is not.
  std::optional<Vector6d> polish(const Pose& X_RF, Vector6d q) const {
    Eigen::Matrix<double, 6, 6> J;
    double last = std::numeric_limits<double>::infinity();
    for (int step = 0; step <= kSteps; ++step) {
      const Vector6d left = residual(X_RF, q, J);
      const double size = left.norm();
      if (size < kExact || (size < kGood && size >= last)) return q;
      last = size;
      const Eigen::Matrix<double, 6, 6> square = J * J.transpose() + kDamping * Eigen::Matrix<double, 6, 6>::Identity();
      const Vector6d way = J.transpose() * square.ldlt().solve(left);
      if (!(way.norm() < kLongest)) return std::nullopt;
      q += way;
    }
    return last < kGood ? std::optional(q) : std::nullopt;
  }

  std::optional<Vector6d> solve(KDL::ChainIkSolverPos_LMA& lma, const Pose& X_RF, const Vector6d& q_start) const {
    KDL::JntArray start(6), end(6);
    start.data = q_start;
    lma.CartToJnt(start, to_kdl(X_RF), end);
    // What counts is the residual: on the last digits the solver complains about steps that are too small.
    if (!(lma.lastDifference < kNear) || !end.data.allFinite()) return std::nullopt;
    return polish(X_RF, end.data);
  }

  bool beyond_reach(const Pose& X_RF) const { return (X_RF.translation() - p_shoulder).norm() > reach; }
};

NumericIk::NumericIk(const SerialChain& chain) {
  auto impl = std::make_shared<Impl>();
  impl->X_before = chain.X_before;
  impl->axes = chain.axes;
  impl->X_6F = chain.X_6F;
  impl->parallel = ParallelAxes::find(chain);
  impl->weights << 1, 1, 1, kRadianWeight, kRadianWeight, kRadianWeight;
  impl->p_shoulder = chain.X_before[0].translation();
  impl->reach = chain.X_6F.translation().norm() + 1e-9;
  for (std::size_t i = 0; i < 6; ++i) {
    const Pose& X = chain.X_before[i];
    const Eigen::Vector3d axis = X.linear() * chain.axes[i];
    const KDL::Vector p(X.translation().x(), X.translation().y(), X.translation().z());
    const KDL::Joint joint("joint", p, KDL::Vector(axis.x(), axis.y(), axis.z()), KDL::Joint::RotAxis);
    impl->chain.addSegment(KDL::Segment(joint, to_kdl(i == 5 ? X * chain.X_6F : X)));
    impl->low[static_cast<int>(i)] = std::max(chain.limits[i].lower, -kPi);
    impl->high[static_cast<int>(i)] = std::min(chain.limits[i].upper, kPi);
    // Limits that lie wholly beyond half a turn: anywhere is as good.
    if (!(impl->low[static_cast<int>(i)] < impl->high[static_cast<int>(i)])) {
      impl->low[static_cast<int>(i)] = -kPi;
      impl->high[static_cast<int>(i)] = kPi;
    }
    if (i > 0) impl->reach += X.translation().norm();
  }
  impl_ = std::move(impl);
}

std::optional<Vector6d> NumericIk::near(const Pose& X_RF, const Vector6d& q_start) const {
  if (impl_->beyond_reach(X_RF)) return std::nullopt;
  if (const auto q = impl_->polish(X_RF, q_start)) return q;
  KDL::ChainIkSolverPos_LMA lma = impl_->solver();
  return impl_->solve(lma, X_RF, q_start);
}

std::optional<Vector6d> NumericIk::polished(const Pose& X_RF, const Vector6d& q_start) const {
  return impl_->polish(X_RF, q_start);
}

bool NumericIk::has_parallel_axes() const { return impl_->parallel.has_value(); }

NumericBranches NumericIk::branches(const Pose& X_RF, const Vector6d& q_near) const {
  if (!impl_->parallel) return search(X_RF, q_near);
  NumericBranches found;
  std::vector<Vector6d> starts = impl_->parallel->branches(X_RF, q_near);
  starts.insert(starts.begin(), q_near);
  for (const Vector6d& start : starts) {
    // Where it is singular q_near itself may be one of a continuum, and is not to be missed.
    std::optional<Vector6d> q = polished(X_RF, start);
    if (!q && &start != &starts.front()) q = near(X_RF, start);
    found.restarts += &start != &starts.front();
    if (!q) continue;
    found.converged += &start != &starts.front();
    if (std::none_of(found.q.begin(), found.q.end(), [&](const Vector6d& known) { return same(known, *q, kJoined); }))
      found.q.push_back(*q);
  }
  return found;
}

NumericBranches NumericIk::search(const Pose& X_RF, const Vector6d& q_near) const {
  NumericBranches found;
  if (impl_->beyond_reach(X_RF)) return found;
  KDL::ChainIkSolverPos_LMA lma = impl_->solver();
  const Rng rng = Seed{}.child("robot/numeric_ik").rng();
  std::deque<Vector6d> starts = {q_near};
  int quiet = 0, drawn = 0;
  while (found.q.size() < kMostSolutions && quiet < (found.q.empty() ? kHopeless : kQuiet)) {
    if (starts.empty()) {
      Rng draw = rng.at(static_cast<std::uint64_t>(drawn++));
      starts.emplace_back();
      for (int i = 0; i < 6; ++i) starts.back()[i] = draw.uniform(impl_->low[i], impl_->high[i]);
    }
    const std::optional<Vector6d> q = impl_->solve(lma, X_RF, starts.front());
    starts.pop_front();
    ++found.restarts;
    ++quiet;
    if (!q) continue;
    ++found.converged;
    if (std::any_of(found.q.begin(), found.q.end(), [&](const Vector6d& known) { return same(known, *q, kDistinct); }))
      continue;
    found.q.push_back(*q);
    add_hops(*q, starts);
    quiet = 0;
  }
  return found;
}

}  // namespace binpick

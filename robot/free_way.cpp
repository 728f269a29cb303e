#include "robot/free_way.hpp"

#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateSampler.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/datastructures/NearestNeighborsLinear.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>

#include <algorithm>
#include <cmath>

#include "core/random.hpp"

namespace binpick {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

constexpr double kRange = 0.15;  // m, longest branch of a tree
constexpr double kAround = 2.2;  // rad, how far beyond its two ends a joint may go on its way
constexpr double kPiece = 0.2;   // m, a way is cut short between points this far apart
constexpr int kCutRounds = 2;

/// The search's coordinates are metres: each joint times how far the arm and tool reach beyond it (collision_check).
const Vector6d kLever = (Vector6d() << 1.0, 1.0, 0.8, 0.4, 0.4, 0.25).finished();

const double* values(const ob::State* state) { return state->as<ob::RealVectorStateSpace::StateType>()->values; }
double* values(ob::State* state) { return state->as<ob::RealVectorStateSpace::StateType>()->values; }

Vector6d joints_of(const ob::State* state) { return Eigen::Map<const Vector6d>(values(state)).cwiseQuotient(kLever); }
void set_joints(ob::State* state, const Vector6d& q) { Eigen::Map<Vector6d>{values(state)} = q.cwiseProduct(kLever); }

/// Counts what is checked; nothing is free any more when the count is used up.
class Checker {
 public:
  Checker(const FreeWayQuery& query, int& left) : query_(query), left_(left) {}
  bool used_up() const { return left_ <= 0; }
  bool free(const Vector6d& q) {
    if (used_up()) return false;
    --left_;
    return query_.free(q);
  }
  /// Every step between two positions, without the first.
  bool free_between(const Vector6d& q_1, const Vector6d& q_2) {
    const Vector6d way = q_2 - q_1;
    const int steps = std::max(1, static_cast<int>(std::ceil(way.cwiseProduct(kLever).norm() / query_.step)));
    for (int k = 1; k <= steps; ++k)
      if (!free(q_1 + way * (static_cast<double>(k) / steps))) return false;
    return true;
  }

 private:
  const FreeWayQuery& query_;
  int& left_;
};

/// Uniform draws of one named stream, so that OMPL's own process-wide seed decides nothing.
class Sampler : public ob::StateSampler {
 public:
  Sampler(const ob::StateSpace* space, const FreeWayQuery& query, const ob::RealVectorBounds& bounds)
      : ob::StateSampler(space), query_(query), bounds_(bounds), draws_(Seed{}.child("robot/free_way").rng()) {}

  void sampleUniform(ob::State* state) override {
    for (std::size_t i = 0; i < 6; ++i) values(state)[i] = draws_.uniform(bounds_.low[i], bounds_.high[i]);
    if (!query_.draw_near) return;
    const std::optional<Vector6d> near = query_.draw_near(joints_of(state));
    if (!near) return;
    set_joints(state, *near);
    space_->enforceBounds(state);
  }
  void sampleUniformNear(ob::State* state, const ob::State*, double) override { sampleUniform(state); }
  void sampleGaussian(ob::State* state, const ob::State*, double) override { sampleUniform(state); }

 private:
  const FreeWayQuery& query_;
  ob::RealVectorBounds bounds_;
  Rng draws_;
};

ob::RealVectorBounds bounds_of(const Arm& arm, const FreeWayQuery& query) {
  ob::RealVectorBounds bounds(6);
  for (int i = 0; i < 6; ++i) {
    const JointLimits& limit = arm.limits()[static_cast<std::size_t>(i)];
    const auto k = static_cast<unsigned>(i);
    const double low = std::min(query.q_from[i], query.q_to[i]), high = std::max(query.q_from[i], query.q_to[i]);
    bounds.low[k] = kLever[i] * std::min(low, std::max(limit.lower, low - kAround));
    bounds.high[k] = kLever[i] * std::max(high, std::min(limit.upper, high + kAround));
  }
  return bounds;
}

/// As few of the points as still make a free way.
std::vector<Vector6d> cut_short(std::vector<Vector6d> way, Checker& checker) {
  for (int round = 0; round < kCutRounds; ++round) {
    std::vector<Vector6d> fine = {way.front()};
    for (std::size_t i = 1; i < way.size(); ++i) {
      const Vector6d step = way[i] - way[i - 1];
      const int pieces = std::max(1, static_cast<int>(std::ceil(step.cwiseProduct(kLever).norm() / kPiece)));
      for (int k = 1; k < pieces; ++k) fine.push_back(way[i - 1] + step * (static_cast<double>(k) / pieces));
      fine.push_back(way[i]);
    }
    std::vector<Vector6d> cut = {fine.front()};
    for (std::size_t i = 0; i + 1 < fine.size();) {
      std::size_t next = fine.size() - 1;
      while (next > i + 1 && !checker.free_between(fine[i], fine[next])) --next;
      cut.push_back(fine[next]);
      i = next;
    }
    way = std::move(cut);
  }
  return way;
}

}  // namespace

std::optional<std::vector<Vector6d>> find_free_way(const Arm& arm, const FreeWayQuery& query, int& checks_left) {
  static const bool quiet = (ompl::msg::noOutputHandler(), true);  // OMPL would write to the terminal
  Checker checker(query, checks_left);
  if (!quiet || !checker.free(query.q_from) || !checker.free(query.q_to)) return std::nullopt;
  const auto space = std::make_shared<ob::RealVectorStateSpace>(6);
  const ob::RealVectorBounds bounds = bounds_of(arm, query);
  space->setBounds(bounds);
  space->setStateSamplerAllocator([&](const ob::StateSpace* s) { return std::make_shared<Sampler>(s, query, bounds); });
  const auto info = std::make_shared<ob::SpaceInformation>(space);
  info->setStateValidityChecker([&](const ob::State* state) { return checker.free(joints_of(state)); });
  space->setLongestValidSegmentFraction(query.step / space->getMaximumExtent());
  info->setup();
  const auto problem = std::make_shared<ob::ProblemDefinition>(info);
  ob::ScopedState<> from(space), to(space);
  set_joints(from.get(), query.q_from);
  set_joints(to.get(), query.q_to);
  problem->setStartAndGoalStates(from, to);
  og::RRTConnect planner(info);
  planner.setProblemDefinition(problem);
  planner.setNearestNeighbors<ompl::NearestNeighborsLinear>();  // the default one draws from OMPL's own seed
  planner.setRange(kRange);
  planner.setup();
  const ob::PlannerTerminationCondition until([&] { return checker.used_up(); });
  if (planner.solve(until) != ob::PlannerStatus::EXACT_SOLUTION) return std::nullopt;
  std::vector<Vector6d> way;
  for (const ob::State* state : problem->getSolutionPath()->as<og::PathGeometric>()->getStates())
    way.push_back(joints_of(state));
  way.front() = query.q_from;
  way.back() = query.q_to;
  return cut_short(std::move(way), checker);
}

}  // namespace binpick

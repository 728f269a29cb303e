#include "robot/reach_map.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "robot/collision_check.hpp"
#include "robot/inverse_kinematics.hpp"

namespace binpick {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// What became of one wished pose of the tool.
struct Verdict {
  bool within = false;
  Obstacle hit = Obstacle::kNone;  ///< the first one met; kNone when some posture is free
};

class Prober {
 public:
  Prober(const Cell& cell, const ReachMapConfig& config)
      : cell_(cell), config_(config), check_(cell, 0), X_GF_(cell.gripper->X_FG().inverse()), q_last_(cell.q_look) {}

  Verdict probe(const Eigen::Vector3d& p_W, const Eigen::Vector3d& axis_W) {
    Verdict verdict;
    const Eigen::Matrix3d R_WG = rotation_with_z(axis_W);
    for (int k = 0; k < config_.spins; ++k) {
      const Eigen::AngleAxisd turn(kTurn * k / config_.spins, Eigen::Vector3d::UnitZ());
      const Pose X_WF = pose_from(R_WG * turn.toRotationMatrix(), p_W) * X_GF_;
      const Obstacle tool = check_.tool_hit(X_WF);
      if (tool != Obstacle::kNone) note(verdict, tool);
      // A tool that stands in a wall still says whether the arm would reach; once that is known it says nothing more.
      if (tool != Obstacle::kNone && verdict.within) continue;
      if (try_pose(cell_.X_WR.inverse() * X_WF, tool == Obstacle::kNone, verdict)) return {true, Obstacle::kNone};
    }
    return verdict;
  }

 private:
  static void note(Verdict& verdict, Obstacle hit) {
    if (verdict.hit == Obstacle::kNone) verdict.hit = hit;
  }

  /// True when a posture is found that meets nothing.
  bool try_pose(const Pose& X_RF, bool tool_is_free, Verdict& verdict) {
    // First the posture of the neighbouring pose: for arms without a closed form the search for all is slow.
    if (const auto q = following_solution(*cell_.arm, X_RF, q_last_); q && meets(*q, tool_is_free, verdict))
      return true;
    if (!tool_is_free && verdict.within) return false;
    for (const Vector6d& q : inverse_kinematics(*cell_.arm, X_RF, q_last_))
      if (meets(q, tool_is_free, verdict)) return true;
    return false;
  }

  bool meets(const Vector6d& q, bool tool_is_free, Verdict& verdict) {
    verdict.within = true;
    if (!tool_is_free) return false;
    const Obstacle hit = check_.hit(q);
    note(verdict, hit);
    if (hit == Obstacle::kNone) q_last_ = q;
    return hit == Obstacle::kNone;
  }

  const Cell& cell_;
  const ReachMapConfig& config_;
  CollisionCheck check_;
  Pose X_GF_;
  Vector6d q_last_;
};

/// Straight down, then tilted to every side; in W.
std::vector<Eigen::Vector3d> directions(const ReachMapConfig& config) {
  std::vector<Eigen::Vector3d> axes = {-Eigen::Vector3d::UnitZ()};
  for (int k = 0; k < config.sides; ++k) {
    const double side = kTurn * k / config.sides;
    axes.emplace_back(std::sin(config.tilt) * std::cos(side), std::sin(config.tilt) * std::sin(side),
                      -std::cos(config.tilt));
  }
  return axes;
}

/// Places along one inner edge, evenly, the outermost `margin` off the walls.
std::vector<double> along(double edge, const ReachMapConfig& config) {
  const double length = std::max(0.0, edge - 2 * config.margin);
  const int count = static_cast<int>(std::ceil(length / config.place)) + 1;
  std::vector<double> at;
  for (int i = 0; i < count; ++i) at.push_back(count == 1 ? 0 : -length / 2 + length * i / (count - 1));
  return at;
}

void count(ReachMap& map, const Verdict& verdict, bool upright) {
  const bool is_free = verdict.within && verdict.hit == Obstacle::kNone;
  ++map.poses;
  map.within += verdict.within;
  map.free += is_free;
  map.upright += upright;
  map.upright_free += upright && is_free;
  if (!is_free) ++map.lost[verdict.within ? "in collision with " + to_string(verdict.hit) : "out of reach"];
}

}  // namespace

double ReachMap::share(std::size_t place) const {
  double sum = 0;
  for (const ReachLevel& level : levels) sum += level.free[place];
  return levels.empty() ? 0 : sum / static_cast<double>(levels.size());
}

ReachMap reach_map(const Cell& cell, const ReachMapConfig& config) {
  ReachMap map;
  const std::vector<double> xs = along(cell.bin.inner_size.x(), config), ys = along(cell.bin.inner_size.y(), config);
  map.columns = static_cast<int>(xs.size());
  map.rows = static_cast<int>(ys.size());
  for (const double y : ys)
    for (const double x : xs) map.places.emplace_back(x, y);
  const std::vector<Eigen::Vector3d> axes_W = directions(config);
  Prober prober(cell, config);
  for (int l = 0; l < config.levels; ++l) {
    ReachLevel level;
    level.height = config.low + (cell.bin.inner_size.z() - config.low) * l / std::max(1, config.levels - 1);
    for (const Eigen::Vector2d& place : map.places) {
      int within = 0, is_free = 0;
      for (std::size_t a = 0; a < axes_W.size(); ++a) {
        const Verdict verdict =
            prober.probe(cell.X_WB * Eigen::Vector3d(place.x(), place.y(), level.height), axes_W[a]);
        within += verdict.within;
        is_free += verdict.within && verdict.hit == Obstacle::kNone;
        count(map, verdict, a == 0);
      }
      level.within.push_back(static_cast<double>(within) / static_cast<double>(axes_W.size()));
      level.free.push_back(static_cast<double>(is_free) / static_cast<double>(axes_W.size()));
    }
    map.levels.push_back(std::move(level));
  }
  return map;
}

}  // namespace binpick

#include "robot/look_pose.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/error.hpp"
#include "core/yaml.hpp"
#include "robot/collision_check.hpp"
#include "robot/inverse_kinematics.hpp"
#include "robot/primitive_distance.hpp"

namespace binpick {
namespace {

constexpr int kTurns = 12;         // of the camera about its axis, and of the side about the vertical
constexpr double kFarther = 0.05;  // m
constexpr int kFartherSteps = 4;
constexpr std::size_t kPostures = 2;    // of the arm a pose
constexpr double kStep = 0.01;          // m, along the way to the look
constexpr double kSight = 0.01;         // m, steps along the line of sight
constexpr double kRobotMargin = 0.025;  // m, as in plan_pick

struct Way {
  int apart = 0;  ///< steps between the side and the one that the normal leans to
  double time = 0;
  Vector6d q;
};

double turn(int k) { return 2 * std::numbers::pi * k / kTurns; }

/// Camera at `distance` from the aim, its axis on it, turned by `roll` about it.
Pose looking_from(const Eigen::Vector3d& aim_W, const Eigen::Vector3d& towards_W, double distance, double roll) {
  const Eigen::Matrix3d R = rotation_with_z(-towards_W) * Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ());
  return pose_from(R, aim_W + distance * towards_W);
}

/// Does a wall of the bin stand between the camera and the aim?
bool hidden(const Cell& cell, const Eigen::Vector3d& aim_W, const Eigen::Vector3d& towards_W, double distance) {
  for (const Primitive& wall : cell.bin_W()) {
    const Pose X_SW = wall.X_OS.inverse();
    for (double s = 2 * kSight; s < distance; s += kSight)
      if (signed_distance_S(wall, X_SW * (aim_W + s * towards_W)) < 0) return true;
  }
  return false;
}

/// Unit vectors from the aim to the camera, with the number of steps to the side that the normal leans to.
std::vector<std::pair<int, Eigen::Vector3d>> directions(const Cell& cell, const LookRequest& request, double distance) {
  if (request.from == "above") return {{0, Eigen::Vector3d::UnitZ()}};
  std::vector<std::pair<int, Eigen::Vector3d>> found;
  const Eigen::Vector2d lean = request.normal_W.head<2>();
  for (int k = 0; k < kTurns; ++k) {
    const Eigen::Vector2d side(std::cos(turn(k)), std::sin(turn(k)));
    const Eigen::Vector3d towards_W(std::sin(request.tilt) * side.x(), std::sin(request.tilt) * side.y(),
                                    std::cos(request.tilt));
    if (hidden(cell, request.aim_W, towards_W, distance)) continue;
    const double angle = lean.norm() < 0.1 ? 0 : std::acos(std::clamp(lean.normalized().dot(side), -1.0, 1.0));
    found.emplace_back(static_cast<int>(std::lround(angle / turn(1))), towards_W);
  }
  return found;
}

std::vector<Way> ways(const Cell& cell, const LookRequest& request, double distance) {
  std::vector<Way> found;
  const Pose X_CF = cell.camera.pose.inverse(), X_RW = cell.X_WR.inverse();
  for (const auto& [apart, towards_W] : directions(cell, request, distance)) {
    for (int k = 0; k < kTurns; ++k) {
      const Pose X_RF = X_RW * looking_from(request.aim_W, towards_W, distance, turn(k)) * X_CF;
      std::vector<Vector6d> postures = nearest_postures(*cell.arm, X_RF, cell.q_look);
      if (postures.size() > kPostures) postures.resize(kPostures);
      for (const Vector6d& q : postures)
        found.push_back({apart, joint_time(*cell.arm, cell.q_look, q, cell.motion), q});
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Way& a, const Way& b) { return a.apart != b.apart ? a.apart < b.apart : a.time < b.time; });
  return found;
}

const std::vector<std::string> kOccasions = {"no_plan", "poor_fit", "failed"};

}  // namespace

void SecondLookConfig::visit(ConfigVisitor& v) {
  v.command("when", when,
            "occasions: no_plan, poor_fit (of the part to be picked), failed (a pick of it has); default poor_fit and "
            "failed with "
            "ppf and a camera on the flange, else none");
  for (const std::string& occasion : when)
    if (std::find(kOccasions.begin(), kOccasions.end(), occasion) == kOccasions.end())
      v.fail("when", "'" + occasion + "' is none of no_plan, poor_fit, failed; did you mean '" +
                         nearest_name(occasion, kOccasions) + "'?");
  v.choice("from", from, {"above", "side"}, "straight above the part, or tilted, from the side that it faces");
  v.field("distance", distance, Unit::kLength, "from the part's middle to the camera; more where that is not free");
  v.field("tilt", tilt, Unit::kAngle, "of the camera off the vertical, from a side");
  v.field("fuse", fuse, "the estimator gets both looks as one cloud; false: the second frame alone");
  v.field("score", score, Unit::kNone, "a fit with a lower score is poor");
  v.field("deviation", deviation, Unit::kLength,
          "a fit is poor when a lip's place on the part is known no better, one standard deviation");
}

void SecondLookConfig::validate() const {
  const auto need = [](bool good, const char* message) {
    if (!good) throw SpecError(std::string("second_look.") + message);
  };
  need(distance >= 0.1 && distance <= 2, "distance: must lie between 100 mm and 2 m");
  need(tilt > 0 && tilt <= 1.05, "tilt: must lie between 0 and 60 degrees");
  need(score >= 0 && score <= 1, "score: must lie between 0 and 1");
  need(deviation > 0, "deviation: must be above 0");
}

std::optional<LookPlan> plan_look(const Cell& cell, const LookRequest& request, const ObstacleMap& heap) {
  CollisionCheck check(cell, request.clearance);
  check.set_heap(&heap);
  for (int step = 0; step <= kFartherSteps; ++step) {
    const double distance = request.distance + step * kFarther;
    for (const Way& way : ways(cell, request, distance)) {
      if (check.hit(way.q, true) != Obstacle::kNone) continue;
      const JointTrajectory there = joint_move(*cell.arm, cell.q_look, way.q, cell.motion);
      if (check.path_hit(there, kStep, true) == Obstacle::kNone) return LookPlan{way.q, there, distance};
    }
  }
  return std::nullopt;
}

ObstacleMap heap_without_robot(const Cell& cell, const SceneView& view, const Pose& X_WC, const Vector6d& q) {
  const CollisionCheck robot(cell, 0);
  return ObstacleMap(robot.without_robot(perceived_heap(view, X_WC).points_W(), q, kRobotMargin));
}

double lip_deviation(const PoseEstimate& estimate, const Pose& X_WC, const PickPlan& plan, const Part& part,
                     const Gripper& gripper) {
  const Pose X_PG = (X_WC * estimate.X_CP).inverse() * plan.X_WG;
  double worst = 0;
  for (std::size_t c = 0; c < gripper.cups().size(); ++c) {
    if (plan.site.cup >= 0 && static_cast<std::size_t>(plan.site.cup) != c) continue;
    const Eigen::Vector3d lip_P = X_PG * gripper.cups()[c].X_GU.translation();
    Eigen::Matrix<double, 3, 6> J;  // how the part's surface at the lip moves with a twist in P
    J.leftCols<3>().setIdentity();
    for (int axis = 0; axis < 3; ++axis) J.col(3 + axis) = Eigen::Vector3d::Unit(axis).cross(lip_P);
    Eigen::Matrix3d free = Eigen::Matrix3d::Identity();
    if (part.symmetry.axis) {
      const Eigen::Vector3d orbit = part.symmetry.axis->direction_P.cross(lip_P - part.symmetry.axis->point_P);
      if (orbit.norm() > 1e-6) free -= orbit.normalized() * orbit.normalized().transpose();
    }
    const Eigen::Matrix3d spread = free * J * estimate.covariance * J.transpose() * free;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread, Eigen::EigenvaluesOnly);
    worst = std::max(worst, solver.eigenvalues().maxCoeff());
  }
  return std::sqrt(worst);
}

}  // namespace binpick

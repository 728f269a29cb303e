#include "trials/calibration/calibration_setup.hpp"

#include <cmath>
#include <numbers>
#include <optional>

#include "core/error.hpp"
#include "robot/collision_check.hpp"
#include "robot/inverse_kinematics.hpp"

namespace binpick {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kAside = 0.25;       // m: beside the bin's middle, away from the robot
constexpr double kPlateAhead = 0.05;  // m, of the plate in front of the flange
constexpr int kSpins = 12;
constexpr double kTilts[] = {30 * kDegree, 20 * kDegree};   // frontal views know a plate's tilt worst
constexpr double kShownFrom[] = {0.6, 0.5, 0.7, 0.4, 0.8};  // m, from the fixed camera

Pose looking_down(const Eigen::Vector3d& p_W) {
  return pose_from(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()).toRotationMatrix(), p_W);
}

/// The camera looks at `target` from a distance, tilted by `tilt` towards `azimuth`, turned by `spin` about its axis.
Pose looking_at(const Eigen::Vector3d& target_W, double distance, double tilt, double azimuth, double spin) {
  const Eigen::Vector3d up(std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt));
  const Eigen::Vector3d x = up.cross(Eigen::Vector3d::UnitY()).normalized();
  Eigen::Matrix3d R;
  R.col(2) = -up;
  R.col(0) = -x.cross(up).cross(up).normalized();
  R.col(1) = R.col(2).cross(R.col(0));
  return pose_from(R * Eigen::AngleAxisd(spin, Eigen::Vector3d::UnitZ()).toRotationMatrix(), target_W + distance * up);
}

bool whole(const CalibrationSetup& setup, const Pose& X_CQ, const PinholeCamera& camera) {
  if (!(X_CQ.translation().z() > 0.1)) return false;
  if (X_CQ.linear().col(2).z() > -0.5) return false;  // from behind, or hardly anything of its face
  return projected_corners(setup.plate, X_CQ, camera).size() == setup.plate.corners_Q().size();
}

std::optional<Vector6d> posture(const CalibrationSetup& setup, const CollisionCheck& check, const Pose& X_WF) {
  const Cell& cell = *setup.cell;
  for (const Vector6d& q : inverse_kinematics(*cell.arm, cell.X_WR.inverse() * X_WF, cell.q_look))
    if (check.hit(q) == Obstacle::kNone) return q;
  return std::nullopt;
}

/// The plate on the flange before the fixed camera, tilted so that its slant is seen well.
Vector6d shown(const CalibrationSetup& setup, const CollisionCheck& check) {
  for (const double distance : kShownFrom)
    for (const double tilt : kTilts)
      for (int around = 0; around < 4; ++around)
        for (int spin = 0; spin < kSpins; ++spin) {
          const Eigen::Matrix3d tilted =
              (Eigen::AngleAxisd(around * std::numbers::pi / 2, Eigen::Vector3d::UnitZ()) *
               Eigen::AngleAxisd(std::numbers::pi - tilt, Eigen::Vector3d::UnitX()) *
               Eigen::AngleAxisd(spin * 2 * std::numbers::pi / kSpins, Eigen::Vector3d::UnitZ()))
                  .toRotationMatrix();
          const Pose X_DQ = pose_from(tilted, {0, 0, distance});
          if (!whole(setup, X_DQ, setup.camera_D)) continue;
          if (const auto q = posture(setup, check, setup.X_WD * X_DQ * setup.X_FQ.inverse())) return *q;
        }
  throw SpecError("calibration: the arm cannot show a plate to the fixed camera above the bin");
}

/// The tip straight down on a part in the middle of the bin, whichever way round.
Vector6d picking(const CalibrationSetup& setup, const CollisionCheck& check) {
  const Cell& cell = *setup.cell;
  constexpr double kPartHeight = 0.03;  // m
  const Eigen::Vector3d p_W = cell.X_WB * Eigen::Vector3d(0, 0, kPartHeight);
  for (int spin = 0; spin < kSpins; ++spin) {
    const Pose X_WG =
        looking_down(p_W) * Eigen::AngleAxisd(spin * 2 * std::numbers::pi / kSpins, Eigen::Vector3d::UnitZ());
    if (const auto q = posture(setup, check, X_WG * cell.gripper->X_FG().inverse())) return *q;
  }
  throw SpecError("calibration: the tool cannot reach the middle of the bin");
}

/// Looks at the plate from several sides, evenly around and at two tilts; places that are not free are passed over.
std::vector<Vector6d> looks(const CalibrationSetup& setup, const CollisionCheck& check, int count, double nearest) {
  std::vector<Vector6d> found;
  const Eigen::Vector3d target = setup.X_WQ.translation();
  constexpr double kGolden = 2.399963229728653;  // rad: evenly around for any count
  for (int k = 0; k < 20 * count && static_cast<int>(found.size()) < count; ++k) {
    const double tilt = (k % 3 == 0 ? 10 : k % 3 == 1 ? 20 : 30) * kDegree;
    const double distance = nearest + 0.05 * (k % 4), spin = k * 0.7;
    const Pose X_WC = looking_at(target, distance, tilt, k * kGolden, spin);
    if (!whole(setup, X_WC.inverse() * setup.X_WQ, setup.camera_C)) continue;
    if (const auto q = posture(setup, check, X_WC * setup.cell->camera.pose.inverse())) found.push_back(*q);
  }
  if (static_cast<int>(found.size()) < count)
    throw SpecError("calibration: only " + std::to_string(found.size()) + " of " + std::to_string(count) +
                    " looks at the plate can be reached");
  return found;
}

}  // namespace

CalibrationSetup calibration_setup(const Cell& cell, const CalibrationPlaces& places) {
  if (cell.camera.mount != "flange") throw SpecError("calibration: the camera is not on the flange (camera.mount)");
  CalibrationSetup setup;
  setup.cell = &cell;
  setup.X_FQ = Pose(Eigen::Translation3d(0, 0, kPlateAhead));
  const Pose X_WC = cell.camera_pose(cell.q_look);
  // The standing plate lies under the look's camera, its back on the bin's floor, slanted as a stand would hold it.
  const Eigen::Vector3d on_floor = cell.X_WB * Eigen::Vector3d(0, 0, 0.03);
  setup.X_WQ = pose_from(Eigen::AngleAxisd(kTilts[0], Eigen::Vector3d::UnitX()).toRotationMatrix(), on_floor);
  const Eigen::Vector3d outwards = Eigen::Vector3d((cell.X_WB.translation() - cell.X_WR.translation()).x(),
                                                   (cell.X_WB.translation() - cell.X_WR.translation()).y(), 0)
                                       .normalized();
  setup.X_WD = looking_down(cell.X_WB.translation() + kAside * outwards + Eigen::Vector3d(0, 0, places.above));
  if (!whole(setup, X_WC.inverse() * setup.X_WQ, setup.camera_C) ||
      !whole(setup, setup.X_WD.inverse() * setup.X_WQ, setup.camera_D))
    throw SpecError("calibration: a plate on the bin's floor is not seen whole from the look pose and from above");
  const CollisionCheck check(cell, 0);
  setup.q_look = cell.q_look;
  setup.q_shown = shown(setup, check);
  setup.q_pick = picking(setup, check);
  setup.q_hand_eye = looks(setup, check, places.poses, places.nearest);
  return setup;
}

}  // namespace binpick

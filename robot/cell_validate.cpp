// What makes a cell impossible, said before anything runs.
#include <cstdio>
#include <numbers>

#include "core/check.hpp"
#include "core/error.hpp"
#include "robot/cell.hpp"
#include "robot/collision_check.hpp"
#include "robot/primitive_distance.hpp"
#include "robot/reach.hpp"

namespace binpick {
namespace {

constexpr double kInset = 0.05;  // m, corners of bin and tray that must be reached lie this far inside their walls

std::string place(const Eigen::Vector3d& p_W) {
  char text[80];
  std::snprintf(text, sizeof text, "(%.3f, %.3f, %.3f) m", p_W.x(), p_W.y(), p_W.z());
  return text;
}

void check_joints(const Cell& cell, const Vector6d& q, const std::string& key) {
  for (int i = 0; i < 6; ++i) {
    const JointLimits& limits = cell.arm->limits()[static_cast<std::size_t>(i)];
    // The limits themselves are allowed, whatever the last digit of a degree became in radians.
    if (q[i] >= limits.lower - 1e-9 && q[i] <= limits.upper + 1e-9) continue;
    char text[160];
    const double degrees = 180 / std::numbers::pi;
    std::snprintf(text, sizeof text, ": joint %d at %.1f degrees lies outside %.1f .. %.1f", i + 1, q[i] * degrees,
                  limits.lower * degrees, limits.upper * degrees);
    throw SpecError("cell." + key + text);
  }
  const Obstacle hit = CollisionCheck(cell, 0).hit(q);
  if (hit != Obstacle::kNone) throw SpecError("cell." + key + ": the arm would be in collision with " + to_string(hit));
}

/// The floor's centre and its corners `kInset` inside, `height` above the floor.
std::vector<Eigen::Vector3d> floor_places(const Eigen::Vector3d& inner_size, double height) {
  std::vector<Eigen::Vector3d> places = {{0, 0, height}};
  const double x = std::max(0.0, inner_size.x() / 2 - kInset), y = std::max(0.0, inner_size.y() / 2 - kInset);
  for (const double sx : {-1.0, 1.0})
    for (const double sy : {-1.0, 1.0}) places.emplace_back(sx * x, sy * y, height);
  return places;
}

void check_reach(const Cell& cell, const Pose& X_WA, const Eigen::Vector3d& inner_size, const std::string& what) {
  for (const Eigen::Vector3d& p_A : floor_places(inner_size, 0.01)) {
    const Eigen::Vector3d p_W = X_WA * p_A;
    if (!reaches(cell, p_W, -Eigen::Vector3d::UnitZ()))
      throw SpecError("cell." + what + ": unreachable: the tool, pointing straight down, cannot reach " + place(p_W) +
                      " just above its floor");
  }
}

std::string camera_key(const Cell& cell, std::size_t k) {
  if (k == 0) return "cell.camera";
  const std::string& name = cell.cameras[k - 1].name;
  return "cell.cameras[" + std::to_string(k - 1) + "]" + (name.empty() ? "" : " (" + name + ")");
}

/// What a camera may not stand in, at the look pose.
std::vector<std::pair<Primitive, std::string>> solids_W(const Cell& cell) {
  std::vector<std::pair<Primitive, std::string>> solids;
  const auto add = [&](const std::vector<Primitive>& shapes, const Pose& X_WO, const char* what) {
    for (Primitive shape : shapes) {
      shape.X_OS = X_WO * shape.X_OS;
      solids.emplace_back(shape, what);
    }
  };
  add(cell.bin_W(), Pose::Identity(), "a wall or the floor of the bin");
  add(cell.table_W(), Pose::Identity(), "the table");
  add(cell.tray_W(), Pose::Identity(), "a wall or the floor of the tray");
  const std::vector<Pose> links = cell.arm->link_poses(cell.q_look);
  for (std::size_t l = 0; l < links.size(); ++l) add(cell.arm->link_shapes()[l], cell.X_WR * links[l], "the arm");
  add(cell.gripper->body_G(), cell.tip_pose(cell.q_look), "the tool");
  return solids;
}

/// Its intrinsics are sound, its lens does not fold, and its origin stands in the open while the arm is at the look.
void check_cameras(const Cell& cell) {
  constexpr double kDeep = 1e-4;  // m: on a surface is not inside
  const auto solids = solids_W(cell);
  for (std::size_t k = 0; k < cell.camera_count(); ++k) {
    const CameraMount& camera = cell.camera_at(k);
    const std::string key = camera_key(cell, k);
    if (!is_rigid(camera.pose, 1e-6)) throw SpecError(key + ".pose: is not a finite pose");
    try {
      if (camera.has_intrinsics) camera.intrinsics.validate();
      camera.lens.validate(camera.intrinsics);
    } catch (const SpecError& error) {
      throw SpecError(key + ": " + error.what());
    }
    const Eigen::Vector3d p_W = cell.camera_pose(cell.q_look, k).translation();
    for (const auto& [solid, what] : solids)
      if (signed_distance_S(solid, solid.X_OS.inverse() * p_W) < -kDeep)
        throw SpecError(key + ".pose: the camera at " + place(p_W) + " stands inside " + what);
  }
}

}  // namespace

void Cell::validate() const {
  BP_CHECK(arm && gripper, "finish() comes first");
  bin.validate();
  if (!(tray.inner_size.minCoeff() > 0.01) || !(tray.inner_size.maxCoeff() < 5))
    throw SpecError("cell.tray.inner_size: each edge must lie between 10 mm and 5 m");
  if (!(tray.wall >= 0.001 && tray.wall <= 0.1)) throw SpecError("cell.tray.wall: must lie between 1 and 100 mm");
  for (const Pose* pose : {&X_WB, &X_WR, &tray.X_WT})
    if (!is_rigid(*pose, 1e-6)) throw SpecError("cell: a pose is not a finite pose");
  if (X_WB.linear()(2, 2) < 0.5) throw SpecError("cell.bin_pose: the bin's opening must face upwards");
  if (tray.X_WT.linear()(2, 2) < 0.99) throw SpecError("cell.tray.pose: the tray must stand upright");
  motion.validate();
  gripper->validate();
  check_joints(*this, q_home, "home");
  check_cameras(*this);
  check_joints(*this, q_look, "look");
  check_reach(*this, X_WB, bin.inner_size, "bin");
  check_reach(*this, tray.X_WT, tray.inner_size, "tray");
}

}  // namespace binpick

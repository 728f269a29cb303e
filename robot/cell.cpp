#include "robot/cell.hpp"

#include <cmath>

#include "core/bin_mesh.hpp"
#include "core/check.hpp"
#include "core/error.hpp"
#include "core/yaml.hpp"
#include "robot/collision_check.hpp"
#include "robot/inverse_kinematics.hpp"

namespace binpick {
namespace {

Vector6d six_joints(const std::vector<double>& values, const char* key) {
  if (values.size() != 6) throw SpecError(std::string("cell.") + key + ": must list six joint angles");
  return Eigen::Map<const Vector6d>(values.data());
}

void visit_arm(ConfigVisitor& v, Cell& cell) {
  v.path("arm", cell.arm_path, "URDF of the arm");
  if (v.reading() || !cell.arm_packages.empty()) {
    v.command("arm_packages", cell.arm_packages, "folders that hold package folders, for package:// names in the URDF");
    for (const std::string& folder : cell.arm_packages)
      if (!is_path_item(folder)) v.fail("arm_packages", "'" + folder + "': folders begin with ./, ../ or /");
  }
  if (v.reading() || !cell.arm_tip.empty())
    v.field("arm_tip", cell.arm_tip, "link that is the flange; else tool0, flange or the only end link");
  v.field("arm_pose", cell.X_WR, "base of the arm in the world");
}

/// Housing and bracket of a camera on the flange, in F.
void add_camera_body(const CameraMount& camera, std::vector<Primitive>& bodies) {
  if (camera.mount != "flange" || !(camera.housing.minCoeff() > 0)) return;
  constexpr double kBracketThickness = 0.006, kBracketWidth = 0.03;  // m
  bodies.push_back(Primitive::box(camera.housing, camera.pose * Eigen::Translation3d(0, 0, -camera.housing.z() / 2)));
  const Eigen::Vector3d p_FC = camera.pose.translation();
  const double offset = p_FC.head<2>().norm();
  if (offset < 1e-3) return;
  const Pose X_bracket = Pose(Eigen::Translation3d(p_FC.x() / 2, p_FC.y() / 2, kBracketThickness / 2)) *
                         Eigen::AngleAxisd(std::atan2(p_FC.y(), p_FC.x()), Eigen::Vector3d::UnitZ());
  bodies.push_back(Primitive::box({offset, kBracketWidth, kBracketThickness}, X_bracket));
}

}  // namespace

void TraySpec::visit(ConfigVisitor& v) {
  v.field("pose", X_WT, "centre of the tray's inner floor in the world");
  v.field("inner_size", inner_size, Unit::kLength, "inner length, width and height of the walls");
  v.field("wall", wall, Unit::kLength, "thickness of walls and floor");
}

void CameraMount::visit(ConfigVisitor& v) {
  v.choice("mount", mount, {"flange", "fixed"}, "carried by the flange, or fixed in the world");
  v.field("pose", pose, "camera in the flange frame, or in the world when fixed");
  v.field("housing", housing, Unit::kLength,
          "size of the housing along x, y, z of the camera, behind its front; for collisions");
  if (v.reading() && v.has("intrinsics")) has_intrinsics = true;
  if (v.reading() || has_intrinsics) v.section("intrinsics", intrinsics, "instead of the sensor preset's");
  if (v.reading() || !lens.none()) v.section("lens", lens, "distortion of grey images; depth frames are rectified");
}

void FurtherCamera::visit(ConfigVisitor& v) {
  v.field("name", name, "shown in messages and folders");
  CameraMount::visit(v);
}

void LookSpec::visit(ConfigVisitor& v) {
  int given = 0;
  for (const char* key : {"joints", "camera", "tip"}) {
    if (!v.reading() ? by != key : !v.has(key) && given > 0) continue;
    if (v.reading() && v.has(key)) {
      by = key;
      if (++given > 1) v.fail(key, "only one of joints, camera and tip may be given");
    }
    if (std::string(key) == "joints") v.field(key, joints, Unit::kAngle, "joint angles of the look");
    if (std::string(key) == "camera") v.field(key, pose, "wished pose of the flange camera in the world");
    if (std::string(key) == "tip") v.field(key, pose, "wished pose of the tool's tip in the world");
  }
}

void Cell::visit(ConfigVisitor& v) {
  v.section("bin", bin, "the bin");
  v.field("bin_pose", X_WB, "centre of the bin's inner floor in the world");
  v.section("tray", tray, "where parts are put");
  v.section("camera", camera, "where the camera is mounted");
  if (v.reading() || !cameras.empty()) v.list("cameras", cameras, "further cameras: their clouds join the first's");
  visit_arm(v, *this);
  const auto gripper_body = [this](ConfigVisitor& g) {
    g.choice("type", gripper_type, gripper_names(), "kind of gripper");
    // While reading a new one is made, so that copies of this cell keep theirs.
    if (g.reading() || !gripper) gripper = make_gripper(gripper_type);
    gripper->visit(g);
  };
  if (v.is_scalar("gripper")) {
    std::string file;
    v.path("gripper", file, "gripper file");
    read_yaml_file(file, gripper_body);
  } else {
    v.section_with("gripper", gripper_body, "the tool");
  }
  v.section("motion", motion, "speeds");
  v.section("look", look, "where the arm stands while the camera looks");
  std::vector<double> home(q_home.data(), q_home.data() + 6);
  v.field("home", home, Unit::kAngle, "joint angles at the start and end of a cycle");
  q_home = six_joints(home, "home");
}

void Cell::finish() {
  if (arm_path.empty()) throw SpecError("cell.arm: the path of the arm's URDF is missing");
  bin.load();
  arm = std::make_shared<const Arm>(Arm::load(ArmSource{arm_path, arm_packages, arm_tip}));
  if (!gripper) gripper = make_gripper(gripper_type);
  gripper->validate();
  if (look.by == "joints") {
    q_look = look.joints.empty() ? q_home : six_joints(look.joints, "look.joints");
    return;
  }
  if (look.by == "camera" && camera.mount != "flange")
    throw SpecError("cell.look.camera: the camera is not on the flange; give look.joints or look.tip");
  const Pose X_WF = look.pose * (look.by == "camera" ? camera.pose : gripper->X_FG()).inverse();
  const std::vector<Vector6d> solutions = inverse_kinematics(*arm, X_WR.inverse() * X_WF, q_home);
  if (solutions.empty()) throw SpecError("cell.look." + look.by + ": the arm cannot reach this pose");
  q_look = solutions.front();
  const CollisionCheck check(*this, 0);
  for (const Vector6d& q : solutions) {
    if (check.hit(q) != Obstacle::kNone) continue;
    q_look = q;
    break;
  }
}

Pose Cell::camera_pose(const Vector6d& q, std::size_t k) const {
  const CameraMount& mount = camera_at(k);
  return mount.mount == "flange" ? X_WR * arm->forward(q) * mount.pose : mount.pose;
}

Pose Cell::tip_pose(const Vector6d& q) const { return X_WR * arm->forward(q) * gripper->X_FG(); }

std::vector<Primitive> Cell::table_W() const {
  constexpr double kEdge = 2.4, kThickness = 0.05;  // m: reaches beyond the arm on every side
  return {Primitive::box({kEdge, kEdge, kThickness}, Pose(Eigen::Translation3d(0, 0, -kThickness / 2)))};
}

std::vector<Primitive> Cell::tray_W() const {
  BinSpec box;
  box.inner_size = tray.inner_size;
  std::vector<Primitive> boxes = bin_boxes(box, tray.wall);
  for (Primitive& wall : boxes) wall.X_OS = tray.X_WT * wall.X_OS;
  return boxes;
}

std::vector<Primitive> Cell::bin_W() const {
  std::vector<Primitive> boxes = bin_boxes(bin, bin.wall);
  if (bin.solid) boxes.insert(boxes.end(), bin.solid->beyond_plain.begin(), bin.solid->beyond_plain.end());
  for (Primitive& wall : boxes) wall.X_OS = X_WB * wall.X_OS;
  return boxes;
}

std::vector<Primitive> Cell::camera_body_F() const {
  std::vector<Primitive> bodies;
  for (std::size_t k = 0; k < camera_count(); ++k) add_camera_body(camera_at(k), bodies);
  return bodies;
}

void visit_cell(ConfigVisitor& v, const char* key, Cell& cell) {
  if (!v.is_scalar(key)) {
    v.section(key, cell, "bin, tray, camera, arm and gripper as the robot knows them");
    return;
  }
  std::string file;
  v.path(key, file, "cell file");
  read_yaml_file(file, [&](ConfigVisitor& inner) { cell.visit(inner); });
}

}  // namespace binpick

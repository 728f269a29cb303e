#include "robot/collision_check.hpp"

#include <algorithm>
#include <cmath>

#include "robot/primitive_distance.hpp"

namespace binpick {
namespace {

constexpr int kTool = 7;
constexpr double kLipClearance = 0.001;  // m: lips are soft, and stand beside neighbours of the part they take
// The links that could meet though joints lie between them; neighbours and the folded wrist cannot.
bool may_meet(int moving, int other) {
  if (other <= 1) return moving >= 3 && moving - other >= 3;
  return (other == 2 && moving >= 5) || ((other == 3 || other == 4) && moving == kTool);
}

}  // namespace

std::string to_string(Obstacle obstacle) {
  switch (obstacle) {
    case Obstacle::kNone:
      return "nothing";
    case Obstacle::kBin:
      return "the bin";
    case Obstacle::kTable:
      return "the table";
    case Obstacle::kTray:
      return "the tray";
    case Obstacle::kPlaced:
      return "a part in the tray";
    case Obstacle::kSelf:
      return "itself";
    case Obstacle::kHeap:
      return "the heap";
  }
  return "nothing";
}

CollisionCheck::CollisionCheck(const Cell& cell, double clearance) : cell_(&cell), clearance_(clearance) {
  stand(cell.bin_W(), Obstacle::kBin);
  stand(cell.table_W(), Obstacle::kTable);
  stand(cell.tray_W(), Obstacle::kTray);
  const auto& shapes = cell.arm->link_shapes();
  for (std::size_t link = 0; link < shapes.size(); ++link)
    for (const Primitive& shape : shapes[link])
      links_.push_back({shape, bounding_radius(shape), static_cast<int>(link), Obstacle::kNone, Pose::Identity()});
  const auto carry = [&](const std::vector<Primitive>& bodies, const Pose& X_FA) {
    for (Primitive body : bodies) {
      body.X_OS = X_FA * body.X_OS;
      tool_F_.push_back({body, bounding_radius(body), kTool, Obstacle::kNone, Pose::Identity()});
    }
  };
  carry(cell.gripper->body_G(), cell.gripper->X_FG());
  carry(cell.camera_body_F(), Pose::Identity());
  for (const CupSpec& cup : cell.gripper->cups()) {
    // The soft end of a cup, from just above its lip to where the rigid body begins. It may touch what it is pressed
    // on.
    constexpr double kLipGap = 0.0005, kSoftEnd = 0.016;
    const double length = std::max(cup.stroke + 0.006, kSoftEnd) - kLipGap;
    const Pose X_FS = cell.gripper->X_FG() * cup.X_GU * Eigen::Translation3d(0, 0, -kLipGap - length / 2);
    const Primitive lip = Primitive::cylinder(cup.radius, length, X_FS);
    lips_F_.push_back({lip, bounding_radius(lip), kTool, Obstacle::kNone, Pose::Identity()});
  }
}

void CollisionCheck::stand(const std::vector<Primitive>& shapes_W, Obstacle kind) {
  for (const Primitive& shape : shapes_W) standing_.push_back({shape, bounding_radius(shape), 0, kind, shape.X_OS});
}

Obstacle CollisionCheck::standing_hit(const Placed& mover) const {
  const Solid& a = *mover.solid;
  const Eigen::Vector3d half = half_extents_W(a.shape, mover.X_WS.linear());
  for (const Solid& b : standing_) {
    const Eigen::Vector3d between = mover.X_WS.translation() - b.X_WS.translation();
    // First the boxes in the standing solid's own frame, then the exact solids.
    const Eigen::Vector3d gap = (b.X_WS.linear().transpose() * between).cwiseAbs() - b.shape.size / 2;
    if (gap.maxCoeff() > a.radius + clearance_) continue;
    const Eigen::Vector3d half_b = half_extents_W(b.shape, b.X_WS.linear());
    if ((between.cwiseAbs() - half - half_b).maxCoeff() > clearance_) continue;
    if (distance(a.shape, mover.X_WS, b.shape, b.X_WS) <= clearance_) return b.kind;
  }
  return Obstacle::kNone;
}

bool CollisionCheck::heap_hit(const Placed& mover) const {
  if (!heap_) return false;
  const Pose X_WO = mover.X_WS * mover.solid->shape.X_OS.inverse();
  return heap_->touches(mover.solid->shape, X_WO, clearance_, ignored_);
}

bool CollisionCheck::self_hit(const std::vector<Placed>& movers) const {
  for (const Placed& a : movers) {
    for (const Placed& b : movers) {
      if (!may_meet(a.solid->link, b.solid->link)) continue;
      const double apart = (a.X_WS.translation() - b.X_WS.translation()).norm();
      if (apart > a.solid->radius + b.solid->radius) continue;
      if (distance(a.solid->shape, a.X_WS, b.solid->shape, b.X_WS) <= 0) return true;
    }
  }
  return false;
}

Obstacle CollisionCheck::tool_hit(const Pose& X_WF) const {
  for (const Solid& solid : tool_F_) {
    const Placed placed{&solid, X_WF * solid.shape.X_OS};
    if (const Obstacle obstacle = standing_hit(placed); obstacle != Obstacle::kNone) return obstacle;
    if (heap_hit(placed)) return Obstacle::kHeap;
  }
  for (const Solid& lip : lips_F_)
    if (heap_ && heap_->touches(lip.shape, X_WF, std::min(clearance_, kLipClearance), ignored_)) return Obstacle::kHeap;
  return Obstacle::kNone;
}

std::vector<CollisionCheck::Placed> CollisionCheck::robot_at(const Vector6d& q) const {
  const std::vector<Pose> X_RL = cell_->arm->link_poses(q);
  const Pose X_WF = cell_->X_WR * cell_->arm->forward(q);
  std::vector<Placed> movers;
  for (const Solid& solid : links_)
    movers.push_back({&solid, cell_->X_WR * X_RL[static_cast<std::size_t>(solid.link)] * solid.shape.X_OS});
  for (const Solid& solid : tool_F_) movers.push_back({&solid, X_WF * solid.shape.X_OS});
  return movers;
}

Obstacle CollisionCheck::hit(const Vector6d& q, bool lips) const {
  const Pose X_WF = cell_->X_WR * cell_->arm->forward(q);
  if (const Obstacle tool = tool_hit(X_WF); tool != Obstacle::kNone) return tool;
  for (const Solid& lip : lips_F_) {
    if (!lips) break;
    const Obstacle obstacle = standing_hit({&lip, X_WF * lip.shape.X_OS});
    if (obstacle != Obstacle::kNone) return obstacle;
  }
  const std::vector<Placed> movers = robot_at(q);
  for (const Placed& placed : movers) {
    // Base and column stand on the table; the tool has been looked at.
    if (placed.solid->link < 2 || placed.solid->link == kTool) continue;
    if (const Obstacle obstacle = standing_hit(placed); obstacle != Obstacle::kNone) return obstacle;
    if (heap_hit(placed)) return Obstacle::kHeap;
  }
  return self_hit(movers) ? Obstacle::kSelf : Obstacle::kNone;
}

std::vector<Eigen::Vector3d> CollisionCheck::without_robot(const std::vector<Eigen::Vector3d>& points_W,
                                                           const Vector6d& q, double margin) const {
  const std::vector<char> own = near_robot(points_W, q, margin);
  std::vector<Eigen::Vector3d> kept;
  for (std::size_t i = 0; i < points_W.size(); ++i)
    if (!own[i]) kept.push_back(points_W[i]);
  return kept;
}

std::vector<char> CollisionCheck::near_robot(const std::vector<Eigen::Vector3d>& points_W, const Vector6d& q,
                                             double margin) const {
  std::vector<Placed> robot = robot_at(q);
  const Pose X_WF = cell_->X_WR * cell_->arm->forward(q);
  for (const Solid& lip : lips_F_) robot.push_back({&lip, X_WF * lip.shape.X_OS});
  std::vector<char> own;
  for (const Eigen::Vector3d& p_W : points_W) {
    own.push_back(std::any_of(robot.begin(), robot.end(), [&](const Placed& placed) {
      const Eigen::Vector3d between = p_W - placed.X_WS.translation();
      return between.norm() < placed.solid->radius + margin &&
             signed_distance_S(placed.solid->shape, placed.X_WS.linear().transpose() * between) < margin;
    }));
  }
  return own;
}

Obstacle CollisionCheck::path_hit(const JointTrajectory& path, double step, bool lips) const {
  if (path.empty()) return Obstacle::kNone;
  // A turn of joint i moves nothing further than the arm and tool reach beyond it.
  const Vector6d lever = (Vector6d() << 1.0, 1.0, 0.8, 0.4, 0.4, 0.25).finished();
  Vector6d last = path.q.front();
  Obstacle obstacle = hit(last, lips);
  for (std::size_t k = 1; k < path.q.size() && obstacle == Obstacle::kNone; ++k) {
    const Vector6d way = path.q[k] - last;
    const double moved = way.cwiseAbs().dot(lever);
    if (moved < step && k + 1 < path.q.size()) continue;
    const int pieces = std::max(1, static_cast<int>(std::ceil(moved / step)));
    for (int i = 1; i <= pieces && obstacle == Obstacle::kNone; ++i)
      obstacle = hit(last + way * (static_cast<double>(i) / pieces), lips);
    last = path.q[k];
  }
  return obstacle;
}

Obstacle CollisionCheck::points_hit(const std::vector<Eigen::Vector3d>& points_W, double allowed) const {
  // A ball around all of them: what it does not reach, none of them does.
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p_W : points_W) box.extend(p_W);
  const Eigen::Vector3d center = box.center();
  double radius = 0;
  for (const Eigen::Vector3d& p_W : points_W) radius = std::max(radius, (p_W - center).norm());
  for (const Solid& solid : standing_) {
    const Pose X_SW = solid.X_WS.inverse();
    if (signed_distance_S(solid.shape, X_SW * center) - radius > 1e-9 - allowed) continue;
    for (const Eigen::Vector3d& p_W : points_W)
      if (signed_distance_S(solid.shape, X_SW * p_W) < -allowed) return solid.kind;
  }
  return Obstacle::kNone;
}

}  // namespace binpick

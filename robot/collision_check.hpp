// Arm links, tool and camera against everything the robot knows: bin, table, tray, the parts that lie in it, itself,
// and the perceived heap. All shapes are primitives; the heap is points. Frames: links in their own, tool and camera in
// the flange frame F.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "robot/cell.hpp"
#include "robot/obstacle_map.hpp"

namespace binpick {

enum class Obstacle { kNone, kBin, kTable, kTray, kPlaced, kSelf, kHeap };
std::string to_string(Obstacle obstacle);

class CollisionCheck {
 public:
  /// `clearance` is kept from everything but the arm itself.
  CollisionCheck(const Cell& cell, double clearance);

  /// From now on the heap counts too, without the points whose entry in `ignored` is not 0.
  void set_heap(const ObstacleMap* heap) { heap_ = heap; }
  void set_ignored(std::vector<char> ignored) { ignored_ = std::move(ignored); }
  /// Parts that lie in the tray, as solids in W.
  void add_placed(const std::vector<Primitive>& parts_W) { stand(parts_W, Obstacle::kPlaced); }

  /// The first obstacle met by the arm, the tool or the camera at q; with `lips`, by the lips too. At a contact they
  /// may touch the bin, for they give way; on a free way they may not.
  Obstacle hit(const Vector6d& q, bool lips = false) const;
  /// The same for tool and camera alone, flange at X_WF: quicker, and asks for no inverse kinematics.
  Obstacle tool_hit(const Pose& X_WF) const;
  /// The first obstacle along a trajectory, sampled so that nothing moves more than about `step` in between.
  Obstacle path_hit(const JointTrajectory& path, double step = 0.02, bool lips = false) const;
  /// The points that are not within `margin` of arm, tool or camera at q: a camera sees its own robot too.
  std::vector<Eigen::Vector3d> without_robot(const std::vector<Eigen::Vector3d>& points_W, const Vector6d& q,
                                             double margin) const;
  /// Of each point whether it is: what without_robot() leaves out.
  std::vector<char> near_robot(const std::vector<Eigen::Vector3d>& points_W, const Vector6d& q, double margin) const;
  /// Points of a held part against bin, tray and table, deeper than `allowed`.
  Obstacle points_hit(const std::vector<Eigen::Vector3d>& points_W, double allowed) const;

 private:
  struct Solid {
    Primitive shape;
    double radius = 0;  ///< of the bounding sphere
    int link = 0;       ///< 0 .. 6: links; 7: tool and camera
    Obstacle kind = Obstacle::kNone;
    Pose X_WS = Pose::Identity();  ///< of standing solids
  };
  struct Placed {
    const Solid* solid;
    Pose X_WS;
  };
  void stand(const std::vector<Primitive>& shapes_W, Obstacle kind);
  std::vector<Placed> robot_at(const Vector6d& q) const;
  Obstacle standing_hit(const Placed& mover) const;
  bool heap_hit(const Placed& mover) const;
  bool self_hit(const std::vector<Placed>& movers) const;

  const Cell* cell_;
  double clearance_;
  const ObstacleMap* heap_ = nullptr;
  std::vector<char> ignored_;
  std::vector<Solid> standing_, links_, tool_F_, lips_F_;
};

}  // namespace binpick

// The cell inside the physics world: bin, table, tray, arm links and tool as bodies, parts as they are dropped; and the
// same things as a RenderScene for the camera. Arm and lips enter with set_heap(): parts are dropped before the arm
// comes.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/part.hpp"
#include "robot/cell.hpp"
#include "sim/drop.hpp"
#include "sim/hold.hpp"
#include "sim/render_scene.hpp"
#include "sim/world.hpp"

namespace binpick {

class CellWorld {
 public:
  CellWorld(const Cell& cell, const PhysicsConfig& physics, std::span<const Part> parts);
  CellWorld(const CellWorld&) = delete;  // the lips hold on to the world
  CellWorld& operator=(const CellWorld&) = delete;

  World& world() { return world_; }
  const World& world() const { return world_; }
  const Cell& cell() const { return *cell_; }
  std::span<const Part> parts() const { return parts_; }

  /// Adds what was dropped, so that it is drawn and counted; then the arm stands at the look pose.
  void set_heap(const DropResult& drop);
  const DropResult& heap() const { return heap_; }

  /// Where the arm stands at the end of the next step (moves the link and tool bodies).
  void set_joints(const Vector6d& q);
  /// The arm stands there at once, lips fully out; whatever was held is let go.
  void jump_to(const Vector6d& q);
  const Vector6d& joints() const { return q_; }

  /// The cups; after set_heap().
  CupHold& hold() { return *hold_; }
  const CupHold& hold() const { return *hold_; }
  void set_hold_config(const HoldConfig& config);

  /// Everything the camera can see, at the current poses. Part ids are heap indices.
  RenderScene render_scene() const;

  const Part& part_of(std::size_t heap_index) const { return parts_[heap_.parts[heap_index]]; }
  Pose part_pose(std::size_t heap_index) const { return world_.pose(heap_.bodies[heap_index]); }  ///< X_WP
  Eigen::Vector3d box_center(std::size_t heap_index) const;                                       ///< in W
  std::optional<std::size_t> heap_index_of(BodyId body) const;
  bool in_bin(std::size_t heap_index) const;   ///< mass centre over the bin's inner floor, below its rim + one diameter
  bool in_tray(std::size_t heap_index) const;  ///< box centre inside the tray

  /// The surface of the parts as drawn (never their convex pieces) where each cup's probe rays meet it, for
  /// Gripper::judge: rays start from the lip's actual place. Samples are given in G with the plunger's travel in them;
  /// where the lip is held off the surface by something else, as seen from the lip, so that the gap shows.
  std::vector<SurfaceSample> probe_cups() const;

  /// Largest force on arm and tool by free bodies in the last step, deepest overlap with what is fixed, and who with
  /// whom.
  struct Touch {
    double force = 0;  ///< N
    double depth = 0;  ///< m, of arm or tool in bin, tray or table
    std::string pushed, entered;
  };
  /// Arm, tool (with the camera it carries) and lips in contact with bin, tray or table now, by name ("tool in the
  /// bin", "lip on the table"), and how deep (m; of a lip as it is pressed in).
  std::map<std::string, double> cell_contacts();
  Touch arm_contact(const std::map<std::string, double>& cell_contacts);

  BodyId bin_body = -1, table_body = -1, tray_body = -1, tool_body = -1;
  std::vector<BodyId> link_bodies;  ///< -1 for a link without shape

 private:
  std::vector<std::pair<BodyId, std::string>> moving_bodies() const;
  void add_fixed_bodies();
  void add_arm();
  void add_items_of_cell(RenderScene& scene) const;
  void sample_cup(std::size_t cup, std::span<const Eigen::Vector3d> probes_G, std::span<SurfaceSample> samples) const;
  SurfaceSample first_hit(const Eigen::Vector3d& origin_W, const Eigen::Vector3d& direction_W, double range) const;

  const Cell* cell_;
  std::span<const Part> parts_;
  World world_;
  DropResult heap_;
  Vector6d q_;
  HoldConfig hold_config_;
  std::unique_ptr<CupHold> hold_;
  BodyId thin_bin_body_ = -1;  ///< the bin as drawn: what arm and tool may not touch
  std::vector<MeshQuery> part_queries_;
  std::vector<std::shared_ptr<const TriangleMesh>> part_meshes_, link_meshes_, lip_meshes_;
  std::shared_ptr<const TriangleMesh> bin_mesh_, table_mesh_, tray_mesh_, tool_mesh_, camera_mesh_;
};

}  // namespace binpick

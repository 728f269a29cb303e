// The cell inside the physics world: bin, table, tray, arm links and tool as bodies, parts as they are dropped; and the same
// things as a RenderScene for the camera.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/part.hpp"
#include "robot/cell.hpp"
#include "sim/drop.hpp"
#include "sim/render_scene.hpp"
#include "sim/world.hpp"

namespace binpick {

/// A tool's lips: dynamic bodies on spring plungers.
struct CupBodies {
  std::vector<BodyId> lips;
};

class CellWorld {
 public:
  CellWorld(const Cell& cell, const PhysicsConfig& physics, std::span<const Part> parts);

  World& world() { return world_; }
  const World& world() const { return world_; }
  const Cell& cell() const { return *cell_; }
  std::span<const Part> parts() const { return parts_; }

  /// Adds what was dropped, so that it is drawn and counted.
  void set_heap(const DropResult& drop) { heap_ = drop; }
  const DropResult& heap() const { return heap_; }

  /// Where the arm stands (moves the link and tool bodies with the next step).
  void set_joints(const Vector6d& q);
  const Vector6d& joints() const { return q_; }

  /// Everything the camera can see, at the current poses. Part ids are heap indices.
  RenderScene render_scene() const;

  bool in_bin(std::size_t heap_index) const;   ///< mass centre over the bin's inner floor, below its rim + one diameter
  bool in_tray(std::size_t heap_index) const;  ///< box centre inside the tray

  BodyId bin_body = -1, table_body = -1, tray_body = -1, tool_body = -1;
  std::vector<BodyId> link_bodies;

 private:
  const Cell* cell_;
  std::span<const Part> parts_;
  World world_;
  DropResult heap_;
  Vector6d q_;
  std::vector<std::shared_ptr<const TriangleMesh>> part_meshes_;
  std::vector<std::shared_ptr<const TriangleMesh>> link_meshes_;
  std::shared_ptr<const TriangleMesh> bin_mesh_, table_mesh_, tray_mesh_, tool_mesh_;
};

}  // namespace binpick

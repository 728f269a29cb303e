// The bin: an open box, its walls upright or leaning outwards, with or without dividers, or from CAD. Frame B: centre
// of the inner floor, z up.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "core/config.hpp"
#include "core/error.hpp"
#include "core/primitive.hpp"

namespace binpick {

struct BinMesh;

struct BinSpec {
  Eigen::Vector3d inner_size = {0.4, 0.3, 0.2};  ///< m: x and y at the floor, height of the walls
  double wall = 0.005;                           ///< m, wall and floor thickness as seen
  double draft = 0;                              ///< rad, by which every wall leans outwards
  std::vector<double> dividers_x, dividers_y;    ///< m: x of the dividers along y, y of those along x
  double divider_height = 0;                     ///< m above the floor; 0: as high as the walls
  double divider_thickness = 0.004;              ///< m
  double friction = 0.4;
  double restitution = 0.1;
  /// Path of a closed mesh in B that is the bin; then inner_size, draft and wall say where its floor and walls are.
  std::string mesh;
  std::string mesh_unit;                                      ///< empty: mm, or the STEP file's own
  std::shared_ptr<const BinMesh> solid;                       ///< of `mesh`, after load()
  std::shared_ptr<const std::vector<TriangleMesh>> pieces_B;  ///< of `solid`, convex, when sim has prepared them

  void visit(ConfigVisitor& v);
  void validate() const;
  /// Reads `mesh` unless there is none or it is read. Throws AssetError.
  void load();

  /// False for the plain box: upright walls and nothing in between.
  bool shaped() const { return draft != 0 || !dividers_x.empty() || !dividers_y.empty() || !mesh.empty(); }
  /// The same floor and walls without mesh and dividers.
  BinSpec plain() const;
  /// Half the inner length and width at a height above the floor, m; below the floor and above the rim as there.
  Eigen::Vector2d half_at(double z) const;
  /// Inner length, width and height at the rim, m: what stands around everything inside.
  Eigen::Vector3d rim_size() const;
  double volume() const;  ///< m^3 inside up to the rim, less the dividers; what a mesh holds beyond the walls counts
};

/// Floor, four walls, dividers, as boxes in B. The inner faces are exact; `thickness` of floor and walls goes outwards.
/// Of a bin from CAD the walls it states.
std::vector<Primitive> bin_boxes(const BinSpec& bin, double thickness);

}  // namespace binpick

// Many rays of one direction: is anything of a mesh in their way? Since all are parallel, the mesh is laid out once on
// a grid across them, and each ray looks only at the triangles over its cell that do not lie behind it. A triangle is
// tested as MeshQuery::ray does (Woop, Benthin and Wald 2013, watertight, in double), so yes and no are the same; only
// where and what is first hit is not asked. Frame of the mesh, metres.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "core/mesh.hpp"

namespace binpick {

class ParallelRays {
 public:
  /// `direction`: finite and not zero.
  ParallelRays(const TriangleMesh& mesh, const Eigen::Vector3d& direction);

  /// Does the ray from `origin` meet a triangle, on either side? What stopped the last ray is asked first, so one
  /// object serves one thread.
  bool blocked(const Eigen::Vector3d& origin);

 private:
  struct Candidate {
    std::uint32_t triangle;
    float top;  // m along the ray's main axis: nothing of the triangle lies further along, rounding included
  };
  struct Shade {
    std::array<int, 2> low, high;  // cells
    float top;
  };
  Eigen::Vector3d sheared(const Eigen::Vector3d& p) const;
  std::array<int, 2> cell_of(double x, double y) const;
  Shade shade_of(std::size_t triangle, const std::vector<Eigen::Vector3d>& across) const;
  void fill_grid();
  bool hits(std::uint32_t triangle, const Eigen::Vector3d& origin) const;

  std::vector<Eigen::Vector3d> points_;  // axes permuted so that the last is the ray's main one
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  Eigen::Index x_, y_, z_;
  double shear_x_, shear_y_, shear_z_, sign_;
  double low_x_ = 0, low_y_ = 0, per_x_ = 0, per_y_ = 0;
  int size_ = 1;
  std::vector<std::uint32_t> first_;
  std::vector<Candidate> candidates_;
  std::uint32_t last_ = ~std::uint32_t{0};
};

}  // namespace binpick

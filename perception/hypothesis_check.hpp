// Is a hypothesis borne out by the scene (paper 4.2)? First on a voxel grid, as in the paper: how many of the model's
// visible points fall into occupied voxels. Then along the rays: a visible model point is an inlier when the scene's
// depth there agrees, occluded when the scene is nearer, seen through when the scene is farther (then the part cannot
// be there), and unknown where there is no depth. A pose below the floor or through a wall is refused outright.
#pragma once

#include <cstdint>
#include <vector>

#include "core/config.hpp"
#include "perception/scene.hpp"
#include "perception/surface_model.hpp"

namespace binpick {

struct CheckConfig {
  double voxel = 0.04;              ///< of the diameter, edge of the verification grid (the L of paper 4.2)
  double least_voxel_share = 0.15;  ///< of the visible points in occupied voxels: below, a hypothesis is dropped
  double tolerance = 0.003;         ///< m, depth agreement of an inlier, at least
  double tolerance_sigmas = 2.5;    ///< and at least this many standard deviations of the sensor
  double rough = 2;                 ///< times wider before refinement
  double normal_tolerance = 1.05;   ///< rad, normal agreement of an inlier
  double wall_tolerance = 0.004;    ///< m, how far a pose may reach into floor or wall, beside 2 sigma
  int points = 250;                 ///< model points that are tried

  void visit(ConfigVisitor& v);
  void validate() const;
};

/// Depth difference up to which scene and model agree at a range, m.
float depth_tolerance(const Scene& scene, float z, const CheckConfig& config);

/// Voxels that hold a wanted scene point, each grown by one: a bit set over the scene's box.
class VoxelSet {
 public:
  VoxelSet(const Scene& scene, double voxel);
  bool contains(const Eigen::Vector3f& p_C) const {
    const Eigen::Array3f c = (p_C - low_).array() * inverse_;
    if (!((c >= 0.0f).all() && (c < size_.cast<float>()).all())) return false;
    const Eigen::Array3i i = c.cast<int>();
    return filled_[(static_cast<std::size_t>(i.z()) * size_.y() + i.y()) * size_.x() + i.x()] != 0;
  }

 private:
  Eigen::Vector3f low_ = Eigen::Vector3f::Zero();
  Eigen::Array3i size_ = Eigen::Array3i::Ones();
  float inverse_ = 1;
  std::vector<std::uint8_t> filled_;
};

/// Shares of the visible surface as the camera sees it (every point weighs with the area it covers in the image).
struct CheckCounts {
  float tried = 0, inliers = 0, occluded = 0, through = 0, unknown = 0,
        off = 0;  ///< off: depth agrees, normal does not
  /// Inliers against contradictions, -1 .. 1, larger is better.
  double score() const { return tried > 0 ? (inliers - 1.5 * through - 0.3 * off - 0.2 * unknown) / tried : -1; }
};

/// Share of the model's visible points in occupied voxels.
double voxel_share(const VoxelSet& voxels, const SurfaceModel& model, const Pose& X_CP, int points);

/// The shares along the rays; `widened`: tolerance in multiples of the configured one.
CheckCounts check_rays(const Scene& scene, const SurfaceModel& model, const Pose& X_CP, const CheckConfig& config,
                       double widened = 1);

/// True when no point of the pose lies below the floor or behind a wall and, without a bin, that none reaches through a
/// large plane in view.
bool fits_bin(const Scene& scene, const SurfaceModel& model, const Pose& X_CP, const CheckConfig& config);

}  // namespace binpick

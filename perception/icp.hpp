// Iterative closest point on what can be seen (paper 4.2). Only surface points visible at the current pose attract
// scene points, since the hidden side would pull the part towards itself. Scene points are compared with the model's
// SURFACE (plane at the nearest surface point). Beside it, when asked, a silhouette term: along the drawn outline the
// depth step of the scene is searched across the outline, which fixes what flat faces leave free. Frame P for twists;
// metres.
#pragma once

#include "core/config.hpp"
#include "core/pose.hpp"
#include "perception/scene.hpp"
#include "perception/surface_model.hpp"

namespace binpick {

struct IcpConfig {
  int coarse_iterations = 10;
  int quick_iterations = 4;
  int fine_iterations = 10;
  double gate = 0.08;          ///< of the diameter, first reach; it shrinks to three standard deviations
  double least_gate = 0.003;   ///< m
  double accept = 0.001;       ///< m, mean deviation of the visible scene points from the surface (paper: 1 mm)
  double accept_sigmas = 1.0;  ///< plus this many standard deviations that the sensor states at the range; 0: paper
  int points = 700;            ///< scene points used, about
  int density = 3;             ///< times as many in the fine stage, of together the same weight
  bool silhouette = true;      ///< use the outline
  double outline_search = 6;   ///< px to either side
  double outline_first = 14;   ///< px at first, narrowing
  double outline_sigma = 1.0;  ///< px, trust in one outline pixel
  double correlated_px = 0;    ///< px that share one noise value: scales the covariance; 0: measured in the frame
  double bias_sigmas = 0.25;   ///< part of the stated deviation that moves a whole part where noise is correlated

  void visit(ConfigVisitor& v);
  void validate() const;
};

struct IcpResult {
  Pose X_CP = Pose::Identity();
  int points = 0;             ///< scene points explained by the surface
  double mean_deviation = 0;  ///< m
  double rms = 0;             ///< m
  Matrix6d covariance = Matrix6d::Zero();
};

/// Coarse: surface only, from a wide gate. Fine: narrow gate, with the silhouette. Quick: the same with few points and
/// iterations, to tell whether a pose is worth it.
enum class IcpStage { kCoarse, kQuick, kFine };
IcpResult refine_pose(const Scene& scene, const SurfaceModel& model, const Pose& X_CP, const IcpConfig& config,
                      IcpStage stage);

/// Mean deviation up to which a pose is accepted at a range, m.
double accepted_deviation(const Scene& scene, double z, const IcpConfig& config);

}  // namespace binpick

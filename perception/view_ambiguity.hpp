// Does a view hold the answer? A pose X is ambiguous in a view when one of the part's self-overlaps T
// (self_overlap.hpp) gives a pose X * T that the camera cannot tell from X: where the two drawings differ (by more than
// the sensor's noise, in a patch wider than the sensor blurs) is less than a small share of what is seen of the part.
// The verdict belongs to part, view and sensor, not to any estimator: the bench asks it of true poses, the estimator of
// its own.
//   AmbiguousViews views(part);
//   views.ambiguous(X_CP_true, camera, noise);               // the part alone
//   views.ambiguous(X_CP_true, camera, noise, &exact_depth); // as far as it is visible in a noise-free frame
// Frame C, metres. From the CAD alone; nothing is learnt.
#pragma once

#include <vector>

#include "core/depth_frame.hpp"
#include "core/part.hpp"
#include "perception/self_overlap.hpp"

namespace binpick {

struct AmbiguityConfig {
  double tolerance = 0.0015;        ///< m, depth difference that counts, at least
  double tolerance_sigmas = 2.5;    ///< and at least so many standard deviations of the sensor
  double least_difference = 0.025;  ///< of the visible pixels; fewer cannot be relied on

  void visit(ConfigVisitor& v);
  void validate() const;
};

class AmbiguousViews {
 public:
  AmbiguousViews() = default;
  explicit AmbiguousViews(const Part& part);

  /// `exact`: noise-free depth of the whole scene (NaN or infinity: nothing there); null: the part alone.
  bool ambiguous(const Pose& X_CP, const PinholeCamera& camera, const StatedNoise& noise,
                 const Image<float>* exact = nullptr, const AmbiguityConfig& config = {}) const;

  /// The most similar pose: share of the visible pixels that differ (0: none do; 1: no rival), and the pose X * T.
  struct Rival {
    double difference = 1;
    Pose X_CP = Pose::Identity();
  };
  Rival nearest_rival(const Pose& X_CP, const PinholeCamera& camera, const StatedNoise& noise,
                      const Image<float>* exact = nullptr, const AmbiguityConfig& config = {}) const;
  const std::vector<SelfOverlap>& overlaps() const { return overlaps_; }

 private:
  TriangleMesh mesh_P_;
  Eigen::AlignedBox3d box_P_;
  std::vector<SelfOverlap> overlaps_;
};

}  // namespace binpick

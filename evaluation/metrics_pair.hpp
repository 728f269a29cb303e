// The errors of one estimate against one true pose, as the field defines them (docs/metrics.md), from one preparation
// of the part. Metres, radians, pixels; both poses in the camera's frame C. Sources: pose_error.py of the BOP toolkit
// (MIT); ADD, ADI: Hinterstoisser et al., ACCV 2012; MSSD, MSPD: Hodan et al., BOP challenge 2019/2020.
#pragma once

#include <limits>
#include <memory>

#include "core/camera.hpp"
#include "core/pose.hpp"
#include "evaluation/metrics_model.hpp"

namespace binpick {

class ProjectedVertices;

struct PairErrors {
  double add = 0;            ///< m, mean distance of corresponding vertices; knows no symmetry
  double adi = 0;            ///< m (ADD-S), mean distance of true vertices to the nearest estimated one
  double mssd = 0;           ///< m, largest vertex distance, least over the symmetries
  double mspd_px = 0;        ///< px, largest distance of projected vertices, least over the symmetries
  double projection_px = 0;  ///< px, mean distance of projected vertices; knows no symmetry
  double translation = 0;    ///< m (TE), distance of the origins
  double rotation = 0;       ///< rad (RE), angle between the orientations; knows no symmetry
  double rotation_twin = 0;  ///< rad, the same to the nearest twin of the truth, in closed form
  double surface = 0;        ///< m, the distance of Bregier et al.
};

/// All of them, the vertices gone through once for those that are means.
PairErrors pair_errors(const Pose& X_CP_est, const Pose& X_CP_true, const FieldModel& model,
                       const PinholeCamera& camera, SymmetrySearch search = SymmetrySearch::kExact);

inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// MSSD; infinite where it is `limit` or more, which is known long before its value.
double mssd_error(const Pose& X_CP_est, const Pose& X_CP_true, const FieldModel& model, SymmetrySearch search,
                  double limit = kNoLimit);

/// MSPD, infinite from `limit_px` on and when a vertex lies behind the camera. kExact refines the best of the toolkit's
/// turns about a continuous axis by golden section; a sphere is taken turned as the estimate is.
double mspd_error(const Pose& X_CP_est, const Pose& X_CP_true, const FieldModel& model, const PinholeCamera& camera,
                  SymmetrySearch search, double limit_px = kNoLimit);

/// The same for one estimate against many truths: its vertices are projected once. The model must outlive it.
class EstimateInImage {
 public:
  EstimateInImage(const Pose& X_CP_est, const FieldModel& model, const PinholeCamera& camera);
  ~EstimateInImage();
  EstimateInImage(const EstimateInImage&) = delete;
  EstimateInImage& operator=(const EstimateInImage&) = delete;
  double mspd(const Pose& X_CP_true, SymmetrySearch search, double limit_px = kNoLimit);

 private:
  Pose X_CP_est_;
  const FieldModel* model_;
  std::unique_ptr<ProjectedVertices> seen_;
};

}  // namespace binpick

#include "perception/score_calibration.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace binpick {
namespace {

constexpr double kMisfit = 0.4;  // log of the residual, beyond which the surface is another one
constexpr double kHeld = 1e12;   // 1/m^2 or 1/rad^2, information that holds a symmetric twist

// Made by (P: build/release/tools/binpick bench; ALL: every shipped part of one kind but the tee; OPEN: see below):
//   P perception --features a.csv --seeds 100:118 --parts ALL OPEN --sensor gauss_0.5mm,d435_848,d435_848_out_of_box
//   P perception --features b.csv --seeds 100:104 --parts ALL OPEN --sensor active_stereo:d435_848
//   P perception --features c.csv --seeds 110:114 --parts ALL-BUT-X OPEN --sensor gauss_0.5mm,d435_848
//     --other-part assets/parts/X/part.yaml, for every X of ALL and the tee: all of them wrong
//   P score a.csv b.csv c.csv ..
// OPEN: --set accept.least_quality=0.4 --set accept.least_explained=0.1 --set accept.least_pixels=40
//   --set accept.largest_leak=0.95 --set accept.least_own=0.3 --set accept.largest_overlap=0.3
//   --set accept.least_score=0 --set accept.largest_side_leak=1
// The prior: of 4966 poses 3286 are right; of the wrong ones 1522 are of a part that is not there at all. So a score
// means what it says in bins of which a user knows about two times in three what lies in them. Log loss 0.051; at 0.5,
// 98.7 % of the right ones are kept, and 50 wrong ones.
constexpr ScoreFeatures kWeights = {-38.71,  1.479,  -8.574, -6.413, 11.58,  12.54,  10.96, -69.88,
                                    -0.4876, -8.118, 6.662,  3.227,  -7.567, -2.764, 3.013, 8.468};

}  // namespace

const std::array<std::string, kScoreFeatures>& score_feature_names() {
  static const std::array<std::string, kScoreFeatures> names = {
      "one",       "quality",   "leak",   "own",          "log_own_px", "unknown",  "covered", "overlap",
      "deviation", "leak_side", "judged", "smooth_cover", "thin_cover", "residual", "misfit",  "turned"};
  return names;
}

std::vector<Vector6d> symmetry_twists(const Symmetry& symmetry) {
  std::vector<Vector6d> twists;
  const auto add = [&](const Eigen::Vector3d& point_P, const Eigen::Vector3d& direction_P) {
    Vector6d twist;
    twist << point_P.cross(direction_P), direction_P;
    twists.push_back(twist);
  };
  if (symmetry.center_P) {
    for (int k = 0; k < 3; ++k) add(*symmetry.center_P, Eigen::Vector3d::Unit(k));
  } else if (symmetry.axis) {
    add(symmetry.axis->point_P, symmetry.axis->direction_P.normalized());
  }
  return twists;
}

double corner_deviation(const Matrix6d& covariance, const Eigen::AlignedBox3f& box_P,
                        const std::vector<Vector6d>& twists) {
  Matrix6d information = covariance.ldlt().solve(Matrix6d::Identity());
  for (const Vector6d& s : twists) information += kHeld * s * s.transpose();
  const Matrix6d held = information.ldlt().solve(Matrix6d::Identity());
  double worst = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d p = box_P.corner(static_cast<Eigen::AlignedBox3f::CornerType>(corner)).cast<double>();
    Eigen::Matrix<double, 3, 6> J;  // of t + w x p
    J << Eigen::Matrix3d::Identity(),
        (Eigen::Matrix3d() << 0, p.z(), -p.y(), -p.z(), 0, p.x(), p.y(), -p.x(), 0).finished();
    worst = std::max(worst, (J * held * J.transpose()).trace());
  }
  return std::sqrt(std::max(worst, 0.0));
}

ScoreFeatures score_features(const SurfaceModel& model, const Candidate& candidate,
                             const std::vector<Vector6d>& twists) {
  const ViewCheck& c = candidate.check;
  const double pixels = std::max(1, c.pixels);
  const double deviation = corner_deviation(candidate.fit.covariance, model.box(), twists) / (2.0 * model.radius());
  ScoreFeatures f;
  f[0] = 1;
  f[1] = -std::log(0.02 + 1 - c.quality());
  f[2] = c.leak;
  f[3] = candidate.own;
  f[4] = std::log10(std::max(1.0, candidate.own * c.inliers));
  f[5] = c.unknown / pixels;
  f[6] = c.covered / pixels;
  f[7] = candidate.overlap;
  f[8] = std::clamp(std::log10(std::max(deviation, 1e-6)), -4.0, 0.0);
  const PoseEvidence& e = candidate.evidence;
  f[9] = e.leak_side;
  f[10] = e.judged;
  f[11] = e.smooth_cover;
  f[12] = e.thin_cover;
  f[13] = std::log(0.3 + e.residual);
  f[14] = std::max(0.0, f[13] - kMisfit);
  f[15] = std::sqrt(e.turned);
  return f;
}

double calibrated_score(const ScoreFeatures& features, bool ambiguous) {
  double sum = 0;
  for (std::size_t k = 0; k < kScoreFeatures; ++k) sum += kWeights[k] * features[k];
  return (ambiguous ? 0.5 : 1.0) / (1 + std::exp(-sum));
}

}  // namespace binpick

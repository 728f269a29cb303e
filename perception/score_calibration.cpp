#include "perception/score_calibration.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace binpick {
namespace {

constexpr double kLeastSigma = 0.0005;  // m, below which a fit's residual says nothing more
constexpr double kHeld = 1e12;          // 1/m^2 or 1/rad^2, information that holds a symmetric twist

// Made by (P: build/release/tools/binpick bench; ALL: every shipped part of one kind; OPEN: see below):
//   P perception --features a.csv --seeds 100:108 --parts ALL OPEN --sensor gauss_0.5mm,d435_848,d435_848_out_of_box
//   P perception --features b.csv --seeds 100:104 --parts ALL OPEN --sensor active_stereo:d435_848
//   P perception --features c.csv --seeds 110:111 --parts ALL-BUT-X OPEN --sensor gauss_0.5mm,d435_848
//     --other-part assets/parts/X/part.yaml, for X = bearing_6914, bracket_l, bolt_m24x80, tee: all of them wrong
//   P score a.csv b.csv c.csv ..
// OPEN: --set accept.least_quality=0.4 --set accept.least_explained=0.1 --set accept.least_pixels=40
//   --set accept.largest_leak=0.95 --set accept.least_own=0.3 --set accept.largest_overlap=0.3
//   --set accept.least_score=0
// 2214 poses: log loss 0.090, calibration error 0.008; at 0.5, 98.2 % of the right ones are kept.
constexpr ScoreFeatures kWeights = {-13.51,  2.221, -2.055,  -17.55, -3.677, 5.998,
                                    -0.7714, 0.851, -0.7701, -65.72, -0.6649};

}  // namespace

const std::array<std::string, kScoreFeatures>& score_feature_names() {
  static const std::array<std::string, kScoreFeatures> names = {
      "one", "quality", "explained", "leak", "own", "log_own_px", "fit", "unknown", "covered", "overlap", "deviation"};
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

ScoreFeatures score_features(const Scene& scene, const SurfaceModel& model, const Candidate& candidate,
                             const std::vector<Vector6d>& twists) {
  const ViewCheck& c = candidate.check;
  const double pixels = std::max(1, c.pixels);
  const double z = (candidate.fit.X_CP * model.center().cast<double>()).z();
  const double sigma = std::max(kLeastSigma, scene.noise.sigma(z));
  const double deviation = corner_deviation(candidate.fit.covariance, model.box(), twists) / (2.0 * model.radius());
  ScoreFeatures f;
  f[0] = 1;
  f[1] = -std::log(0.02 + 1 - c.quality());
  f[2] = c.explained_share();
  f[3] = c.leak;
  f[4] = candidate.own;
  f[5] = std::log10(std::max(1.0, candidate.own * c.inliers));
  f[6] = std::min(4.0, candidate.fit.rms / sigma);
  f[7] = c.unknown / pixels;
  f[8] = c.covered / pixels;
  f[9] = candidate.overlap;
  f[10] = std::clamp(std::log10(std::max(deviation, 1e-6)), -4.0, 0.0);
  return f;
}

double calibrated_score(const ScoreFeatures& features, bool ambiguous) {
  double sum = 0;
  for (std::size_t k = 0; k < kScoreFeatures; ++k) sum += kWeights[k] * features[k];
  return (ambiguous ? 0.5 : 1.0) / (1 + std::exp(-sum));
}

}  // namespace binpick

#include "perception/disparity_ripple.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

namespace binpick {
namespace {

constexpr int kRounds = 5;
constexpr double kRobust = 2;       // standard deviations: farther points are parts against the wall, or the rim
constexpr double kCorrelated = 40;  // pixels that share one noise value
constexpr double kFaceSigma = 10;   // px, level and slope of a face: as good as unknown

struct Wave {
  double sine, cosine;
};

Wave wave_at(double disparity) {
  const double angle = 2 * std::numbers::pi * (disparity - std::floor(disparity));
  return {std::sin(angle), std::cos(angle)};
}

}  // namespace

DisparityRipple fit_ripple(std::span<const RippleSample> samples, int faces, double fB, double amplitude_sigma) {
  if (samples.empty()) return {fB, 0, 0};
  double middle = 0;
  for (const RippleSample& s : samples) middle += s.disparity / static_cast<double>(samples.size());
  std::vector<Wave> waves;
  waves.reserve(samples.size());
  for (const RippleSample& s : samples) waves.push_back(wave_at(s.disparity));
  const int unknowns = 2 + 2 * faces;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(unknowns);
  for (int round = 0; round < kRounds; ++round) {
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(unknowns, unknowns);
    A.diagonal().setConstant(1 / (kFaceSigma * kFaceSigma));
    A.diagonal().head<2>().setConstant(1 / (amplitude_sigma * amplitude_sigma));
    Eigen::VectorXd b = Eigen::VectorXd::Zero(unknowns);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const RippleSample& s = samples[i];
      const Wave& wave = waves[i];
      // Four of the numbers are not zero: two of the wave, two of the face.
      const int at[4] = {0, 1, 2 + 2 * s.face, 3 + 2 * s.face};
      const double value[4] = {wave.sine, wave.cosine, 1, s.disparity - middle};
      double left = s.off;
      for (int k = 0; k < 4; ++k) left -= value[k] * x[at[k]];
      const double r = left / (kRobust * s.sigma),
                   w = 1 / (s.sigma * s.sigma * kCorrelated * (1 + r * r) * (1 + r * r));
      for (int k = 0; k < 4; ++k) {
        for (int l = 0; l < 4; ++l) A(at[k], at[l]) += w * value[k] * value[l];
        b[at[k]] += w * value[k] * s.off;
      }
    }
    x = A.ldlt().solve(b);
  }
  return {fB, x[0], x[1]};
}

}  // namespace binpick

#include "perception/bin_localisation.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/error.hpp"
#include "perception/bin_faces.hpp"

namespace binpick {
namespace {

constexpr double kBinWidth = 0.0005;    // m, of a histogram
constexpr int kFewestPixels = 12;       // in the mode of a cell
constexpr double kModeShare = 0.25;     // of a cell's highest mode: a deeper one this high is the face
constexpr double kSystematic = 0.0003;  // m, of a cell: what averaging does not remove
constexpr double kWallSigma = 0.00015;  // m, shared by all walls: medians and holes lean to one side of a grazing face
constexpr double kCorrelated = 5;       // pixels of a cell that share one noise value (40 px, one of 9 looked at)
constexpr double kLeastScale = 0.001;   // m, of the robust fit
constexpr int kFewestFloorCells = 4, kRounds = 12;
constexpr int kShifts = 6;            // of the window to its mean: the deepest mode of noise lies too deep
constexpr double kLeastTrust = 0.03;  // of the priors: see the header

constexpr int kUnknowns = 11;  // twist of the bin in B (translation, rotation), the bias, how far out all walls seem
using Row = Eigen::Matrix<double, kUnknowns, 1>;
using Information = Eigen::Matrix<double, kUnknowns, kUnknowns>;

/// The deepest clear mode of a cell's distances, on a histogram smoothed over `sigma`.
double deepest_mode(const std::vector<int>& histogram, double reach, double sigma) {
  const int bins = static_cast<int>(histogram.size());
  const int half = std::clamp(static_cast<int>(sigma / kBinWidth), 1, 8);
  std::vector<double> smooth(histogram.size(), 0.0);
  for (int b = 0; b < bins; ++b)
    for (int k = std::max(0, b - half); k <= std::min(bins - 1, b + half); ++k)
      smooth[b] += histogram[k] * (half + 1 - std::abs(k - b));
  const double most = *std::max_element(smooth.begin(), smooth.end());
  for (int b = 0; b < bins; ++b) {
    const double left = b > 0 ? smooth[b - 1] : 0, right = b + 1 < bins ? smooth[b + 1] : 0;
    if (smooth[b] >= kModeShare * most && smooth[b] >= left && smooth[b] >= right) return (b + 0.5) * kBinWidth - reach;
  }
  return 0;
}

/// Mean of the members within a window of a distance.
FaceSample mean_about(const std::vector<const FaceSample*>& members, double distance, double window) {
  FaceSample mean;
  mean.n = 0;
  mean.face = members[0]->face;
  for (const FaceSample* s : members) {
    if (std::abs(s->distance - distance) > window) continue;
    mean.distance += s->distance, mean.p_B += s->p_B, mean.per_depth += s->per_depth;
    mean.u += s->u, mean.v += s->v, mean.z += s->z;
    ++mean.n;
  }
  if (mean.n == 0) return mean;
  const double n = mean.n;
  mean.distance /= n, mean.p_B /= n, mean.per_depth /= n, mean.u /= n, mean.v /= n, mean.z /= n;
  return mean;
}

/// What one cell says: distance = row . unknowns + noise.
struct Equation {
  Row row = Row::Zero();
  double distance = 0, sigma = 0;
  bool floor = false;
};

/// A bin that really stands at X_CB exp(t, w): its faces lie n . (t + w x p) inwards of the believed ones. A bias b
/// makes the depth wrong by dz = -z^2 b.
Row row_of(const Scene& scene, const BinFace& face, const FaceSample& mean) {
  Row row;
  const Eigen::Vector3d turn = mean.p_B.cross(face.normal_B);
  row.head<3>() = face.normal_B;
  row.segment<3>(3) = turn;
  const double half = scene.camera.width / 2.0;
  const double x = (mean.u - scene.camera.cx) / half, y = (mean.v - scene.camera.cy) / half;
  row.segment<4>(6) = -mean.per_depth * mean.z * mean.z * Eigen::Vector4d(1, x, y, x * x + y * y);
  row[10] = mean.face > 0 ? 1 : 0;
  return row;
}

std::vector<Equation> equations_of(const Scene& scene, const std::vector<FaceSample>& samples,
                                   const std::array<BinFace, kFaces>& faces, double reach) {
  const int cells = faces.back().first_cell + faces.back().columns * faces.back().rows;
  std::vector<std::vector<const FaceSample*>> of_cell(static_cast<std::size_t>(cells));
  for (const FaceSample& s : samples) of_cell[static_cast<std::size_t>(s.cell)].push_back(&s);
  std::vector<Equation> equations;
  for (const auto& members : of_cell) {
    if (members.size() < static_cast<std::size_t>(kFewestPixels)) continue;
    const double noise = std::max(kBinWidth, std::abs(members[0]->per_depth) * scene.noise.sigma(members[0]->z));
    std::vector<int> histogram(static_cast<std::size_t>(2 * reach / kBinWidth) + 1, 0);
    for (const FaceSample* s : members) ++histogram[static_cast<std::size_t>((s->distance + reach) / kBinWidth)];
    const double mode = deepest_mode(histogram, reach, noise), window = std::max(0.002, 2 * noise);
    FaceSample mean = mean_about(members, mode, window);
    for (int round = 0; round < kShifts && mean.n > 0; ++round) mean = mean_about(members, mean.distance, window);
    if (mean.n < kFewestPixels) continue;
    Equation e;
    e.floor = members[0]->face == 0;
    e.row = row_of(scene, faces[members[0]->face], mean);
    e.distance = mean.distance;
    e.sigma = std::sqrt(kSystematic * kSystematic + noise * noise * kCorrelated / mean.n);
    equations.push_back(e);
  }
  return equations;
}

/// Standard deviations of the unknowns before anything is seen. `trust`: share of the stated ones for the pose.
Row prior_sigmas(const Scene& scene, const BinLocalisationConfig& config, double trust) {
  const double z = scene.X_CB.translation().z(), per_metre = 1 / (z * z);
  Row sigma;
  sigma.head<3>().setConstant(trust * config.position_sigma);
  sigma.segment<3>(3).setConstant(trust * config.angle_sigma);
  sigma.segment<4>(6) << config.bias_sigma, config.tilt_sigma, config.tilt_sigma, config.bowl_sigma;
  sigma.segment<4>(6) *= per_metre;
  sigma[10] = kWallSigma;
  return sigma;
}

struct Solution {
  Row unknowns = Row::Zero();
  std::vector<double> weights;
};

/// Iteratively reweighted: Geman-McClure, twice as strict inwards, where parts lie, as outwards.
Solution solve(const std::vector<Equation>& equations, const Row& prior) {
  Solution s;
  s.weights.assign(equations.size(), 1.0);
  for (int round = 0; round < kRounds; ++round) {
    Information A = prior.cwiseAbs2().cwiseInverse().asDiagonal();
    Row b = Row::Zero();
    for (std::size_t i = 0; i < equations.size(); ++i) {
      const Equation& e = equations[i];
      const double w = s.weights[i] / (e.sigma * e.sigma);
      A += w * e.row * e.row.transpose();
      b += w * e.distance * e.row;
    }
    s.unknowns = A.ldlt().solve(b);
    const double narrowing = std::max(1.0, 4.0 - round);  // from wide to narrow: the start is the believed pose
    for (std::size_t i = 0; i < equations.size(); ++i) {
      const double left = equations[i].distance - equations[i].row.dot(s.unknowns);
      const double scale = narrowing * std::max(kLeastScale, 3 * equations[i].sigma) * (left > 0 ? 1 : 2);
      const double x = left / scale;
      s.weights[i] = 1 / ((1 + x * x) * (1 + x * x));
    }
  }
  return s;
}

/// How far the bin was found off in what the walls show, in multiples of the stated standard deviations.
double surprise(const Row& unknowns, const BinLocalisationConfig& config) {
  return std::max({std::abs(unknowns[0]) / config.position_sigma, std::abs(unknowns[1]) / config.position_sigma,
                   std::abs(unknowns[5]) / config.angle_sigma});
}

/// The wave in what is left of the walls' samples.
DisparityRipple ripple_on_walls(const Scene& scene, const std::vector<FaceSample>& samples,
                                const std::array<BinFace, kFaces>& faces, const Row& found, double sigma) {
  const double fB = scene.noise.focal_baseline;
  std::vector<RippleSample> seen;
  for (const FaceSample& s : samples) {
    if (s.face == 0) continue;
    const double per_px = -s.per_depth * s.z * s.z / fB;  // m of distance
    const double left = s.distance - row_of(scene, faces[s.face], s).dot(found);
    const double noise = std::max(kBinWidth, std::abs(s.per_depth) * scene.noise.sigma(s.z));
    const double z = s.z - left / s.per_depth;  // that the face would be seen at: free of the pixel's own noise
    seen.push_back({s.face - 1, fB / z, left / per_px, noise / std::abs(per_px)});
  }
  return fit_ripple(seen, kFaces - 1, fB, sigma);
}

/// First with the priors as stated, then as far as what the walls show bears them out; false when too little is seen.
bool fit_cells(const Scene& scene, const std::vector<Equation>& equations, const BinLocalisationConfig& config,
               Row& unknowns, LocatedBin& out) {
  out.floor_cells = out.wall_cells = 0;
  for (const Equation& e : equations) (e.floor ? out.floor_cells : out.wall_cells) += 1;
  if (out.floor_cells < kFewestFloorCells) return false;
  const Solution wide = solve(equations, prior_sigmas(scene, config, 1));
  const double trust = std::clamp(surprise(wide.unknowns, config), kLeastTrust, 1.0);
  unknowns = solve(equations, prior_sigmas(scene, config, trust)).unknowns;
  return true;
}

}  // namespace

void BinLocalisationConfig::visit(ConfigVisitor& v) {
  v.field("enabled", enabled, "find the bin's pose and the sensor's bias from floor and walls in view");
  v.field("position_sigma", position_sigma, Unit::kLength, "standard deviation of the believed position, each axis");
  v.field("angle_sigma", angle_sigma, Unit::kAngle, "standard deviation of the believed orientation, each axis");
  v.field("bias_sigma", bias_sigma, Unit::kLength, "of the sensor's constant disparity bias, as depth at the floor");
  v.field("tilt_sigma", tilt_sigma, Unit::kLength, "of a bias that tilts over the image, at the floor and the edge");
  v.field("bowl_sigma", bowl_sigma, Unit::kLength, "of a bias that bends over the image, at the floor and the edge");
  v.field("ripple_sigma", ripple_sigma, Unit::kNone, "of a ripple of the disparity, px, read off the walls; 0: none");
  v.field("reach", reach, Unit::kLength, "distances from the believed floor and walls that are looked at");
}

void BinLocalisationConfig::validate() const {
  const auto good = [](double x, double most) { return x > 0 && x <= most; };
  if (!good(position_sigma, 0.1) || !good(bias_sigma, 0.1) || !good(tilt_sigma, 0.1) || !good(bowl_sigma, 0.1))
    throw SpecError("bin.position_sigma, bias_sigma, tilt_sigma, bowl_sigma: must lie between 0 and 100 mm");
  if (!good(angle_sigma, 0.2)) throw SpecError("bin.angle_sigma: must lie between 0 and 0.2 rad");
  if (!(ripple_sigma >= 0 && ripple_sigma <= 1)) throw SpecError("bin.ripple_sigma: must lie between 0 and 1 px");
  if (!(reach >= 0.005 && reach <= 0.1)) throw SpecError("bin.reach: must lie between 5 and 100 mm");
}

LocatedBin locate_bin(const Scene& scene, const BinLocalisationConfig& config) {
  LocatedBin out;
  out.X_CB = scene.X_CB;
  const std::array<BinFace, kFaces> faces = faces_of(*scene.bin);
  std::vector<FaceSample> samples = samples_of(scene, scene.X_CB, faces, config.reach);
  Row found;
  if (!fit_cells(scene, equations_of(scene, samples, faces, config.reach), config, found, out)) return out;
  if (scene.noise.focal_baseline > 0 && config.ripple_sigma > 0) {
    out.ripple = ripple_on_walls(scene, samples, faces, found, config.ripple_sigma);
    for (FaceSample& s : samples) s.distance += s.per_depth * s.z * s.z * out.ripple.at(s.z);
    // What lay at the edge of the reach may lie beyond it now, where the cells' histograms end.
    std::erase_if(samples, [&](const FaceSample& s) { return !(std::abs(s.distance) < config.reach); });
    if (!fit_cells(scene, equations_of(scene, samples, faces, config.reach), config, found, out)) return out;
  }
  out.found = true;
  out.X_CB = scene.X_CB * exp_se3(found.head<6>());
  out.bias = {found[6], found[7], found[8], found[9]};
  return out;
}

}  // namespace binpick

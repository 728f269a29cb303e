#include "perception/bin_localisation.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/error.hpp"

namespace binpick {
namespace {

constexpr int kEvery = 9;               // px: one of so many is looked at, every column and every row alike
constexpr double kCell = 0.05;          // m, about, edge of a cell
constexpr double kMargin = 0.010;       // m off the edges of a face: farther than the bin may be off
constexpr double kBinWidth = 0.0005;    // m, of a histogram
constexpr int kFewestPixels = 12;       // in the mode of a cell
constexpr double kModeShare = 0.25;     // of a cell's highest mode: a deeper one this high is the face
constexpr double kSystematic = 0.0003;  // m, of a cell: what averaging does not remove
constexpr double kCorrelated = 5;       // pixels of a cell that share one noise value (40 px, one of 9 looked at)
constexpr double kLeastScale = 0.001;   // m, of the robust fit
constexpr int kFewestFloorCells = 4, kRounds = 12;
constexpr int kFaces = 5;             // floor, walls at -x, +x, -y, +y
constexpr double kLeastTrust = 0.03;  // of the priors: see the header

constexpr int kUnknowns = 10;  // twist of the bin in B (translation, rotation), then the bias
using Row = Eigen::Matrix<double, kUnknowns, 1>;
using Information = Eigen::Matrix<double, kUnknowns, kUnknowns>;

struct Face {
  Eigen::Vector3d normal_B;  // inwards
  double offset = 0;         // normal . p = offset on the face
  int along = 0, up = 1;     // axes of B that span it
  Eigen::Vector2d low, high;
  int columns = 1, rows = 1, first_cell = 0;
};

std::array<Face, kFaces> faces_of(const BinSpec& bin) {
  const Eigen::Vector3d half = bin.inner_size / 2;
  std::array<Face, kFaces> faces;
  faces[0] = {Eigen::Vector3d::UnitZ(), 0, 0, 1, {-half.x(), -half.y()}, {half.x(), half.y()}};
  for (int k = 1; k < kFaces; ++k) {
    const int axis = (k - 1) / 2, other = 1 - axis;
    const double inwards = k % 2 == 1 ? 1 : -1;
    faces[k] = {inwards * Eigen::Vector3d::Unit(axis), -half[axis], other, 2, {-half[other], 0},
                {half[other], bin.inner_size.z()}};
  }
  int first = 0;
  for (Face& f : faces) {
    f.columns = std::max(1, static_cast<int>(std::lround((f.high.x() - f.low.x()) / kCell)));
    f.rows = std::max(1, static_cast<int>(std::lround((f.high.y() - f.low.y()) / kCell)));
    f.first_cell = first;
    first += f.columns * f.rows;
  }
  return faces;
}

/// A pixel on a face, as believed.
struct Sample {
  int face = -1, cell = 0;
  double distance = 0;  // m, of the seen point from the face, inwards
  Eigen::Vector3d p_B = Eigen::Vector3d::Zero();
  double per_depth = 0;  // change of the distance with the depth
  double u = 0, v = 0, z = 0;
};

/// Which face the ray of a pixel meets first, well inside its edges.
Sample sample_at(const Scene& scene, const Pose& X_BC, const std::array<Face, kFaces>& faces, int u, int v) {
  Sample s;
  const float seen = scene.depth(u, v);
  if (!(seen > 0)) return s;
  const Eigen::Vector3d ray_B = X_BC.linear() * scene.camera.ray(u, v);
  const Eigen::Vector3d& eye_B = X_BC.translation();
  double nearest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kFaces; ++k) {
    const double along = faces[k].normal_B.dot(ray_B);
    if (!(along < 0)) continue;  // from behind
    const double z = (faces[k].offset - faces[k].normal_B.dot(eye_B)) / along;
    if (!(z > 0) || z >= nearest) continue;
    nearest = z;
    s.face = k;
  }
  if (s.face < 0) return s;
  const Face& f = faces[s.face];
  const Eigen::Vector3d hit = eye_B + nearest * ray_B;
  const Eigen::Vector2d place(hit[f.along], hit[f.up]);
  const Eigen::Vector2d share = (place - f.low).cwiseQuotient(f.high - f.low);
  if (((place - f.low).array() < kMargin).any() || ((f.high - place).array() < kMargin).any()) {
    s.face = -1;
    return s;
  }
  s.cell = f.first_cell + static_cast<int>(share.y() * f.rows) * f.columns + static_cast<int>(share.x() * f.columns);
  s.p_B = eye_B + static_cast<double>(seen) * ray_B;
  s.distance = f.normal_B.dot(s.p_B) - f.offset;
  s.per_depth = f.normal_B.dot(ray_B);
  s.u = u, s.v = v, s.z = seen;
  return s;
}

std::vector<Sample> samples_of(const Scene& scene, const Pose& X_CB, const std::array<Face, kFaces>& faces,
                               double reach) {
  std::vector<Sample> samples;
  const Pose X_BC = X_CB.inverse();
  for (int v = 0; v < scene.depth.height(); ++v)
    for (int u = 4 * v % kEvery; u < scene.depth.width(); u += kEvery) {
      const Sample s = sample_at(scene, X_BC, faces, u, v);
      if (s.face >= 0 && std::abs(s.distance) < reach) samples.push_back(s);
    }
  return samples;
}

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

/// What one cell says: distance = row . unknowns + noise.
struct Equation {
  Row row = Row::Zero();
  double distance = 0, sigma = 0;
  bool floor = false;
};

/// A bin that really stands at X_CB exp(t, w): its faces lie n . (t + w x p) inwards of the believed ones. A bias b
/// makes the depth wrong by dz = -z^2 b.
Row row_of(const Scene& scene, const Face& face, const Sample& mean) {
  Row row;
  const Eigen::Vector3d turn = mean.p_B.cross(face.normal_B);
  row.head<3>() = face.normal_B;
  row.segment<3>(3) = turn;
  const double half = scene.camera.width / 2.0;
  const double x = (mean.u - scene.camera.cx) / half, y = (mean.v - scene.camera.cy) / half;
  row.tail<4>() = -mean.per_depth * mean.z * mean.z * Eigen::Vector4d(1, x, y, x * x + y * y);
  return row;
}

std::vector<Equation> equations_of(const Scene& scene, const std::vector<Sample>& samples,
                                   const std::array<Face, kFaces>& faces, double reach) {
  const int cells = faces.back().first_cell + faces.back().columns * faces.back().rows;
  std::vector<std::vector<const Sample*>> of_cell(static_cast<std::size_t>(cells));
  for (const Sample& s : samples) of_cell[static_cast<std::size_t>(s.cell)].push_back(&s);
  std::vector<Equation> equations;
  for (const auto& members : of_cell) {
    if (members.size() < static_cast<std::size_t>(kFewestPixels)) continue;
    const double noise = std::max(kBinWidth, std::abs(members[0]->per_depth) * scene.noise.sigma(members[0]->z));
    std::vector<int> histogram(static_cast<std::size_t>(2 * reach / kBinWidth) + 1, 0);
    for (const Sample* s : members) ++histogram[static_cast<std::size_t>((s->distance + reach) / kBinWidth)];
    const double mode = deepest_mode(histogram, reach, noise), window = std::max(0.002, 2 * noise);
    Sample mean;
    int n = 0;
    for (const Sample* s : members) {
      if (std::abs(s->distance - mode) > window) continue;
      mean.distance += s->distance, mean.p_B += s->p_B, mean.per_depth += s->per_depth;
      mean.u += s->u, mean.v += s->v, mean.z += s->z;
      ++n;
    }
    if (n < kFewestPixels) continue;
    mean.distance /= n, mean.p_B /= n, mean.per_depth /= n, mean.u /= n, mean.v /= n, mean.z /= n;
    Equation e;
    e.floor = members[0]->face == 0;
    e.row = row_of(scene, faces[members[0]->face], mean);
    e.distance = mean.distance;
    e.sigma = std::sqrt(kSystematic * kSystematic + noise * noise * kCorrelated / n);
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
  sigma.tail<4>() << config.bias_sigma, config.tilt_sigma, config.tilt_sigma, config.bowl_sigma;
  sigma.tail<4>() *= per_metre;
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

}  // namespace

void BinLocalisationConfig::visit(ConfigVisitor& v) {
  v.field("enabled", enabled, "find the bin's pose and the sensor's bias from floor and walls in view");
  v.field("position_sigma", position_sigma, Unit::kLength, "standard deviation of the believed position, each axis");
  v.field("angle_sigma", angle_sigma, Unit::kAngle, "standard deviation of the believed orientation, each axis");
  v.field("bias_sigma", bias_sigma, Unit::kLength, "of the sensor's constant disparity bias, as depth at the floor");
  v.field("tilt_sigma", tilt_sigma, Unit::kLength, "of a bias that tilts over the image, at the floor and the edge");
  v.field("bowl_sigma", bowl_sigma, Unit::kLength, "of a bias that bends over the image, at the floor and the edge");
  v.field("reach", reach, Unit::kLength, "distances from the believed floor and walls that are looked at");
}

void BinLocalisationConfig::validate() const {
  const auto good = [](double x, double most) { return x > 0 && x <= most; };
  if (!good(position_sigma, 0.1) || !good(bias_sigma, 0.1) || !good(tilt_sigma, 0.1) || !good(bowl_sigma, 0.1))
    throw SpecError("bin.position_sigma, bias_sigma, tilt_sigma, bowl_sigma: must lie between 0 and 100 mm");
  if (!good(angle_sigma, 0.2)) throw SpecError("bin.angle_sigma: must lie between 0 and 0.2 rad");
  if (!(reach >= 0.005 && reach <= 0.1)) throw SpecError("bin.reach: must lie between 5 and 100 mm");
}

LocatedBin locate_bin(const Scene& scene, const BinLocalisationConfig& config) {
  LocatedBin out;
  out.X_CB = scene.X_CB;
  const std::array<Face, kFaces> faces = faces_of(*scene.bin);
  const std::vector<Equation> equations =
      equations_of(scene, samples_of(scene, scene.X_CB, faces, config.reach), faces, config.reach);
  for (const Equation& e : equations) (e.floor ? out.floor_cells : out.wall_cells) += 1;
  if (out.floor_cells < kFewestFloorCells) return out;
  const Solution wide = solve(equations, prior_sigmas(scene, config, 1));
  const double trust = std::clamp(surprise(wide.unknowns, config), kLeastTrust, 1.0);
  const Row found = solve(equations, prior_sigmas(scene, config, trust)).unknowns;
  out.found = true;
  out.X_CB = scene.X_CB * exp_se3(found.head<6>());
  out.bias = {found[6], found[7], found[8], found[9]};
  return out;
}

}  // namespace binpick

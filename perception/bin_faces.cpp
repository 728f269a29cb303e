#include "perception/bin_faces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace binpick {
namespace {

constexpr int kEvery = 9;          // px: one of so many is looked at, every column and every row alike
constexpr double kCell = 0.05;     // m, about, edge of a cell
constexpr double kMargin = 0.010;  // m off the edges of a face: farther than the bin may be off

/// Which face the ray of a pixel meets first, well inside its edges.
FaceSample sample_at(const Scene& scene, const Pose& X_BC, const std::array<BinFace, kFaces>& faces, int u, int v) {
  FaceSample s;
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
  const BinFace& f = faces[s.face];
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

}  // namespace

std::array<BinFace, kFaces> faces_of(const BinSpec& bin) {
  const Eigen::Vector3d half = bin.inner_size / 2;
  std::array<BinFace, kFaces> faces;
  faces[0] = {Eigen::Vector3d::UnitZ(), 0, 0, 1, {-half.x(), -half.y()}, {half.x(), half.y()}};
  for (int k = 1; k < kFaces; ++k) {
    const int axis = (k - 1) / 2, other = 1 - axis;
    const double inwards = k % 2 == 1 ? 1 : -1;
    // A wall that leans faces upwards as well, and its plane holds the edge of the floor.
    const Eigen::Vector3d normal_B =
        std::cos(bin.draft) * inwards * Eigen::Vector3d::Unit(axis) + std::sin(bin.draft) * Eigen::Vector3d::UnitZ();
    faces[k] = {normal_B,          -std::cos(bin.draft) * half[axis], other, 2,
                {-half[other], 0}, {half[other], bin.inner_size.z()}};
  }
  int first = 0;
  for (BinFace& f : faces) {
    f.columns = std::max(1, static_cast<int>(std::lround((f.high.x() - f.low.x()) / kCell)));
    f.rows = std::max(1, static_cast<int>(std::lround((f.high.y() - f.low.y()) / kCell)));
    f.first_cell = first;
    first += f.columns * f.rows;
  }
  return faces;
}

std::vector<FaceSample> samples_of(const Scene& scene, const Pose& X_CB, const std::array<BinFace, kFaces>& faces,
                                   double reach) {
  std::vector<FaceSample> samples;
  const Pose X_BC = X_CB.inverse();
  for (int v = 0; v < scene.depth.height(); ++v)
    for (int u = 4 * v % kEvery; u < scene.depth.width(); u += kEvery) {
      const FaceSample s = sample_at(scene, X_BC, faces, u, v);
      if (s.face >= 0 && std::abs(s.distance) < reach) samples.push_back(s);
    }
  return samples;
}

}  // namespace binpick

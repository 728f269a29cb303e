#include "perception/open_box.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>

#include "core/pose.hpp"

namespace binpick {
namespace {

constexpr double kTolerance = 0.004, kSigmas = 3;  // m and standard deviations: on a face
constexpr double kAligned = 0.92;                  // cosine, 23 degrees: noise of patches seen obliquely included
constexpr double kBeyond = 2;                      // tolerances behind a face
constexpr double kDraftSigma = 0.02;               // tangent, of a wall's draft before it is measured
constexpr double kScale = 0.002;                   // m, of the robust fit
constexpr int kRounds = 4;
constexpr int kUnknowns = 3 + kBoxFaces + 4;  // turn in H, offsets, slopes
using Row = Eigen::Matrix<double, kUnknowns, 1>;
using Information = Eigen::Matrix<double, kUnknowns, kUnknowns>;

const std::array<Eigen::Vector3d, 4> kInwards = {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(-1, 0, 0),
                                                 Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, -1, 0)};

double tolerance(const StatedNoise& noise, double z) { return std::max(kTolerance, kSigmas * noise.sigma(z)); }

/// d(distance) over turn, offset and slope of the patch's face.
Row row_of(const OpenBox& box, int face, const Eigen::Vector3d& q) {
  Row row = Row::Zero();
  row.head<3>() = q.cross(box.normal(face));
  row[3 + face] = 1;
  if (face > 0) row[3 + kBoxFaces + face - 1] = -(q.z() - box.floor);
  return row;
}

}  // namespace

Eigen::Vector3d OpenBox::normal(int face) const {
  return face == 0 ? Eigen::Vector3d::UnitZ()
                   : Eigen::Vector3d(kInwards[face - 1] + slope[face - 1] * Eigen::Vector3d::UnitZ());
}

BoxRays::BoxRays(const OpenBox& box) : R_HC_(box.R_CH.transpose()), rim_(box.floor + box.height) {
  for (int k = 0; k < kBoxFaces; ++k) {
    const Eigen::Vector3d normal = box.normal(k);
    normal_[k] = normal.normalized();
    level_[k] = box.level(k) / normal.norm();
    face_[k] = k == 0 || box.wall[k - 1];
    bound_[k] = k > 0 && (box.wall[k - 1] || box.edge[k - 1]);
  }
}

BoxRay BoxRays::of(const Surfel& surfel) const {
  BoxRay out;
  const Eigen::Vector3d q = R_HC_ * surfel.p;
  if (!(q.z() < 0)) return out;
  const double to_rim = rim_ < 0 ? rim_ / q.z() : 0;  // 0: the camera stands in the box
  double nearest = std::numeric_limits<double>::infinity(), along[kBoxFaces];
  for (int k = 0; k < kBoxFaces; ++k) {
    along[k] = normal_[k].dot(q);
    if (bound_[k] && to_rim > 0 && along[k] * to_rim < level_[k]) return {};  // not through the opening
    if (!face_[k] || !(along[k] < 0) || !(level_[k] < 0)) continue;           // from behind
    const double z = level_[k] / along[k];
    if (z < nearest) nearest = z, out.face = k;
  }
  for (int k = 1; k < kBoxFaces; ++k)
    if (bound_[k] && !face_[k] && along[k] * nearest < level_[k]) return {};  // out where a side is open
  if (out.face < 0) return out;
  out.distance = along[out.face] - level_[out.face];
  out.aligned = normal_[out.face].dot(R_HC_ * surfel.n);
  return out;
}

BoxSupport support_of(const OpenBox& box, std::span<const Surfel> surfels, const StatedNoise& noise) {
  BoxSupport out;
  const BoxRays rays(box);
  for (const Surfel& s : surfels) {
    const BoxRay ray = rays.of(s);
    if (ray.face < 0) continue;
    const double near = tolerance(noise, s.p.z());
    ++out.rays[ray.face];
    out.on[ray.face] += std::abs(ray.distance) < near && ray.aligned > kAligned;
    out.beyond += ray.distance < -kBeyond * near;
  }
  return out;
}

OpenBox fitted(OpenBox box, std::span<const Surfel> surfels, const StatedNoise& noise) {
  for (int round = 0; round < kRounds; ++round) {
    Information A = Information::Identity();  // m^-2 and rad^-2: next to nothing, where a face is not seen
    A.diagonal().tail<4>().setConstant(1 / (kDraftSigma * kDraftSigma));
    Row b = Row::Zero();
    const BoxRays rays(box);
    for (int k = 0; k < 4; ++k) b[3 + kBoxFaces + k] = -box.slope[k] / (kDraftSigma * kDraftSigma);
    for (const Surfel& s : surfels) {
      const BoxRay ray = rays.of(s);
      if (ray.face < 0 || ray.aligned < kAligned) continue;
      const double near = tolerance(noise, s.p.z());
      if (std::abs(ray.distance) > 2 * near) continue;
      // Twice as strict inwards, where parts lie on the floor and lean against walls (Geman, McClure).
      const double x = ray.distance / std::max(kScale, noise.sigma(s.p.z())) * (ray.distance > 0 ? 2 : 1);
      const double weight = 1 / ((1 + x * x) * (1 + x * x) * kScale * kScale);
      const Row row = row_of(box, ray.face, box.R_CH.transpose() * s.p);
      A += weight * row * row.transpose();
      b += weight * ray.distance * row;
    }
    const Row step = A.ldlt().solve(b);
    box.R_CH = box.R_CH * exp_so3(step.head<3>());
    box.floor += step[3];
    for (int k = 0; k < 4; ++k) {
      box.offset[k] += step[4 + k];
      box.slope[k] += step[3 + kBoxFaces + k];
    }
  }
  return box;
}

}  // namespace binpick

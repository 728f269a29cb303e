#include "evaluation/metrics_surface.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/check.hpp"
#include "core/mesh_properties.hpp"

namespace binpick {
namespace {

struct Moments {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
};

Moments of_points(const std::vector<Eigen::Vector3d>& points) {
  Moments moments;
  const double share = 1.0 / static_cast<double>(points.size());
  for (const Eigen::Vector3d& x : points) moments.center += share * x;
  for (const Eigen::Vector3d& x : points)
    moments.second += share * (x - moments.center) * (x - moments.center).transpose();
  return moments;
}

/// Exact for triangles: the mean of x x^T over one is (sum of v v^T + s s^T) / 12, s the sum of its corners.
Moments of_surface(const TriangleMesh& mesh) {
  const auto corners = [&](const std::array<std::uint32_t, 3>& t) {
    return std::array<Eigen::Vector3d, 3>{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
  };
  const auto area_of = [](const std::array<Eigen::Vector3d, 3>& v) {
    return 0.5 * (v[1] - v[0]).cross(v[2] - v[0]).norm();
  };
  Moments moments;
  double area = 0;
  for (const auto& t : mesh.triangles) {
    const auto v = corners(t);
    moments.center += area_of(v) / 3 * (v[0] + v[1] + v[2]);
    area += area_of(v);
  }
  if (!(area > 0)) return of_points(mesh.vertices);
  moments.center /= area;
  for (const auto& t : mesh.triangles) {
    auto v = corners(t);
    const double share = area_of(v) / area / 12;
    for (Eigen::Vector3d& x : v) x -= moments.center;
    const Eigen::Vector3d s = v[0] + v[1] + v[2];
    moments.second += share * s * s.transpose();
    for (const Eigen::Vector3d& x : v) moments.second += share * x * x.transpose();
  }
  return moments;
}

/// Badoiu and Clarkson 2003: step 1/(i+1) towards the farthest point; after i steps within 1/i of the least radius.
double ball_around(const std::vector<Eigen::Vector3d>& points) {
  constexpr int kSteps = 1500;
  Eigen::Vector3d center = points.front();
  double least = std::numeric_limits<double>::infinity();
  for (int i = 1; i <= kSteps; ++i) {
    std::pair<double, std::size_t> farthest{-1, 0};
    for (std::size_t k = 0; k < points.size(); ++k)
      farthest = std::max(farthest, {(points[k] - center).squaredNorm(), k});
    least = std::min(least, farthest.first);
    center += (points[farthest.second] - center) / (i + 1);
  }
  return 2 * std::sqrt(least);
}

}  // namespace

SurfaceDistance::SurfaceDistance(const TriangleMesh& mesh_P, const Symmetry& symmetry) : symmetry_(symmetry) {
  BP_CHECK(!mesh_P.vertices.empty());
  const Moments moments = of_surface(mesh_P);
  center_P_ = moments.center;
  moment_P_ = moments.second;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(moment_P_);
  root_P_ =
      axes.eigenvectors() * axes.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() * axes.eigenvectors().transpose();
  if (symmetry_.axis) {
    const Eigen::Vector3d& a = symmetry_.axis->direction_P;
    const double along = a.dot(moment_P_ * a);
    lambda_ = std::sqrt((moment_P_.trace() - along) / 2 + along);
  }
  ball_diameter_ = ball_around(hull_vertices(mesh_P));
}

double SurfaceDistance::between(const Pose& X_WP_1, const Pose& X_WP_2) const {
  if (symmetry_.center_P) return (X_WP_1 * center_P_ - X_WP_2 * center_P_).norm();
  double least = std::numeric_limits<double>::infinity();
  for (const Pose& member : symmetry_.finite) {
    const double shift = (X_WP_1 * center_P_ - X_WP_2 * (member * center_P_)).squaredNorm();
    double turn = 0;
    if (symmetry_.axis) {
      const Eigen::Vector3d& a = symmetry_.axis->direction_P;
      const Eigen::Vector3d apart = X_WP_1.linear() * a - X_WP_2.linear() * (member.linear() * a);
      turn = lambda_ * lambda_ * apart.squaredNorm();
    } else {
      turn = ((X_WP_1.linear() - X_WP_2.linear() * member.linear()) * root_P_).squaredNorm();
    }
    least = std::min(least, shift + turn);
  }
  return std::sqrt(least);
}

}  // namespace binpick

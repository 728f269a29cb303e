#include "core/lens_distortion.hpp"

#include <Eigen/LU>
#include <cmath>
#include <cstdio>

#include "core/error.hpp"

namespace binpick {
namespace {

constexpr double kLargestTangential = 0.05;  // beyond, no lens is meant
constexpr int kSteps = 4000;                 // of the search for a fold along the radius

double radial(const LensDistortion& d, double r) {
  const double s = r * r;
  return r * (1 + s * (d.k1 + s * (d.k2 + s * d.k3)));
}

double radial_slope(const LensDistortion& d, double r) {
  const double s = r * r;
  return 1 + s * (3 * d.k1 + s * (5 * d.k2 + s * 7 * d.k3));
}

/// Radius from the principal point of the image's farthest corner, on the plane z = 1, a pixel's half width added.
double corner_radius(const PinholeCamera& camera) {
  const double x = std::max(camera.cx, camera.width - 1 - camera.cx) + 0.5;
  const double y = std::max(camera.cy, camera.height - 1 - camera.cy) + 0.5;
  return std::hypot(x / camera.fx, y / camera.fy);
}

/// Ideal radius at which the radial map turns back before it has reached `seen`; 0 when it does not.
double fold_radius(const LensDistortion& d, double seen) {
  const double step = 2 * seen / kSteps;
  for (double r = step; r < 50 * seen; r += step) {
    if (radial(d, r) >= seen) return 0;
    if (radial_slope(d, r) <= 0) return r;
  }
  return 50 * seen;  // crawls without ever getting there: as good as a fold
}

}  // namespace

Eigen::Vector2d LensDistortion::distort(const Eigen::Vector2d& ideal) const {
  const double x = ideal.x(), y = ideal.y(), s = ideal.squaredNorm();
  const double m = 1 + s * (k1 + s * (k2 + s * k3));
  return {x * m + 2 * p1 * x * y + p2 * (s + 2 * x * x), y * m + p1 * (s + 2 * y * y) + 2 * p2 * x * y};
}

Eigen::Matrix2d LensDistortion::jacobian(const Eigen::Vector2d& ideal) const {
  const double x = ideal.x(), y = ideal.y(), s = ideal.squaredNorm();
  const double m = 1 + s * (k1 + s * (k2 + s * k3)), dm = 2 * (k1 + s * (2 * k2 + s * 3 * k3));  // dm = m'(r) / r
  Eigen::Matrix2d J;
  J(0, 0) = m + x * x * dm + 2 * p1 * y + 6 * p2 * x;
  J(0, 1) = x * y * dm + 2 * p1 * x + 2 * p2 * y;
  J(1, 0) = J(0, 1);
  J(1, 1) = m + y * y * dm + 6 * p1 * y + 2 * p2 * x;
  return J;
}

Eigen::Vector2d LensDistortion::undistort(const Eigen::Vector2d& seen) const {
  if (none()) return seen;
  // The radial part first: monotone inside the image, so Newton from the distorted radius, kept from overshooting.
  const double target = seen.norm();
  double r = target;
  for (int i = 0; i < 20; ++i) r -= std::clamp((radial(*this, r) - target) / radial_slope(*this, r), -0.5 * r, r);
  Eigen::Vector2d ideal = target > 0 ? Eigen::Vector2d(seen * (r / target)) : seen;
  for (int i = 0; i < 10; ++i) {
    const Eigen::Vector2d error = distort(ideal) - seen;
    if (error.squaredNorm() < 1e-28) break;
    ideal -= jacobian(ideal).inverse() * error;
  }
  return ideal;
}

void LensDistortion::visit(ConfigVisitor& v) {
  v.field("k1", k1, Unit::kNone, "radial, times r^2; negative: barrel");
  v.field("k2", k2, Unit::kNone, "radial, times r^4");
  v.field("p1", p1, Unit::kNone, "tangential, along y");
  v.field("p2", p2, Unit::kNone, "tangential, along x");
  v.field("k3", k3, Unit::kNone, "radial, times r^6");
}

void LensDistortion::validate(const PinholeCamera& camera) const {
  for (const double value : {k1, k2, p1, p2, k3})
    if (!std::isfinite(value)) throw SpecError("lens: k1, k2, p1, p2 and k3 must be numbers");
  if (std::abs(p1) > kLargestTangential || std::abs(p2) > kLargestTangential)
    throw SpecError("lens: p1 and p2 must lie between -0.05 and 0.05");
  if (none()) return;
  const double fold = fold_radius(*this, corner_radius(camera));
  char text[200];
  if (fold > 0) {
    std::snprintf(text, sizeof text,
                  "lens: the distortion folds at radius %.3f (x/z), %.0f px from the principal point, inside the image "
                  "whose corner lies at %.0f px",
                  fold, radial(*this, fold) * camera.fx, corner_radius(camera) * camera.fx);
    throw SpecError(text);
  }
  for (int j = 0; j <= 32; ++j)  // the tangential terms could still fold it
    for (int i = 0; i <= 32; ++i) {
      const double u = (camera.width - 1) * i / 32.0, w = (camera.height - 1) * j / 32.0;
      const Eigen::Vector2d seen = camera.ray(u, w).head<2>(), ideal = undistort(seen);
      if ((distort(ideal) - seen).norm() < 1e-10 && jacobian(ideal).determinant() > 0) continue;
      std::snprintf(text, sizeof text, "lens: p1 and p2 fold the image near pixel (%.0f, %.0f)", u, w);
      throw SpecError(text);
    }
}

Eigen::Vector2d project(const PinholeCamera& camera, const LensDistortion& lens, const Eigen::Vector3d& p_C) {
  const Eigen::Vector2d seen = lens.distort(p_C.head<2>() / p_C.z());
  return {camera.fx * seen.x() + camera.cx, camera.fy * seen.y() + camera.cy};
}

Eigen::Vector3d ray(const PinholeCamera& camera, const LensDistortion& lens, double u, double v) {
  const Eigen::Vector2d ideal = lens.undistort(camera.ray(u, v).head<2>());
  return {ideal.x(), ideal.y(), 1};
}

}  // namespace binpick

// How much light a surface sends from one direction into another: Lambert plus one Blinn-Phong lobe, both with the
// surface's own shares (core/material.hpp). The lobe's factor (n + 8) / (8 pi) keeps the light it returns near its
// share for every width; there is no Fresnel term and no shadowing of rough facets.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/material.hpp"

namespace binpick {

/// Reflected radiance per unit of irradiance measured across the beam (1/sr): f_r cos t, with t between `n` and
/// `to_light`. All unit vectors; zero when the light is behind the surface.
inline double reflectance(const Material& m, const Eigen::Vector3d& n, const Eigen::Vector3d& to_light,
                          const Eigen::Vector3d& to_eye) {
  const double cosine = n.dot(to_light);
  if (cosine <= 0) return 0;
  double f = m.albedo / std::numbers::pi;
  if (m.specular > 0) {
    const double exponent = std::max(2 / (m.roughness * m.roughness) - 2, 0.0);
    const double half = n.dot((to_light + to_eye).normalized());
    // cos^n is below 1e-7 where n (1 - cos) > 16: most pixels need no power.
    if (half > 0 && exponent * (1 - half) < 16)
      f += m.specular * (exponent + 8) / (8 * std::numbers::pi) * std::pow(half, exponent);
  }
  return f * cosine;
}

/// Radiance per unit of irradiance from all around.
inline double ambient_reflectance(const Material& m) { return (m.albedo + m.specular) / std::numbers::pi; }

}  // namespace binpick

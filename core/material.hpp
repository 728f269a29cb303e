// How a surface returns light: what a camera of any kind needs to know of a part, a bin or a tool.
#pragma once

#include "core/config.hpp"
#include "core/error.hpp"

namespace binpick {

/// Diffuse (Lambert) reflectance plus one mirror-like lobe (Blinn-Phong, exponent 2 / roughness^2 - 2). Machined metal:
/// albedo 0.25, specular 0.4, roughness 0.35 or so (untuned: no public measurement was found, physical_models A3.5).
struct Material {
  double albedo = 0.6;     ///< share of the light returned diffusely, 0 .. 1
  double specular = 0;     ///< share returned in the lobe, 0 .. 1
  double roughness = 0.3;  ///< width of the lobe, 0.02 .. 1

  bool operator==(const Material&) const = default;
  void visit(ConfigVisitor& v) {
    v.field("albedo", albedo, Unit::kNone, "share of the light returned diffusely");
    v.field("specular", specular, Unit::kNone, "share of the light returned in a mirror-like lobe");
    v.field("roughness", roughness, Unit::kNone, "width of the lobe: 0.02 polished .. 1 matt");
  }
  void validate() const {
    if (!(albedo >= 0 && specular >= 0 && albedo + specular <= 1))
      throw SpecError("surface: albedo and specular must not be negative, and together at most 1");
    if (!(roughness >= 0.02 && roughness <= 1)) throw SpecError("surface: roughness must lie between 0.02 and 1");
  }
};

}  // namespace binpick

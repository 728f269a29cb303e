// A mesh file on its way to a part: byte checks, importer, repair, hull and mass.
#pragma once

#include "core/part.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace binpick::fuzz {

/// The mass is stated, so that an open mesh gets a hull; symmetry is not searched, which takes time and reads no file.
inline void read_as_part(const std::string& path, const std::string& unit, bool pieces) {
  PartSpec spec;
  spec.mesh = path;
  if (pieces) spec.pieces = path;
  spec.unit = unit;
  spec.mass = 0.1;
  spec.symmetry.type = "none";
  accepts(path, [&] { load_part(spec); });
}

}  // namespace binpick::fuzz

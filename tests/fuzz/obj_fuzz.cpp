// OBJ bytes, as a part's mesh and as its convex pieces.
#include "tests/fuzz/mesh_fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const binpick::fuzz::InputFile file("input.obj");
  binpick::fuzz::read_as_part(file.put(data, size), "mm", true);
  return 0;
}

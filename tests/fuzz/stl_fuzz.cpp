// STL bytes.
#include "tests/fuzz/mesh_fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const binpick::fuzz::InputFile file("input.stl");
  binpick::fuzz::read_as_part(file.put(data, size), "mm", false);
  return 0;
}

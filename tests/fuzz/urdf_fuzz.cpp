// A URDF as an arm, up to its joints, shapes and closed form.
#include "robot/arm.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const binpick::fuzz::InputFile file("input.urdf");
  const std::string& path = file.put(data, size);
  binpick::fuzz::accepts(path, [&] {
    const binpick::Arm arm = binpick::Arm::load(path);
    if (!arm.forward(binpick::Vector6d::Zero()).matrix().allFinite())
      binpick::fuzz::finding("a flange that is nowhere", path);
  });
  return 0;
}

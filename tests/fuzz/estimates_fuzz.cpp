// The table of poses that an external estimator answers.
#include "perception/estimates_csv.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace {

/// A part without a symmetry and one with an axis: estimates_csv asks for nothing else of them.
std::vector<binpick::Part> two_parts() {
  std::vector<binpick::Part> parts(2);
  parts[1].symmetry.axis = binpick::Symmetry::Axis{};
  return parts;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const binpick::fuzz::InputFile file("estimates.csv");
  static const std::vector<binpick::Part> parts = two_parts();
  const std::string& path = file.put(data, size);
  binpick::fuzz::accepts(path, [&] {
    for (const binpick::PoseEstimate& e : binpick::read_estimates_csv(path, parts))
      if (!binpick::is_rigid(e.X_CP, 1e-9) || !e.covariance.allFinite())
        binpick::fuzz::finding("an estimate without a pose", path);
  });
  return 0;
}

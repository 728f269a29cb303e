// Estimates in BOP's results file, which anybody's program may have written.
#include "evaluation/bop_results.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const binpick::fuzz::InputFile file("results.csv");
  const std::string& path = file.put(data, size);
  binpick::fuzz::accepts(path, [&] {
    for (const binpick::BopEstimate& e : binpick::read_bop_results(path))
      if (!binpick::is_rigid(e.X_CO, 1e-9) || e.scene < 0 || e.image < 0 || e.object < 0)
        binpick::fuzz::finding("an estimate without a pose", path);
  });
  return 0;
}

#include "tools/validate/calibration_bench.hpp"

namespace binpick {

CalibrationBench::CalibrationBench(std::uint64_t first_seed, int draws)
    : first_(first_seed), draws_(draws), scenario_(read_scenario("scenes/bearing_bin.yaml", {"ideal"})) {
  setup_ = calibration_setup(scenario_.cell, {kPoses});
}

CalibrationSpread CalibrationBench::spread(const CalibrationErrors& errors, CalibrationMethod method) const {
  return calibration_spread(setup_, errors, method, first_, draws_);
}

}  // namespace binpick

#include "tools/validate/calibration_bench.hpp"

#include <cmath>

namespace binpick {

PinholeCamera flange_grey_camera() { return {1280, 720, 920, 920, 639.5, 359.5}; }

CalibrationBench::CalibrationBench(std::uint64_t first_seed, int draws)
    : first_(first_seed), draws_(draws), scenario_(read_scenario("scenes/bearing_bin.yaml", {"ideal"})) {
  setup_ = calibration_setup(scenario_.cell, flange_grey_camera(), kPoses);
}

CalibrationBench::Spread CalibrationBench::spread(const CalibrationErrors& errors, CalibrationMethod method) const {
  Spread squares;
  for (int k = 0; k < draws_; ++k) {
    const CalibrationError e = calibration_error(setup_, errors, method, Seed{first_ + static_cast<std::uint64_t>(k)});
    squares.shift += e.shift * e.shift / draws_;
    squares.turn += e.turn * e.turn / draws_;
    squares.tip += e.tip * e.tip / draws_;
    squares.tip_turn += e.tip_turn * e.tip_turn / draws_;
  }
  return {std::sqrt(squares.shift), std::sqrt(squares.turn), std::sqrt(squares.tip), std::sqrt(squares.tip_turn)};
}

}  // namespace binpick

// V-D1..V-D4: what a plate's pose, the paper's chain and hand-eye calibration are worth (physical_models D).
#pragma once

#include <cstdint>
#include <vector>

#include "tools/validate/verdict.hpp"
#include "trials/calibration/calibration_trial.hpp"
#include "trials/scenario.hpp"

namespace binpick {

class CalibrationBench {
 public:
  static constexpr int kFullDraws = 1000;
  static constexpr int kPoses = 15;  ///< of the hand-eye calibration

  CalibrationBench(std::uint64_t first_seed, int draws);

  std::uint64_t first() const { return first_; }
  int draws() const { return draws_; }
  const CalibrationSetup& setup() const { return setup_; }
  CalibrationSpread spread(const CalibrationErrors& errors, CalibrationMethod method) const;
  std::vector<Verdict>& verdicts() { return verdicts_; }

 private:
  std::uint64_t first_;
  int draws_;
  Scenario scenario_;
  CalibrationSetup setup_;
  std::vector<Verdict> verdicts_;
};

void check_plate_pose(CalibrationBench& bench);   ///< V-D1
void check_chain(CalibrationBench& bench);        ///< V-D2
void report_pick_error(CalibrationBench& bench);  ///< V-D3
void check_hand_eye(CalibrationBench& bench);     ///< V-D4

}  // namespace binpick

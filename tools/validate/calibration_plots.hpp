// How far off a calibrated camera is: over corner noise, number of looks and range, and split by source.
#pragma once

#include <cstdint>
#include <string>

#include "trials/calibration/calibration_trial.hpp"

namespace binpick {

/// Curves of the calibrations of seeds first_seed .. first_seed + draws - 1 in a cell, as PNG where gnuplot is
/// installed: false when it is not. Places that the arm cannot reach are left out. Throws StorageError.
bool plot_calibration(const Cell& cell, const CalibrationErrors& errors, std::uint64_t first_seed, int draws,
                      const std::string& folder);

}  // namespace binpick

// Heat maps of a sweep as a picture: two factors' levels, the share in each field in colour and in figures.
#pragma once

#include "core/image.hpp"
#include "core/image_io.hpp"
#include "evaluation/sweep_figures.hpp"

namespace binpick {

/// Map `first` of the result's heat maps and those that follow it with the same factors (by level of a third), side by
/// side on one scale. Colours of the scale `cividis`, which grows lighter throughout: colour-blind safe, readable in
/// grey.
Image<Rgb> heat_map_picture(const SweepResult& result, std::size_t first);

/// Writes a picture for every pair of factors, `report.html` that shows them, `sweep.json`, `sweep.md`, `cells.csv` and
/// `factors.csv` into the sweep's folder. Throws StorageError.
void write_sweep_files(const SweepResult& result, const std::string& folder);

}  // namespace binpick

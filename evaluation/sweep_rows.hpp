// What a sweep's tables say, in words and figures: shared by text, Markdown, CSV and page. Private to this folder.
#pragma once

#include <string>
#include <vector>

#include "evaluation/report_text.hpp"
#include "evaluation/sweep_figures.hpp"

namespace binpick::sweep {

using text::Row;

/// best, worse, or not told from the best.
std::string finding(bool best, const std::optional<SweepDifference>& difference);

Row factor_head();
std::vector<Row> factor_rows(const SweepResult& result);

/// Cells from the best down; what has no records last.
std::vector<std::size_t> ranked(const SweepResult& result);
Row cell_head(const SweepPlan& plan);
/// In the order of `ranked`.
std::vector<Row> cell_rows(const SweepResult& result);

/// Which cell is best, and how many cannot be told from it.
std::string sentence(const SweepResult& result);
std::vector<std::string> notes(const SweepResult& result);

}  // namespace binpick::sweep

// The figures of `binpick bench perception`: pooled, with intervals over heaps; as a table for people and as the JSON
// rows of ARCHITECTURE section 14.
#pragma once

#include <span>
#include <string>

#include "evaluation/summary.hpp"
#include "tools/bench/perception_bench.hpp"

namespace binpick {

/// A row's figures. SI but for the times in ms; NaN where nothing was measured.
struct RowFigures {
  Rate recall, recall_clear, recall_partly, recall_tight;  ///< cluster bootstrap over heaps
  Rate precision, precision_clear, precision_sure;         ///< the same
  Rate top1, top1_clear, first;                            ///< Wilson: one a heap
  double translation_median = 0, translation_p95 = 0, lateral_median = 0, abs_z_median = 0, z_bias = 0;
  double rotation_median = 0, rotation_p95 = 0;
  LookTimes median;
  double total_p95 = 0;
};
RowFigures figures_of(const PerceptionRow& row);

/// The median over common looks of a peer's time by this row's; NaN without any.
double time_ratio(const PerceptionRow& peer, const PerceptionRow& row);

std::string table_of(std::span<const PerceptionRow> rows);
/// The same as Markdown.
std::string markdown_of(std::span<const PerceptionRow> rows);
/// {"rows": [..]}
std::string json_of(std::span<const PerceptionRow> rows);
/// Every missed instance visible >= 0.5 and every wrong estimate, one a line.
std::string failures_of(std::span<const PerceptionRow> rows);

}  // namespace binpick

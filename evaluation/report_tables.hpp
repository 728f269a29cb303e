// Every table of a report, from the records alone. Fields: docs/report.md.
#pragma once

#include <span>
#include <vector>

#include "evaluation/report_table.hpp"
#include "evaluation/summary.hpp"

namespace binpick {

/// In reading order. Those of what the records do not hold (visibility, in lines of older versions) have no rows.
std::vector<ReportTable> report_tables(const CampaignSummary& summary, std::span<const TrialRecord> records);

// By theme; the order within is that of the page. Trials that failed are in none of them but trial_failures.
std::vector<ReportTable> result_tables(const CampaignSummary& summary, std::span<const TrialRecord> records);
std::vector<ReportTable> error_tables(std::span<const TrialRecord> records);
std::vector<ReportTable> recall_tables(std::span<const TrialRecord> records);
std::vector<ReportTable> emptying_tables(std::span<const TrialRecord> records);

/// Shares of hits by group, each with a cluster bootstrap over piles; shared by the .cpp files.
struct GroupCount {
  std::vector<ClusterCount> piles;  ///< one a record
  double hits() const;
  double total() const;
};
/// Rate, low and high in %; nothing where there is nothing.
std::vector<TableCell> rate_cells(const GroupCount& count, const char* name, std::size_t group);

}  // namespace binpick

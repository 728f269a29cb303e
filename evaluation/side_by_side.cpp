// Several campaigns in one table, a row each.
#include "evaluation/report.hpp"
#include "evaluation/report_text.hpp"

namespace binpick {
namespace {

using text::fixed;
using text::Row;

std::string rate(const Rate& r) {
  return text::ratio(r) + " = " + text::percent(r.rate) + " (" + text::percent(r.interval) + ")";
}

std::string pair(double median, double p95, double factor) {
  return fixed(factor * median, 2) + " / " + fixed(factor * p95, 2);
}

Row row_of(const NamedSummary& campaign) {
  const CampaignSummary& s = campaign.summary;
  const auto total = s.stages.find("estimate_total");
  return {campaign.name,
          std::to_string(s.trials),
          rate(s.cleared),
          rate(s.picks),
          rate(s.recall),
          rate(s.precision),
          pair(s.translation_median, s.translation_p95, text::kToMm),
          pair(s.rotation_median, s.rotation_p95, text::kToDeg),
          total == s.stages.end() ? "-" : fixed(text::kToMs * total->second.median, 0)};
}

}  // namespace

std::string side_by_side(std::span<const NamedSummary> campaigns, bool markdown) {
  const Row head = {"campaign",
                    "trials",
                    "cleared",
                    "picks",
                    "recall",
                    "precision",
                    "translation median / 95 %, mm",
                    "rotation median / 95 %, deg",
                    "estimate median, ms"};
  std::vector<Row> rows;
  for (const NamedSummary& campaign : campaigns) rows.push_back(row_of(campaign));
  if (markdown) return text::markdown_table(head, rows);
  rows.insert(rows.begin(), head);
  return text::plain_table(rows);
}

}  // namespace binpick

// A sweep as one self-contained page, under the same policy as a report: what is best, its heat maps, every factor and
// cell, and the way to each cell's own report.
#include "evaluation/html_page.hpp"
#include "evaluation/report_table.hpp"
#include "evaluation/sweep_rows.hpp"

namespace binpick {
namespace {

std::string table(const sweep::Row& head, const std::vector<sweep::Row>& rows) {
  ReportTable table;
  for (const std::string& name : head) table.columns.push_back({name, name});
  for (const sweep::Row& row : rows) table.rows.emplace_back(row.begin(), row.end());
  return table_html(table);
}

std::string list(const std::vector<std::string>& lines) {
  std::string items;
  for (const std::string& line : lines) items += "<li>" + text::html(line) + "</li>";
  return "<ul class=\"note\">" + items + "</ul>";
}

/// Of the cells that have been run; a cell's own page is written with its campaign.
std::string cell_links(const SweepResult& result) {
  std::string links;
  for (const std::size_t c : sweep::ranked(result)) {
    const SweepCellPlan& cell = result.plan.cells[c];
    const std::string url = text::html(text::relative_url(cell.folder + "/report.html"));
    if (url.empty() || result.cells[c].summary.trials == 0) continue;
    links += "<li><a href=\"" + url + "\">" + text::html(cell_label(cell)) + "</a></li>";
  }
  return links.empty() ? "" : "<h3>Reports of the cells</h3><ul>" + links + "</ul>";
}

}  // namespace

std::string html_sweep(const SweepResult& result, const std::vector<PageSources::Picture>& heat_maps) {
  const PageSources sources;
  html::Page page{result.plan.name, "", "", &sources};
  page.body =
      "<h1>" + text::html(result.plan.name) + "</h1><p class=\"verdict\">" + text::html(sweep::sentence(result)) +
      "</p>" + list(sweep::notes(result)) + "<section id=\"heat\"><h2>Heat maps</h2>" + html::figures(heat_maps) +
      "</section><section id=\"factors\"><h2>Factors</h2>" + table(sweep::factor_head(), sweep::factor_rows(result)) +
      "</section><section id=\"cells\"><h2>Cells</h2>" +
      table(sweep::cell_head(result.plan), sweep::cell_rows(result)) + cell_links(result) + "</section>";
  return html::whole_page(page);
}

}  // namespace binpick

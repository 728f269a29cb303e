#include "evaluation/report_table.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "core/check.hpp"
#include "evaluation/report_text.hpp"

namespace binpick {
namespace {

using Json = nlohmann::ordered_json;

std::string cell_text(const TableCell& cell, const TableColumn& column, const char* nothing) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  if (const auto* number = std::get_if<double>(&cell)) return text::fixed(*number, std::max(0, column.digits));
  return nothing;
}

Json cell_json(const TableCell& cell, const TableColumn& column) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  const auto* number = std::get_if<double>(&cell);
  if (!number) return nullptr;
  if (column.digits <= 0 && std::abs(*number) < 9e15) return static_cast<std::int64_t>(std::llround(*number));
  return std::strtod(text::fixed(*number, column.digits).c_str(), nullptr);
}

}  // namespace

void ReportTable::add(std::vector<TableCell> row) {
  BP_CHECK(row.size() == columns.size(), id << ": " << row.size() << " cells");
  for (TableCell& cell : row)
    if (const auto* number = std::get_if<double>(&cell); number && !std::isfinite(*number)) cell = std::monostate();
  rows.push_back(std::move(row));
}

std::string csv_cell(std::string value) {
  if (!value.empty() && std::string_view("=+-@\t\r").find(value.front()) != std::string_view::npos) value = "'" + value;
  if (value.find_first_of(",\"\n\r") == std::string::npos) return value;
  std::string quoted = "\"";
  for (const char c : value) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string table_markdown(const ReportTable& table) {
  text::Row head;
  for (const TableColumn& column : table.columns) head.push_back(text::markdown(column.head));
  std::vector<text::Row> rows;
  for (const auto& row : table.rows) {
    rows.emplace_back();
    for (std::size_t i = 0; i < row.size(); ++i) rows.back().push_back(cell_text(row[i], table.columns[i], "-"));
  }
  return "## " + text::markdown(table.title) + "\n\n" + text::markdown_table(head, rows) +
         (table.note.empty() ? "" : text::markdown(table.note) + "\n\n");
}

std::string table_csv(const ReportTable& table) {
  std::string csv;
  for (std::size_t i = 0; i < table.columns.size(); ++i) csv += (i ? "," : "") + table.columns[i].key;
  csv += "\n";
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      const bool is_text = std::holds_alternative<std::string>(row[i]);
      const std::string text = cell_text(row[i], table.columns[i], "");
      csv += (i ? "," : "") + (is_text ? csv_cell(text) : text);
    }
    csv += "\n";
  }
  return csv;
}

std::string tables_json(const std::vector<ReportTable>& tables) {
  Json list = Json::array();
  for (const ReportTable& table : tables) {
    Json columns = Json::array(), rows = Json::array();
    for (const TableColumn& column : table.columns) columns.push_back({{"key", column.key}, {"head", column.head}});
    for (const auto& row : table.rows) {
      Json cells = Json::array();
      for (std::size_t i = 0; i < row.size(); ++i) cells.push_back(cell_json(row[i], table.columns[i]));
      rows.push_back(std::move(cells));
    }
    list.push_back(
        {{"id", table.id}, {"title", table.title}, {"note", table.note}, {"columns", columns}, {"rows", rows}});
  }
  const Json whole = {{"schema", kTablesSchema}, {"tables", list}};
  return whole.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string table_html(const ReportTable& table) {
  std::string html = "<div class=\"scroll\"><table><thead><tr>";
  const auto kind = [&](std::size_t i) { return table.columns[i].digits >= 0 ? " class=\"n\">" : ">"; };
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    html += std::string("<th scope=\"col\"") + kind(i) + text::html(table.columns[i].head) + "</th>";
  html += "</tr></thead><tbody>";
  for (const auto& row : table.rows) {
    html += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i)
      html += std::string("<td") + kind(i) + text::html(cell_text(row[i], table.columns[i], "-")) + "</td>";
    html += "</tr>";
  }
  return html + "</tbody></table></div>";
}

}  // namespace binpick

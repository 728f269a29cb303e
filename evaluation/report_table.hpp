// One table of a report as a value, and its four faces: Markdown, CSV, JSON and HTML. Numbers are in the unit that
// their column states (mm, deg, ms, %), for people and spreadsheets; records and summary.json are the SI ones.
#pragma once

#include <string>
#include <variant>
#include <vector>

namespace binpick {

inline constexpr int kTablesSchema = 1;

struct TableColumn {
  std::string key;   ///< of CSV and JSON: lower case, the unit at its end
  std::string head;  ///< for people
  int digits = -1;   ///< decimals of its numbers; -1: texts
};
/// A text, a number, or nothing: what no record tells.
using TableCell = std::variant<std::monostate, std::string, double>;

struct ReportTable {
  std::string id, title, note;
  std::vector<TableColumn> columns;
  std::vector<std::vector<TableCell>> rows;

  /// As long as `columns`; a number that is none becomes nothing.
  void add(std::vector<TableCell> row);
};

std::string table_markdown(const ReportTable& table);
/// A text that a spreadsheet would take for a formula gets an apostrophe in front.
std::string table_csv(const ReportTable& table);
/// {"schema":1,"tables":[{"id":..,"title":..,"note":..,"columns":[{"key":..,"head":..}],"rows":[[..],..]}]}; numbers
/// with the column's decimals, null for nothing.
std::string tables_json(const std::vector<ReportTable>& tables);
/// Every text escaped.
std::string table_html(const ReportTable& table);

/// One cell of a CSV file: quoted when needed.
std::string csv_cell(std::string value);

}  // namespace binpick

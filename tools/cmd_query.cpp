// binpick query RUN "select ..": questions to a run's records in SQL.

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "tools/commands.hpp"
#include "trials/run_index.hpp"

namespace binpick {
namespace {

struct Options {
  std::string run, statement;
  bool json = false, tabs = false;
};

nlohmann::ordered_json json_of(const QueryCell& cell) {
  if (cell.kind == QueryCell::Kind::kText) return cell.text;
  const auto number = nlohmann::ordered_json::parse(cell.text.empty() ? "null" : cell.text, nullptr, false);
  return number.is_discarded() ? nlohmann::ordered_json(cell.text) : number;  // SQLite writes infinity as Inf
}

std::string as_json(const QueryAnswer& answer) {
  auto rows = nlohmann::ordered_json::array();
  for (const auto& row : answer.rows) {
    auto& object = rows.emplace_back(nlohmann::ordered_json::object());
    for (std::size_t k = 0; k < row.size(); ++k) object[answer.columns[k]] = json_of(row[k]);
  }
  return rows.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string as_table(const QueryAnswer& answer, bool tabs) {
  std::vector<std::vector<std::string>> lines = {answer.columns};
  for (const auto& row : answer.rows) {
    auto& line = lines.emplace_back();
    for (const auto& cell : row) line.push_back(cell.text);
  }
  std::vector<std::size_t> widths(answer.columns.size(), 0);
  for (const auto& line : lines)
    for (std::size_t k = 0; k < line.size(); ++k) widths[k] = std::max(widths[k], line[k].size());
  std::string text;
  for (const auto& line : lines) {
    for (std::size_t k = 0; k < line.size(); ++k) {
      text += line[k];
      if (k + 1 < line.size()) text += tabs ? "\t" : std::string(widths[k] - line[k].size() + 2, ' ');
    }
    text += "\n";
  }
  return text;
}

int run(const Options& options) {
  const QueryAnswer answer = query_run(options.run, options.statement);
  std::cout << (options.json ? as_json(answer) : as_table(answer, options.tabs)) << std::flush;
  if (!std::cout) throw StorageError("standard output: cannot write");
  return 0;
}

}  // namespace

Action add_query(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("query", "a run's records in SQL: tables trials, picks, estimates");
  command->add_option("run", options->run, "run folder")->required();
  command->add_option("statement", options->statement, "select .. from trials | picks | estimates ..")->required();
  command->add_flag("--tabs", options->tabs, "columns apart by tabs, for other programs");
  command->add_flag("--json", options->json, "a list of objects");
  return [options] { return run(*options); };
}

}  // namespace binpick

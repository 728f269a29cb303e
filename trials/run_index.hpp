// Questions to a run: its records as SQLite tables. The index is `index.sqlite` beside the records; it holds nothing of
// its own and is made anew whenever the records have changed. Tables `trials`, `picks` and `estimates`; their columns
// are named as in docs/record_format.md, with the unit behind them (_m, _rad, _s, _n, _ms).
#pragma once

#include <string>
#include <vector>

namespace binpick {

struct QueryCell {
  enum class Kind { kNull, kNumber, kText } kind = Kind::kNull;
  std::string text;
};

struct QueryAnswer {
  std::vector<std::string> columns;
  std::vector<std::vector<QueryCell>> rows;
};

/// One statement that only reads. Throws SpecError: no run folder, a damaged record, what SQLite says of the statement.
QueryAnswer query_run(const std::string& run_folder, const std::string& statement);

}  // namespace binpick

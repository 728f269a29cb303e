// Curves for people: the data as CSV, a gnuplot script beside it, and a PNG where gnuplot is installed.
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

namespace binpick {

/// Rows of numbers, each with the name of the curve it belongs to in the first column.
class CurveTable {
 public:
  explicit CurveTable(const std::string& header) : text_(header + "\n") {}
  void add(const std::string& curve, std::initializer_list<double> values);  ///< NaN stays empty
  const std::string& csv() const { return text_; }

 private:
  std::string text_;
};

/// Writes folder/name.csv and folder/name.gp. `commands` follow a common head (size, fonts, grid, colours) and read the
/// table through curve(name, column), which is the column where the first one holds `name`. Throws StorageError.
void write_plot(const std::string& folder, const std::string& name, const CurveTable& table,
                const std::string& commands);

/// Runs gnuplot on the scripts of these names. False when it is not installed; throws StorageError when it fails.
bool draw_plots(const std::string& folder, const std::vector<std::string>& names);

}  // namespace binpick

#include "evaluation/bop_results.hpp"

#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/one_line.hpp"
#include "core/quantity.hpp"
#include "evaluation/bop_json.hpp"

namespace binpick {
namespace {

constexpr std::string_view kHeader = "scene_id,im_id,obj_id,score,R,t,time";
constexpr double kSameTime = 0.001;  // s

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> pieces;
  while (true) {
    const std::size_t end = text.find(separator);
    pieces.push_back(trimmed(text.substr(0, end)));
    if (end == std::string_view::npos) return pieces;
    text.remove_prefix(end + 1);
  }
}

/// One line of the file, for messages.
class Row {
 public:
  Row(std::string_view line, std::string place) : place_(std::move(place)), fields_(split(line, ',')) {
    if (fields_.size() != 7)
      fail("has " + std::to_string(fields_.size()) + " fields, not 7 (" + std::string(kHeader) + ")");
  }

  int id(std::size_t field, const char* name) const {
    int value = -1;
    const std::string_view text = fields_[field];
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (problem != std::errc() || end != text.data() + text.size() || value < 0)
      fail(std::string(name) + ": '" + shown(text) + "' is not a whole number >= 0");
    return value;
  }
  double number(std::string_view text, const char* name) const {
    double value = 0;
    if (text.size() > 1 && text.front() == '+') text.remove_prefix(1);
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (problem != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
      fail(std::string(name) + ": '" + shown(text) + "' is not a finite number");
    return value;
  }
  double number(std::size_t field, const char* name) const { return number(fields_[field], name); }
  std::vector<double> numbers(std::size_t field, const char* name, std::size_t count) const {
    std::vector<double> values;
    for (const std::string_view word : split(fields_[field], ' '))
      if (!word.empty()) values.push_back(number(word, name));
    if (values.size() != count)
      fail(std::string(name) + ": holds " + std::to_string(values.size()) + " numbers, not " + std::to_string(count));
    return values;
  }
  [[noreturn]] void fail(const std::string& message) const { throw AssetError(one_line(place_ + ": " + message)); }

 private:
  static std::string shown(std::string_view text) { return std::string(text.substr(0, 40)); }
  std::string place_;
  std::vector<std::string_view> fields_;
};

BopEstimate estimate_of(const Row& row) {
  BopEstimate estimate;
  estimate.scene = row.id(0, "scene_id");
  estimate.image = row.id(1, "im_id");
  estimate.object = row.id(2, "obj_id");
  estimate.score = row.number(3, "score");
  const std::vector<double> R = row.numbers(4, "R", 9), t = row.numbers(5, "t", 3);
  const std::optional<Pose> X_CO = pose_of_file(R, 1e-3 * Eigen::Vector3d(t[0], t[1], t[2]));
  if (!X_CO) row.fail("R: is no rotation");
  estimate.X_CO = *X_CO;
  estimate.time = row.number(6, "time");
  return estimate;
}

}  // namespace

std::vector<BopEstimate> read_bop_results(const std::string& path) {
  const std::string text = read_file(path);
  std::vector<BopEstimate> estimates;
  std::map<std::pair<int, int>, std::pair<double, std::size_t>> times;  // of an image, and where it was said first
  std::string_view rest = text;
  for (std::size_t number = 1; !rest.empty(); ++number) {
    const std::size_t end = rest.find('\n');
    const std::string_view line = trimmed(rest.substr(0, end));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (number == 1 && line == kHeader) continue;
    if (line.empty() && trimmed(rest).empty()) continue;  // at the end of the file
    const Row row(line, path + ":" + std::to_string(number));
    const BopEstimate estimate = estimate_of(row);
    const auto [known, first] = times.insert({{estimate.scene, estimate.image}, {estimate.time, number}});
    if (!first && std::abs(known->second.first - estimate.time) > kSameTime)
      row.fail("time: another one than in line " + std::to_string(known->second.second) + ", for the same image");
    estimates.push_back(estimate);
  }
  return estimates;
}

std::string bop_results_csv(const std::vector<BopEstimate>& estimates) {
  std::string text(kHeader);
  text += "\n";
  for (const BopEstimate& e : estimates) {
    text += std::to_string(e.scene) + "," + std::to_string(e.image) + "," + std::to_string(e.object) + "," +
            format_double(e.score) + ",";
    for (int i = 0; i < 9; ++i) text += (i ? " " : "") + format_double(e.X_CO.linear()(i / 3, i % 3));
    for (int i = 0; i < 3; ++i) text += (i ? " " : ",") + format_double(1e3 * e.X_CO.translation()[i]);
    text += "," + format_double(e.time) + "\n";
  }
  return text;
}

}  // namespace binpick

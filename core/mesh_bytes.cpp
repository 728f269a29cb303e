#include "core/mesh_bytes.hpp"

#include <charconv>
#include <cmath>

#include "core/error.hpp"

namespace binpick {
namespace {

bool blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == '\r'; }

std::string_view without_plus(std::string_view token) {
  if (token.size() > 1 && token[0] == '+' && token[1] != '-' && token[1] != '+') token.remove_prefix(1);
  return token;
}

}  // namespace

std::string shown(std::string_view text) {
  std::string result;
  for (const char c : text.substr(0, 40)) result += c >= 32 && c < 127 ? c : '?';
  return text.size() > 40 ? result + ".." : result;
}

void check_coordinate(double value, const std::string& place) {
  if (!std::isfinite(value)) throw AssetError(place + ": a coordinate is not a finite number");
  if (std::abs(value) > kLargestCoordinate) {
    throw AssetError(place + ": a coordinate is beyond " + std::to_string(static_cast<long>(kLargestCoordinate)) +
                     " file units");
  }
}

double plain_number(std::string_view token, const std::string& place) {
  const std::string_view digits = without_plus(token);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range) {
    throw AssetError(place + ": '" + shown(token) + "' is out of range");
  }
  if (error != std::errc() || end != digits.data() + digits.size()) {
    const bool comma = token.find(',') != std::string_view::npos;
    throw AssetError(place + ": '" + shown(token) + "' is not a number" +
                     (comma ? " (a decimal comma? numbers are written with a point)" : ""));
  }
  if (!std::isfinite(value)) throw AssetError(place + ": '" + shown(token) + "' is not a finite number");
  check_coordinate(value, place);
  return value;
}

std::int64_t plain_integer(std::string_view token, const std::string& place) {
  const std::string_view digits = without_plus(token);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size()) {
    throw AssetError(place + ": '" + shown(token) + "' is not a whole number");
  }
  return value;
}

bool LineReader::next_line(std::string_view& line) {
  if (offset_ >= text_.size()) return false;
  const std::size_t end = text_.find('\n', offset_);
  line = text_.substr(offset_, end == std::string_view::npos ? end : end - offset_);
  offset_ = end == std::string_view::npos ? text_.size() : end + 1;
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  ++line_;
  return true;
}

bool LineReader::next(std::vector<std::string_view>& words) {
  std::string_view line;
  while (next_line(line)) {
    words.clear();
    for (std::size_t i = 0; i < line.size();) {
      while (i < line.size() && blank(line[i])) ++i;
      const std::size_t begin = i;
      while (i < line.size() && !blank(line[i])) ++i;
      if (i > begin) words.push_back(line.substr(begin, i - begin));
    }
    if (!words.empty()) return true;
  }
  return false;
}

}  // namespace binpick

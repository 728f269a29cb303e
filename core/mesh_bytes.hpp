// The checks that stand before the importer: sizes and counts in 64 bits, plain numbers of the C locale, indices in
// range. The importer itself lets NaN, 1e38, 1e999, decimal commas and a missing `endsolid` through, and some lying
// counts make it crash or hang, so it is only ever given bytes that have passed here. Private to core.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace binpick {

constexpr std::uint64_t kMostTriangles = 10'000'000;
constexpr std::uint64_t kMostCorners = 10'000;  ///< of one face: cutting it into triangles takes the square of it
constexpr std::uint64_t kMostObjects = 20'000;  ///< of an OBJ: the importer takes the square of it
constexpr double kLargestCoordinate = 1e9;      ///< in file units: a million times a metre in mm

/// STL, binary or ASCII: the bytes to hand to the importer (ASCII in lower case, without normals). Throws AssetError.
std::string checked_stl(std::string bytes, const std::string& path);

/// OBJ: vertices, faces with absolute positive indices and objects "piece_<n>"; everything else is left out.
std::string checked_obj(const std::string& bytes, const std::string& path);

/// PLY, ASCII and binary of both byte orders: one list of vertices and one of faces, written anew in binary; everything
/// else is left out.
std::string checked_ply(const std::string& bytes, const std::string& path);

/// A finite number of the C locale, at most kLargestCoordinate. Throws AssetError that starts with `place`.
double plain_number(std::string_view token, const std::string& place);

/// A whole number of the C locale. Throws AssetError that starts with `place`.
std::int64_t plain_integer(std::string_view token, const std::string& place);

/// Throws AssetError for a NaN, an infinity or a value that no part can have.
void check_coordinate(double value, const std::string& place);

/// Lines of a text without their ends, counted from 1.
class LineReader {
 public:
  LineReader(std::string_view text, std::string path) : text_(text), path_(std::move(path)) {}

  /// The words of the next line that has some; false at the end.
  bool next(std::vector<std::string_view>& words);
  /// The next line as it stands; false at the end.
  bool next_line(std::string_view& line);

  std::string place() const { return path_ + ":" + std::to_string(line_); }
  std::size_t offset() const { return offset_; }

 private:
  std::string_view text_;
  std::string path_;
  std::size_t offset_ = 0;
  std::size_t line_ = 0;
};

/// At most 40 printable characters of foreign text, for a message.
std::string shown(std::string_view text);

}  // namespace binpick

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "core/error.hpp"
#include "core/mesh_bytes.hpp"

namespace binpick {
namespace {

constexpr std::uint64_t kHeaderSize = 84;  // 80 bytes of text, 4 of the triangle count
constexpr std::uint64_t kRecordSize = 50;  // normal, three corners, two spare bytes
static_assert(std::endian::native == std::endian::little, "binary STL is little endian and read as it lies");

std::uint64_t claimed_triangles(const std::string& bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, sizeof count);
  return count;
}

bool is_binary(const std::string& bytes) {
  return bytes.size() >= kHeaderSize && bytes.size() == kHeaderSize + kRecordSize * claimed_triangles(bytes);
}

void check_count(std::uint64_t triangles, const std::string& path) {
  if (triangles == 0) throw AssetError(path + ": holds no triangles");
  if (triangles > kMostTriangles) {
    throw AssetError(path + ": " + std::to_string(triangles) + " triangles are more than the " +
                     std::to_string(kMostTriangles) + " allowed");
  }
}

std::string checked_binary(std::string bytes, const std::string& path) {
  const std::uint64_t triangles = claimed_triangles(bytes);
  check_count(triangles, path);
  for (std::uint64_t i = 0; i < triangles; ++i) {
    std::array<float, 12> values;
    std::memcpy(values.data(), bytes.data() + kHeaderSize + kRecordSize * i, sizeof values);
    for (std::size_t k = 3; k < values.size(); ++k) {  // the normal is not used
      const double value = values[k];
      if (!(std::abs(value) <= kLargestCoordinate)) check_coordinate(value, path + ": triangle " + std::to_string(i));
    }
  }
  std::fill(bytes.begin(), bytes.begin() + 80, ' ');  // some importers look for colours and the word "solid" there
  return bytes;
}

std::string lower(std::string_view word) {
  std::string result(word);
  for (char& c : result) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return result;
}

/// Reads ASCII STL keyword by keyword.
class AsciiStl {
 public:
  AsciiStl(const std::string& bytes, const std::string& path) : lines_(bytes, path), path_(path) {}

  std::string checked() {
    std::string out = "solid part\n";
    std::uint64_t triangles = 0;
    while (lines_.next(words_)) {
      require(0, "solid");
      read_solid(out, triangles);
    }
    check_count(triangles, path_);
    return out + "endsolid part\n";
  }

 private:
  void read_solid(std::string& out, std::uint64_t& triangles) {
    while (true) {
      advance("endsolid");
      if (lower(words_[0]) == "endsolid") return;
      require(0, "facet");
      read_facet(out);
      if (++triangles > kMostTriangles) check_count(triangles, path_);
    }
  }

  void read_facet(std::string& out) {
    // The normal is not used: any three words will do, exporters write nan for facets without area.
    if (words_.size() != 5) fail("'facet normal x y z' expected");
    require(1, "normal");
    advance("outer loop");
    require(0, "outer");
    out += "facet normal 0 0 0\nouter loop\n";
    for (int corner = 0; corner < 3; ++corner) {
      advance("vertex");
      require(0, "vertex");
      if (words_.size() != 4) fail("'vertex x y z' expected, found " + std::to_string(words_.size() - 1) + " words");
      out += "vertex";
      for (std::size_t k = 1; k < 4; ++k) {
        plain_number(words_[k], lines_.place());
        out.append(" ").append(words_[k]);
      }
      out += "\n";
    }
    advance("endloop");
    require(0, "endloop");
    advance("endfacet");
    require(0, "endfacet");
    out += "endloop\nendfacet\n";
  }

  void advance(const char* expected) {
    if (!lines_.next(words_)) fail(std::string("the file ends where '") + expected + "' should follow");
  }
  void require(std::size_t word, const char* expected) {
    if (words_.size() <= word || lower(words_[word]) != expected) {
      fail(std::string("'") + expected + "' expected, found '" + shown(words_[std::min(word, words_.size() - 1)]) +
           "'");
    }
  }
  [[noreturn]] void fail(const std::string& message) const { throw AssetError(lines_.place() + ": " + message); }

  LineReader lines_;
  std::string path_;
  std::vector<std::string_view> words_;
};

bool looks_like_text(const std::string& bytes) {
  const std::size_t begin = bytes.find_first_not_of(" \t\r\n");
  if (begin == std::string::npos || lower(std::string_view(bytes).substr(begin, 5)) != "solid") return false;
  return bytes.find('\0') == std::string::npos;
}

}  // namespace

std::string checked_stl(std::string bytes, const std::string& path) {
  if (is_binary(bytes)) return checked_binary(std::move(bytes), path);
  if (looks_like_text(bytes)) return AsciiStl(bytes, path).checked();
  if (bytes.size() < kHeaderSize) {
    throw AssetError(path + ": " + std::to_string(bytes.size()) + " bytes are too few for an STL file");
  }
  const std::uint64_t triangles = claimed_triangles(bytes);
  throw AssetError(path + ": is no ASCII STL, and as a binary one claims " + std::to_string(triangles) +
                   " triangles, that is " + std::to_string(kHeaderSize + kRecordSize * triangles) + " bytes, but has " +
                   std::to_string(bytes.size()));
}

}  // namespace binpick

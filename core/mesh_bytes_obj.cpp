#include <algorithm>
#include <array>

#include "core/error.hpp"
#include "core/mesh_bytes.hpp"

namespace binpick {
namespace {

/// Statements that say nothing about the shape.
constexpr std::array<std::string_view, 17> kIgnored = {"vt",    "vn",     "vp",       "g",        "s",         "l",
                                                       "p",     "usemtl", "mtllib",   "mg",       "lod",       "usemap",
                                                       "bevel", "maplib", "c_interp", "d_interp", "shadow_obj"};

class ObjChecker {
 public:
  ObjChecker(const std::string& bytes, const std::string& path) : lines_(bytes, path), path_(path) {}

  std::string checked() {
    while (lines_.next(words_)) statement();
    if (triangles_ == 0) throw AssetError(path_ + ": holds no faces");
    if (largest_ > vertices_) {
      throw AssetError(place_of_largest_ + ": vertex " + std::to_string(largest_) + " does not exist, the file has " +
                       std::to_string(vertices_));
    }
    return std::move(out_);
  }

 private:
  void statement() {
    const std::string_view keyword = words_[0];
    if (keyword[0] == '#') return;
    if (words_.back().back() == '\\') fail("lines continued with a backslash are not read");
    if (keyword == "v") return vertex();
    if (keyword == "f") return face();
    if (keyword == "o") {
      if (objects_ == kMostObjects) fail("more than " + std::to_string(kMostObjects) + " objects");
      out_ += "o piece_" + std::to_string(objects_++) + "\n";
      return;
    }
    if (std::find(kIgnored.begin(), kIgnored.end(), keyword) == kIgnored.end()) {
      fail("statement '" + shown(keyword) + "' is not read");
    }
  }

  void vertex() {
    // Three coordinates; a weight of four or a colour of six numbers may follow and is left out.
    if (words_.size() < 4 || words_.size() > 8) fail("'v x y z' expected");
    out_ += "v";
    for (std::size_t k = 1; k < words_.size(); ++k) {
      plain_number(words_[k], lines_.place());
      if (k < 4) add_number(words_[k]);
    }
    out_ += "\n";
    ++vertices_;
  }

  /// A number that begins with its point is no number to the importer, which then leaves the vertex out.
  void add_number(std::string_view token) {
    const std::size_t sign = token.find_first_not_of("+-");
    out_.append(" ").append(token.substr(0, sign)).append(token[sign] == '.' ? "0" : "").append(token.substr(sign));
  }

  void face() {
    if (words_.size() < 4) fail("a face needs three corners");
    if (words_.size() - 1 > kMostCorners) fail("a face with more than " + std::to_string(kMostCorners) + " corners");
    out_ += "f";
    for (std::size_t k = 1; k < words_.size(); ++k) {
      const std::string_view corner = words_[k].substr(0, words_[k].find('/'));
      std::int64_t index = plain_integer(corner, lines_.place());
      if (index < 0) index += vertices_ + 1;  // counted back from the last vertex
      if (index < 1) fail("vertex '" + shown(corner) + "' does not exist");
      if (index > largest_) {
        largest_ = index;
        place_of_largest_ = lines_.place();
      }
      out_ += " " + std::to_string(index);
    }
    out_ += "\n";
    triangles_ += words_.size() - 3;
    if (triangles_ > kMostTriangles) fail("more than " + std::to_string(kMostTriangles) + " triangles");
  }

  [[noreturn]] void fail(const std::string& message) const { throw AssetError(lines_.place() + ": " + message); }

  LineReader lines_;
  std::string path_;
  std::vector<std::string_view> words_;
  std::string out_;
  std::int64_t vertices_ = 0;
  std::int64_t largest_ = 0;
  std::string place_of_largest_;
  std::uint64_t triangles_ = 0;
  std::uint64_t objects_ = 0;
};

}  // namespace

std::string checked_obj(const std::string& bytes, const std::string& path) { return ObjChecker(bytes, path).checked(); }

}  // namespace binpick

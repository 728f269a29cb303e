#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <memory>

#include "core/error.hpp"
#include "core/mesh_bytes.hpp"

namespace binpick {
namespace {

enum class Kind { kSigned, kUnsigned, kReal };

struct Scalar {
  Kind kind = Kind::kReal;
  std::size_t size = 0;  ///< bytes
};

struct Property {
  std::string name;
  Scalar value;
  bool is_list = false;
  Scalar count;
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  std::string format;
  std::vector<Element> elements;
  std::size_t size = 0;  ///< bytes up to the data
  std::size_t lines = 0;
};

Scalar scalar_type(std::string_view name, const std::string& place) {
  if (name == "char" || name == "int8") return {Kind::kSigned, 1};
  if (name == "uchar" || name == "uint8") return {Kind::kUnsigned, 1};
  if (name == "short" || name == "int16") return {Kind::kSigned, 2};
  if (name == "ushort" || name == "uint16") return {Kind::kUnsigned, 2};
  if (name == "int" || name == "int32") return {Kind::kSigned, 4};
  if (name == "uint" || name == "uint32") return {Kind::kUnsigned, 4};
  if (name == "float" || name == "float32") return {Kind::kReal, 4};
  if (name == "double" || name == "float64") return {Kind::kReal, 8};
  throw AssetError(place + ": '" + shown(name) + "' is not a PLY type");
}

Property read_property(const std::vector<std::string_view>& words, const std::string& place) {
  if (words.size() == 3) return {std::string(words[2]), scalar_type(words[1], place), false, {}};
  if (words.size() != 5 || words[1] != "list") throw AssetError(place + ": 'property type name' expected");
  const Property property{std::string(words[4]), scalar_type(words[3], place), true, scalar_type(words[2], place)};
  if (property.count.kind == Kind::kReal) throw AssetError(place + ": a list cannot be counted by a real number");
  return property;
}

Header read_header(const std::string& bytes, const std::string& path) {
  LineReader lines(bytes, path);
  std::vector<std::string_view> words;
  Header header;
  if (!lines.next(words) || words[0] != "ply") throw AssetError(path + ": does not start with 'ply'");
  while (lines.next(words)) {
    const std::string place = lines.place();
    if (words[0] == "end_header") {
      header.size = lines.offset();
      return header;
    }
    if (words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "format" && words.size() == 3) {
      header.format = std::string(words[1]);
    } else if (words[0] == "element" && words.size() == 3) {
      const std::int64_t count = plain_integer(words[2], place);
      if (count < 0 || static_cast<std::uint64_t>(count) > 3 * kMostTriangles) {
        throw AssetError(place + ": a count of " + shown(words[2]) + " is beyond what is read");
      }
      header.elements.push_back({std::string(words[1]), static_cast<std::uint64_t>(count), {}});
    } else if (words[0] == "property" && !header.elements.empty()) {
      header.elements.back().properties.push_back(read_property(words, place));
    } else {
      throw AssetError(place + ": '" + shown(words[0]) + "' is not expected in a PLY header");
    }
  }
  throw AssetError(path + ": the PLY header does not end");
}

/// The values after the header, one after another.
class Values {
 public:
  virtual ~Values() = default;
  virtual double next(const Scalar& type) = 0;
  virtual void begin_record() {}
  virtual void end_record() {}
  virtual void end() = 0;
  virtual std::string place() const = 0;
};

class AsciiValues : public Values {
 public:
  AsciiValues(const std::string& bytes, const std::string& path, const Header& header) : lines_(bytes, path) {
    std::string_view line;
    while (lines_.offset() < header.size && lines_.next_line(line)) {
    }
  }
  void begin_record() override {
    if (!lines_.next(words_)) throw AssetError(place() + ": the file ends before the counts of its header are met");
    at_ = 0;
  }
  double next(const Scalar& type) override {
    if (at_ >= words_.size()) throw AssetError(place() + ": a value is missing");
    const std::string_view word = words_[at_++];
    return type.kind == Kind::kReal ? plain_number(word, place()) : static_cast<double>(plain_integer(word, place()));
  }
  void end_record() override {
    if (at_ != words_.size()) throw AssetError(place() + ": '" + shown(words_[at_]) + "' is one value too many");
  }
  void end() override {
    if (lines_.next(words_)) throw AssetError(place() + ": more lines than the header counts");
  }
  std::string place() const override { return lines_.place(); }

 private:
  LineReader lines_;
  std::vector<std::string_view> words_;
  std::size_t at_ = 0;
};

class BinaryValues : public Values {
 public:
  BinaryValues(const std::string& bytes, const std::string& path, const Header& header, bool swap)
      : bytes_(bytes), path_(path), at_(header.size), swap_(swap) {}

  double next(const Scalar& type) override {
    if (bytes_.size() - at_ < type.size) {
      throw AssetError(path_ + ": the file ends before the counts of its header are met");
    }
    std::array<char, 8> raw = {};
    std::memcpy(raw.data(), bytes_.data() + at_, type.size);
    if (swap_) std::reverse(raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(type.size));
    at_ += type.size;
    if (type.kind == Kind::kReal)
      return type.size == 4 ? std::bit_cast<std::array<float, 2>>(raw)[0] : std::bit_cast<double>(raw);
    const auto word = std::bit_cast<std::uint64_t>(raw);
    if (type.kind == Kind::kUnsigned) return static_cast<double>(word);
    const auto shift = static_cast<int>(64 - 8 * type.size);  // sign bit to the top and back
    return static_cast<double>(static_cast<std::int64_t>(word << shift) >> shift);
  }
  void end() override {
    if (at_ != bytes_.size()) throw AssetError(path_ + ": more bytes than the header counts");
  }
  std::string place() const override { return path_ + ": byte " + std::to_string(at_); }

 private:
  const std::string& bytes_;
  std::string path_;
  std::size_t at_ = 0;
  bool swap_ = false;
};

bool is_coordinate(const std::string& name) { return name == "x" || name == "y" || name == "z"; }
bool is_index_list(const Property& p) {
  return p.is_list && (p.name == "vertex_indices" || p.name == "vertex_index") && p.value.kind != Kind::kReal;
}

/// Corners of one face: at least three, each an existing vertex. Returns the triangles it makes.
std::uint64_t check_face(Values& values, const Property& list, std::uint64_t vertices) {
  const double corners = values.next(list.count);
  if (corners < 3) throw AssetError(values.place() + ": a face with fewer than three corners");
  if (corners > 3 * static_cast<double>(kMostTriangles))
    throw AssetError(values.place() + ": a face with too many corners");
  const auto count = static_cast<std::uint64_t>(corners);
  for (std::uint64_t k = 0; k < count; ++k) {
    const double index = values.next(list.value);
    if (index < 0 || index >= static_cast<double>(vertices)) {
      throw AssetError(values.place() + ": vertex " + std::to_string(static_cast<std::int64_t>(index)) +
                       " does not exist, the file has " + std::to_string(vertices));
    }
  }
  return count - 2;
}

void check_other(Values& values, const Element& element, const Property& property) {
  const double repeats = property.is_list ? values.next(property.count) : 1;
  if (repeats < 0) throw AssetError(values.place() + ": a list with a negative count");
  for (double k = 0; k < repeats; ++k) {
    const double value = values.next(property.value);
    if (element.name == "vertex" && is_coordinate(property.name)) check_coordinate(value, values.place());
  }
}

void check_shape(const Header& header, const std::string& path, std::uint64_t& vertices) {
  bool faces = false;
  for (const Element& element : header.elements) {
    const auto& p = element.properties;
    if (element.name == "vertex") {
      const auto found =
          std::count_if(p.begin(), p.end(), [](const Property& q) { return !q.is_list && is_coordinate(q.name); });
      if (found != 3) throw AssetError(path + ": the vertices lack x, y or z");
      vertices = element.count;
    }
    if (element.name == "face") faces = element.count > 0 && std::count_if(p.begin(), p.end(), is_index_list) == 1;
    if (element.count > 0 && p.empty())
      throw AssetError(path + ": element '" + shown(element.name) + "' has no properties");
  }
  if (!faces) throw AssetError(path + ": holds no faces");
}

}  // namespace

std::string checked_ply(std::string bytes, const std::string& path) {
  const Header header = read_header(bytes, path);
  std::uint64_t vertices = 0;
  check_shape(header, path, vertices);
  std::unique_ptr<Values> values;
  if (header.format == "ascii") {
    values = std::make_unique<AsciiValues>(bytes, path, header);
  } else if (header.format == "binary_little_endian" || header.format == "binary_big_endian") {
    const bool big = header.format == "binary_big_endian";
    values = std::make_unique<BinaryValues>(bytes, path, header, big);
  } else {
    throw AssetError(path + ": '" + shown(header.format) + "' is not a PLY format");
  }
  std::uint64_t triangles = 0;
  for (const Element& element : header.elements) {
    for (std::uint64_t i = 0; i < element.count; ++i) {
      values->begin_record();
      for (const Property& property : element.properties) {
        if (element.name == "face" && is_index_list(property)) {
          triangles += check_face(*values, property, vertices);
        } else {
          check_other(*values, element, property);
        }
      }
      values->end_record();
      if (triangles > kMostTriangles) {
        throw AssetError(path + ": more than " + std::to_string(kMostTriangles) + " triangles");
      }
    }
  }
  values->end();
  return bytes;
}

}  // namespace binpick

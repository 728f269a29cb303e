#include "core/ply_bytes.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "core/error.hpp"
#include "core/mesh_bytes.hpp"

namespace binpick {
namespace {

PlyScalar scalar_type(std::string_view name, const std::string& place) {
  if (name == "char" || name == "int8") return {PlyScalar::Kind::kSigned, 1};
  if (name == "uchar" || name == "uint8") return {PlyScalar::Kind::kUnsigned, 1};
  if (name == "short" || name == "int16") return {PlyScalar::Kind::kSigned, 2};
  if (name == "ushort" || name == "uint16") return {PlyScalar::Kind::kUnsigned, 2};
  if (name == "int" || name == "int32") return {PlyScalar::Kind::kSigned, 4};
  if (name == "uint" || name == "uint32") return {PlyScalar::Kind::kUnsigned, 4};
  if (name == "float" || name == "float32") return {PlyScalar::Kind::kReal, 4};
  if (name == "double" || name == "float64") return {PlyScalar::Kind::kReal, 8};
  throw AssetError(place + ": '" + shown(name) + "' is not a PLY type");
}

PlyProperty read_property(const std::vector<std::string_view>& words, const std::string& place) {
  if (words.size() == 3) return {std::string(words[2]), scalar_type(words[1], place), false, {}};
  if (words.size() != 5 || words[1] != "list") throw AssetError(place + ": 'property type name' expected");
  const PlyProperty property{std::string(words[4]), scalar_type(words[3], place), true, scalar_type(words[2], place)};
  if (property.count.kind == PlyScalar::Kind::kReal)
    throw AssetError(place + ": a list cannot be counted by a real number");
  return property;
}

class AsciiValues : public PlyValues {
 public:
  AsciiValues(const std::string& bytes, const std::string& path, const PlyHeader& header) : lines_(bytes, path) {
    std::string_view line;
    while (lines_.offset() < header.size && lines_.next_line(line)) {
    }
  }
  void begin_record() override {
    if (!lines_.next(words_)) throw AssetError(place() + ": the file ends before the counts of its header are met");
    at_ = 0;
  }
  double next(const PlyScalar& type) override {
    if (at_ >= words_.size()) throw AssetError(place() + ": a value is missing");
    const std::string_view word = words_[at_++];
    return type.kind == PlyScalar::Kind::kReal ? plain_number(word, place())
                                               : static_cast<double>(plain_integer(word, place()));
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

class BinaryValues : public PlyValues {
 public:
  BinaryValues(const std::string& bytes, const std::string& path, const PlyHeader& header, bool swap)
      : bytes_(bytes), path_(path), at_(header.size), swap_(swap) {}

  double next(const PlyScalar& type) override {
    if (bytes_.size() - at_ < type.size) {
      throw AssetError(path_ + ": the file ends before the counts of its header are met");
    }
    std::array<char, 8> raw = {};
    std::memcpy(raw.data(), bytes_.data() + at_, type.size);
    if (swap_) std::reverse(raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(type.size));
    at_ += type.size;
    if (type.kind == PlyScalar::Kind::kReal)
      return type.size == 4 ? std::bit_cast<std::array<float, 2>>(raw)[0] : std::bit_cast<double>(raw);
    const auto word = std::bit_cast<std::uint64_t>(raw);
    if (type.kind == PlyScalar::Kind::kUnsigned) return static_cast<double>(word);
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

}  // namespace

PlyHeader read_ply_header(const std::string& bytes, const std::string& path) {
  LineReader lines(bytes, path);
  std::vector<std::string_view> words;
  PlyHeader header;
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

std::unique_ptr<PlyValues> ply_values(const std::string& bytes, const std::string& path, const PlyHeader& header) {
  if (header.format == "ascii") return std::make_unique<AsciiValues>(bytes, path, header);
  const bool big = header.format == "binary_big_endian";
  if (big || header.format == "binary_little_endian") return std::make_unique<BinaryValues>(bytes, path, header, big);
  throw AssetError(path + ": '" + shown(header.format) + "' is not a PLY format");
}

}  // namespace binpick

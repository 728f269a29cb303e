// PLY as a stream of bytes: the header, then the values one after another, ASCII and binary of both byte orders. Counts
// that the bytes do not meet, unknown types and lines that do not belong are errors. What elements mean is the
// caller's.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace binpick {

struct PlyScalar {
  enum class Kind { kSigned, kUnsigned, kReal };
  Kind kind = Kind::kReal;
  std::size_t size = 0;  ///< bytes
};

struct PlyProperty {
  std::string name;
  PlyScalar value;
  bool is_list = false;
  PlyScalar count;
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  std::string format;
  std::vector<PlyElement> elements;
  std::size_t size = 0;  ///< bytes up to the data
};

/// The values after the header, one after another. Every call throws AssetError when the bytes do not hold it.
class PlyValues {
 public:
  virtual ~PlyValues() = default;
  virtual double next(const PlyScalar& type) = 0;
  virtual void begin_record() {}
  virtual void end_record() {}
  virtual void end() = 0;
  virtual std::string place() const = 0;
};

/// Throws AssetError.
PlyHeader read_ply_header(const std::string& bytes, const std::string& path);
/// `bytes`, `path` and `header` must outlive the values. Throws AssetError for an unknown format.
std::unique_ptr<PlyValues> ply_values(const std::string& bytes, const std::string& path, const PlyHeader& header);

}  // namespace binpick

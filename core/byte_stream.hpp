// Values as bytes and back, for caches: in this machine's layout, so never for files that travel. What is read is not
// trusted: every length is held against what is left before anything is taken or allocated, and the first mistake makes
// the reader fail for good. It hands out zeros from then on; whoever reads asks done() at the end.
//
//   ByteWriter out;  out.add(spacing).add(points);   const std::string& bytes = out.bytes();
//   ByteReader in(bytes);  in.get(spacing).get(points);   if (!in.done()) recompute();
//
// Plain values are numbers and structs of numbers without holes (a hole would make equal values unequal bytes); bool
// and enums are not plain, as not all bytes are one of them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace binpick {

template <class T>
concept FixedMatrix = requires {
  typename T::Scalar;
  requires(T::SizeAtCompileTime > 0);
  requires sizeof(T) == T::SizeAtCompileTime * sizeof(typename T::Scalar);
  requires std::is_arithmetic_v<typename T::Scalar>;
};
template <class T>
concept LooksElsewhere = std::is_pointer_v<T> || requires(T t) {
  t.data();
  requires !requires { std::tuple_size<T>::value; };  // std::array holds what it hands out
};
template <class T>
concept PlainValue = FixedMatrix<T> ||
    (std::is_trivially_copyable_v<T> && !std::is_same_v<T, bool> && !std::is_enum_v<T> && !LooksElsewhere<T>);

class ByteWriter {
 public:
  template <PlainValue T>
  ByteWriter& add(const T& value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T));
    return *this;
  }
  template <PlainValue T>
  ByteWriter& add(const std::vector<T>& values) {
    add(static_cast<std::uint64_t>(values.size()));
    if (!values.empty()) bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    return *this;
  }
  ByteWriter& add(std::string_view text) {
    add(static_cast<std::uint64_t>(text.size()));
    bytes_.append(text);
    return *this;
  }
  void reserve(std::size_t size) { bytes_.reserve(size); }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

class ByteReader {
 public:
  /// Looks into `bytes`, which must outlive the reader.
  explicit ByteReader(std::string_view bytes) : left_(bytes) {}

  template <PlainValue T>
  ByteReader& get(T& value) {
    take(&value, 1, sizeof(T));
    return *this;
  }
  template <PlainValue T>
  T get() {
    T value;
    get(value);
    return value;
  }
  template <PlainValue T>
  ByteReader& get(std::vector<T>& values) {
    const std::uint64_t count = length(sizeof(T));
    values.resize(static_cast<std::size_t>(count));
    if (count > 0) take(values.data(), static_cast<std::size_t>(count), sizeof(T));
    return *this;
  }
  ByteReader& get(std::string& text) {
    text.resize(static_cast<std::size_t>(length(1)));
    if (!text.empty()) take(text.data(), text.size(), 1);
    return *this;
  }
  /// A length that was written before `size` bytes a piece; zero, and failure, when so much is not left.
  std::uint64_t length(std::size_t size) {
    const auto count = get<std::uint64_t>();
    if (count <= left_.size() / size) return count;
    fail();
    return 0;
  }
  void fail() {
    ok_ = false;
    left_ = {};
  }
  bool ok() const { return ok_; }
  /// Everything asked for was there, and nothing is left over.
  bool done() const { return ok_ && left_.empty(); }

 private:
  void take(void* to, std::size_t count, std::size_t size) {
    const std::size_t wanted = count * size;
    if (wanted > left_.size()) {
      fail();
      std::memset(to, 0, wanted);
      return;
    }
    std::memcpy(to, left_.data(), wanted);
    left_.remove_prefix(wanted);
  }
  std::string_view left_;
  bool ok_ = true;
};

}  // namespace binpick

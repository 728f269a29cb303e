#include "core/hash.hpp"

#include <bit>
#include <charconv>

#include "core/error.hpp"

namespace binpick {

Hasher& Hasher::bytes(const void* data, std::size_t size) {
  const auto* p = static_cast<const unsigned char*>(data);
  for (std::size_t i = 0; i < size; ++i) state_ = (state_ ^ p[i]) * 1099511628211ull;
  return *this;
}

Hasher& Hasher::add(std::uint64_t value) {
  unsigned char little[8];
  for (int i = 0; i < 8; ++i) little[i] = static_cast<unsigned char>(value >> (8 * i));
  return bytes(little, 8);
}

Hasher& Hasher::add(double value) { return add(std::bit_cast<std::uint64_t>(value == 0 ? 0.0 : value)); }

Hasher& Hasher::add(std::string_view text) {
  add(static_cast<std::uint64_t>(text.size()));
  return bytes(text.data(), text.size());
}

Hasher& Hasher::add(const Pose& pose) {
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c) add(pose.matrix()(r, c));
  return *this;
}

std::uint64_t Hasher::value() const {
  // FNV alone leaves the high bits of short inputs weak; the finaliser of SplitMix64 spreads them.
  std::uint64_t z = state_ + 0x9e3779b97f4a7c15ull;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

std::string hex(std::uint64_t value) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string text(16, '0');
  for (int i = 15; i >= 0; --i, value >>= 4) text[static_cast<std::size_t>(i)] = kDigits[value & 15];
  return text;
}

std::uint64_t from_hex(const std::string& text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  if (error != std::errc() || end != text.data() + text.size() || text.size() != 16)
    throw SpecError("'" + text + "' is not a hash of 16 hexadecimal digits");
  return value;
}

}  // namespace binpick

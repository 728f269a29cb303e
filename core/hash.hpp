// A 64-bit hash of canonical bytes (FNV-1a, then a finaliser): names states, frames and scenarios. Not cryptographic.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/pose.hpp"

namespace binpick {

class Hasher {
 public:
  Hasher& bytes(const void* data, std::size_t size);
  Hasher& add(std::uint64_t value);
  Hasher& add(double value);           ///< IEEE bits; -0 and 0 are one
  Hasher& add(std::string_view text);  ///< length first
  Hasher& add(const Pose& pose);
  std::uint64_t value() const;

 private:
  std::uint64_t state_ = 14695981039346656037ull;
};

/// Sixteen hexadecimal digits.
std::string hex(std::uint64_t value);
std::uint64_t from_hex(const std::string& text);  ///< throws SpecError

}  // namespace binpick

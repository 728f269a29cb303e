// A 128-bit name for a stretch of bytes: MurmurHash3_x64_128 (A. Appleby, public domain), eight bytes at a time where
// Hasher (core/hash.hpp) takes one. Wide enough that two different contents never share a name by chance; not
// cryptographic, so it does not keep out somebody who wants them to.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace binpick {

struct ContentHash {
  std::uint64_t high = 0, low = 0;

  bool operator==(const ContentHash&) const = default;
  std::string hex() const;  ///< 32 digits
};

ContentHash content_hash(std::string_view bytes);

}  // namespace binpick

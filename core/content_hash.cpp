#include "core/content_hash.hpp"

#include <bit>
#include <cstring>

#include "core/hash.hpp"

namespace binpick {
namespace {

constexpr std::uint64_t kFirst = 0x87c37b91114253d5ull, kSecond = 0x4cf5ad432745937full;

std::uint64_t word_at(const char* bytes, std::size_t size) {
  std::uint64_t word = 0;
  std::memcpy(&word, bytes, size);
  return word;
}

std::uint64_t mixed_first(std::uint64_t k) { return std::rotl(k * kFirst, 31) * kSecond; }
std::uint64_t mixed_second(std::uint64_t k) { return std::rotl(k * kSecond, 33) * kFirst; }

std::uint64_t finished(std::uint64_t k) {
  k = (k ^ (k >> 33)) * 0xff51afd7ed558ccdull;
  k = (k ^ (k >> 33)) * 0xc4ceb9fe1a85ec53ull;
  return k ^ (k >> 33);
}

}  // namespace

std::string ContentHash::hex() const { return binpick::hex(high) + binpick::hex(low); }

ContentHash content_hash(std::string_view bytes) {
  static_assert(std::endian::native == std::endian::little);
  std::uint64_t h1 = 0, h2 = 0;
  std::size_t i = 0;
  for (; i + 16 <= bytes.size(); i += 16) {
    h1 ^= mixed_first(word_at(bytes.data() + i, 8));
    h1 = (std::rotl(h1, 27) + h2) * 5 + 0x52dce729;
    h2 ^= mixed_second(word_at(bytes.data() + i + 8, 8));
    h2 = (std::rotl(h2, 31) + h1) * 5 + 0x38495ab5;
  }
  const std::size_t rest = bytes.size() - i;
  if (rest > 8) h2 ^= mixed_second(word_at(bytes.data() + i + 8, rest - 8));
  if (rest > 0) h1 ^= mixed_first(word_at(bytes.data() + i, rest < 8 ? rest : 8));
  h1 ^= bytes.size();
  h2 ^= bytes.size();
  h1 += h2;
  h2 += h1;
  h1 = finished(h1);
  h2 = finished(h2);
  h1 += h2;
  h2 += h1;
  return {h1, h2};
}

}  // namespace binpick

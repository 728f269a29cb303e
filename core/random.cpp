#include "core/random.hpp"

#include <Random123/philox.h>

#include <cmath>
#include <numbers>

#include "core/check.hpp"

namespace binpick {
namespace {

// FNV-1a, 64 bit: turns a stream's name into a number. Only ever a counter under Philox, never a random number itself.
std::uint64_t name_number(std::string_view name) {
  std::uint64_t h = 14695981039346656037ull;
  for (const char c : name) h = (h ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  return h;
}

r123::Philox4x32::ctr_type philox(std::uint64_t key, std::uint64_t high, std::uint64_t low) {
  const r123::Philox4x32::ctr_type counter = {{static_cast<std::uint32_t>(low), static_cast<std::uint32_t>(low >> 32),
                                               static_cast<std::uint32_t>(high),
                                               static_cast<std::uint32_t>(high >> 32)}};
  const r123::Philox4x32::key_type words = {{static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(key >> 32)}};
  return r123::Philox4x32()(counter, words);
}

}  // namespace

Seed Seed::child(std::string_view name, std::uint64_t index) const {
  const auto words = philox(key, name_number(name), index);
  return Seed{static_cast<std::uint64_t>(words[1]) << 32 | words[0]};
}

Rng Rng::at(std::uint64_t item) const {
  Rng rng(key_);
  rng.item_ = item + 1;  // item 0 of at() differs from the plain stream
  return rng;
}

void Rng::refill() {
  const auto words = philox(key_, item_, block_++);
  for (int i = 0; i < 4; ++i) words_[i] = words[static_cast<std::size_t>(i)];
  left_ = 4;
}

std::uint32_t Rng::next_u32() {
  if (left_ == 0) refill();
  return words_[4 - left_--];
}

std::uint64_t Rng::next_u64() {
  const std::uint64_t low = next_u32();
  return static_cast<std::uint64_t>(next_u32()) << 32 | low;
}

double Rng::uniform() { return static_cast<double>(next_u64() >> 11) * 0x1.0p-53; }

double Rng::uniform(double low, double high) { return low + (high - low) * uniform(); }

std::uint64_t Rng::below(std::uint64_t n) {
  BP_CHECK(n > 0);
  // Numbers in the incomplete last block are drawn again, so that every remainder is equally likely.
  const std::uint64_t limit = ~std::uint64_t{0} - (~std::uint64_t{0} % n + 1) % n;
  std::uint64_t x = next_u64();
  while (x > limit) x = next_u64();
  return x % n;
}

double Rng::normal() {
  if (has_spare_normal_) {
    has_spare_normal_ = false;
    return spare_normal_;
  }
  const double radius = std::sqrt(-2 * std::log(1 - uniform()));  // 1 - u lies in (0, 1]
  const double angle = 2 * std::numbers::pi * uniform();
  spare_normal_ = radius * std::sin(angle);
  has_spare_normal_ = true;
  return radius * std::cos(angle);
}

double Rng::normal(double mean, double sigma) { return mean + sigma * normal(); }

Eigen::Vector3d Rng::unit_vector() {
  const double z = uniform(-1, 1);
  const double angle = uniform(0, 2 * std::numbers::pi);
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

Eigen::Quaterniond Rng::rotation() {
  const double u = uniform(), a = uniform(0, 2 * std::numbers::pi), b = uniform(0, 2 * std::numbers::pi);
  const double r = std::sqrt(1 - u), s = std::sqrt(u);
  return {s * std::cos(b), r * std::sin(a), r * std::cos(a), s * std::sin(b)};
}

}  // namespace binpick

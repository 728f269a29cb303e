// Randomness with names. A Seed is a 64-bit key; child("drop", k) hashes key, name and index into a new key; an Rng
// counts from zero under its key (Philox 4x32-10, counter based), so that adding, removing or reordering consumers,
// loops or threads changes no other stream. <random> distributions, rand and clocks are banned.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <string_view>
#include <vector>

namespace binpick {

/// Counter-based generator of one stream. Copying an Rng copies its position.
class Rng {
 public:
  explicit Rng(std::uint64_t key) : key_(key) {}

  /// The generator of item i of the same stream: independent of every other item and of the order of visits.
  Rng at(std::uint64_t item) const;

  std::uint32_t next_u32();
  std::uint64_t next_u64();
  double uniform();                         ///< [0, 1), 53 bits
  double uniform(double low, double high);  ///< [low, high)
  std::uint64_t below(std::uint64_t n);     ///< 0 .. n-1, without bias; n > 0
  double normal();                          ///< mean 0, standard deviation 1 (Box-Muller)
  double normal(double mean, double sigma);
  Eigen::Vector3d unit_vector();  ///< uniform on the sphere
  Eigen::Quaterniond rotation();  ///< uniform on SO(3) (Shoemake)

  /// Fisher-Yates.
  template <class T>
  void shuffle(std::vector<T>& items) {
    for (std::size_t i = items.size(); i > 1; --i) std::swap(items[i - 1], items[below(i)]);
  }

 private:
  void refill();
  std::uint64_t key_;
  std::uint64_t item_ = 0;
  std::uint64_t block_ = 0;
  std::uint32_t words_[4] = {0, 0, 0, 0};
  int left_ = 0;
  bool has_spare_normal_ = false;
  double spare_normal_ = 0;
};

/// A named key. Every consumer of randomness names its stream: seed.child("drop").child("part", k).
struct Seed {
  std::uint64_t key = 0;

  Seed child(std::string_view name, std::uint64_t index = 0) const;
  Rng rng() const { return Rng(key); }
  bool operator==(const Seed&) const = default;
};

}  // namespace binpick

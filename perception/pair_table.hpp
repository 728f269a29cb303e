// The model's pairs, found by the cell of their feature (paper 4): a direct-index table with the entries of a cell side
// by side. One entry is 32 bits: reference (16 bit) and the pair's angle alpha about the reference's normal (16 bit of
// a turn). References are reduced by the part's symmetry: of all points that the symmetry carries into each other only
// one stays, so that a ring votes for one pose, not for a whole orbit of equal ones.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/byte_stream.hpp"
#include "core/point_cloud.hpp"
#include "core/symmetry.hpp"
#include "perception/pair_entry.hpp"
#include "perception/pair_feature.hpp"

namespace binpick {

class PairTable {
 public:
  PairTable() = default;
  /// `model_P` with normals; points closer than `same` (m) after a symmetry count as the same reference. `views`: of
  /// each point, the views that show it; then a pair needs one that shows both. Empty: all pairs.
  PairTable(const PointCloud& model_P, const Symmetry& symmetry, const PairQuantiser& quantiser, double same,
            std::span<const std::uint64_t> views = {});
  /// What write() wrote of a table with this quantiser; the reader has failed when it cannot be, and the table is
  /// empty.
  PairTable(ByteReader& in, const PairQuantiser& quantiser);
  void write(ByteWriter& out) const;

  std::span<const PairEntry> entries(int cell) const {
    return {entries_.data() + first_[cell], entries_.data() + first_[cell + 1]};
  }
  const std::vector<PairEntry>& all_entries() const { return entries_; }
  /// first()[c] .. first()[c + 1]: the entries of cell c among all_entries().
  const std::vector<std::uint32_t>& first() const { return first_; }
  const PairQuantiser& quantiser() const { return quantiser_; }
  const std::vector<OrientedPoint>& references() const { return references_; }
  /// Most entries that one cell holds of one reference: what a single pair can add to one counter.
  std::uint32_t most_of_one() const { return most_of_one_; }
  std::size_t entry_count() const { return entries_.size(); }
  std::size_t bytes() const { return entries_.size() * sizeof(PairEntry) + first_.size() * sizeof(std::uint32_t); }

 private:
  bool consistent() const;
  void count_repeats();
  PairQuantiser quantiser_;
  std::vector<OrientedPoint> references_;
  std::vector<std::uint32_t> first_ = {0};
  std::vector<PairEntry> entries_;
  std::uint32_t most_of_one_ = 0;
};

}  // namespace binpick

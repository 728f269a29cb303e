// Private to voting: the accumulator (model reference, alpha) of one scene reference and the loops over it, for wide
// registers. Free of Eigen. A row is a model reference, its 32 columns are the angles: 11.25 degrees each, a power of
// two so that 1/65536 turns wrap around by themselves.
#pragma once

#include <cstddef>
#include <cstdint>

#include "perception/pair_entry.hpp"

namespace binpick {

constexpr int kAngles = 32;      ///< columns of the accumulator
constexpr int kAngleShift = 11;  ///< 65536 / 32 = 2^11

/// Pairs of one scene reference that have a cell: the cell and the scene's angle alpha (0 .. 65535).
struct CellPairs {
  const int* cell;
  const int* alpha;
  int count;
};

/// Keeps the pairs whose cell is not negative, in their order; in place. Returns how many.
int compact_pairs(int* cell, int* alpha, int count);

/// The model's table as the kernel reads it: entries of cell c are entry[first[c]] .. entry[first[c + 1] - 1].
struct TableView {
  const std::uint32_t* first;
  const PairEntry* entry;
  std::uint32_t largest;  ///< cells with more entries are skipped
  std::uint32_t full;     ///< cells with more are thinned to about so many, which then weigh less
};

/// Adds a vote for every entry of every pair's cell. Votes is the accumulator, rows of kAngles.
void cast_votes(const TableView& table, const CellPairs& pairs, std::uint16_t* votes);
void cast_votes(const TableView& table, const CellPairs& pairs, std::uint32_t* votes);

/// maxima[r] = most votes in row r; returns the most of all.
std::uint32_t row_maxima(const std::uint16_t* votes, std::size_t rows, std::uint16_t* maxima);
std::uint32_t row_maxima(const std::uint32_t* votes, std::size_t rows, std::uint32_t* maxima);

}  // namespace binpick

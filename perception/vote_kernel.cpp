#include "perception/vote_kernel.hpp"

#include <algorithm>

namespace binpick {
namespace {

template <class Votes>
void add_entries(const PairEntry* entry, std::uint32_t count, std::uint32_t step, int alpha, Votes* __restrict votes) {
  const auto turned = static_cast<std::uint16_t>(alpha + (1 << (kAngleShift - 1)));  // columns are centred
  for (std::uint32_t k = 0; k < count; k += step) {
    const PairEntry e = entry[k];
    ++votes[static_cast<std::uint32_t>(e.reference) * kAngles +
            (static_cast<std::uint16_t>(turned - e.alpha) >> kAngleShift)];
  }
}

template <class Votes>
void cast(const TableView& table, const CellPairs& pairs, Votes* votes) {
  constexpr int kAhead = 12;  // pairs; the two look-ups of a pair miss the first cache
  for (int k = 0; k < pairs.count; ++k) {
    if (k + 2 * kAhead < pairs.count) __builtin_prefetch(table.first + pairs.cell[k + 2 * kAhead]);
    if (k + kAhead < pairs.count) __builtin_prefetch(table.entry + table.first[pairs.cell[k + kAhead]]);
    const std::uint32_t first = table.first[pairs.cell[k]], count = table.first[pairs.cell[k] + 1] - first;
    if (count > table.largest) continue;
    if (count <= table.full) {
      add_entries(table.entry + first, count, 1, pairs.alpha[k], votes);
    } else {
      // Every n-th entry, beginning elsewhere for every pair: over all pairs each entry counts 1/n.
      const std::uint32_t step = (count + table.full - 1) / table.full, from = static_cast<std::uint32_t>(k) % step;
      add_entries(table.entry + first + from, count - from, step, pairs.alpha[k], votes);
    }
  }
}

template <class Votes>
std::uint32_t maxima_of(const Votes* __restrict votes, std::size_t rows, Votes* __restrict maxima) {
  Votes most = 0;
  for (std::size_t r = 0; r < rows; ++r) {
    Votes best = 0;
    for (int c = 0; c < kAngles; ++c) best = std::max(best, votes[r * kAngles + c]);
    maxima[r] = best;
    most = std::max(most, best);
  }
  return most;
}

}  // namespace

int compact_pairs(int* cell, int* alpha, int count) {
  int kept = 0;
  for (int k = 0; k < count; ++k) {
    cell[kept] = cell[k];
    alpha[kept] = alpha[k];
    kept += cell[k] >= 0;
  }
  return kept;
}

void cast_votes(const TableView& table, const CellPairs& pairs, std::uint16_t* votes) { cast(table, pairs, votes); }
void cast_votes(const TableView& table, const CellPairs& pairs, std::uint32_t* votes) { cast(table, pairs, votes); }

std::uint32_t row_maxima(const std::uint16_t* votes, std::size_t rows, std::uint16_t* maxima) {
  return maxima_of(votes, rows, maxima);
}
std::uint32_t row_maxima(const std::uint32_t* votes, std::size_t rows, std::uint32_t* maxima) {
  return maxima_of(votes, rows, maxima);
}

}  // namespace binpick

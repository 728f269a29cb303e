// Private to this folder: quantiles of values that come in piles, where a pile may count several times or not at all (a
// bootstrap over piles). The q-quantile is the smallest value that at least a share q of the values does not exceed, so
// that infinite values are values like others.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "evaluation/pile_figures.hpp"

namespace binpick {

class WeightedQuantile {
 public:
  using Values = std::function<std::vector<double>(const PileFigures&)>;

  WeightedQuantile(const std::vector<const PileFigures*>& piles, const Values& values) { add(piles, values); }

  void add(const std::vector<const PileFigures*>& piles, const Values& values) {
    sizes_.resize(std::max(sizes_.size(), piles.size()), 0);
    for (std::size_t k = 0; k < piles.size(); ++k) {
      const std::vector<double> of_pile = values(*piles[k]);
      sizes_[k] += static_cast<double>(of_pile.size());
      for (const double value : of_pile) sorted_.emplace_back(value, k);
    }
    std::stable_sort(sorted_.begin(), sorted_.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  }

  /// NaN of nothing.
  double quantile(double q) const {
    if (sorted_.empty()) return std::numeric_limits<double>::quiet_NaN();
    const double rank = std::ceil(q * static_cast<double>(sorted_.size()) - 1e-9);
    return sorted_[static_cast<std::size_t>(std::max(1.0, rank)) - 1].first;
  }
  double quantile(double q, std::span<const int> times) const {
    double total = 0;
    for (std::size_t k = 0; k < sizes_.size(); ++k) total += times[k] * sizes_[k];
    if (total <= 0) return std::numeric_limits<double>::quiet_NaN();
    const double rank = std::max(1.0, std::ceil(q * total - 1e-9));
    double below = 0;
    for (const auto& [value, pile] : sorted_) {
      below += times[pile];
      if (below >= rank) return value;
    }
    return sorted_.back().first;
  }

 private:
  std::vector<std::pair<double, std::size_t>> sorted_;
  std::vector<double> sizes_;
};

}  // namespace binpick

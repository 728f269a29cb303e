#include "core/box_tree.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

namespace binpick {
namespace {

constexpr std::uint32_t kLeafSize = 4;
constexpr std::size_t kBins = 16;
constexpr std::size_t kDepthOfHalving = 64;  ///< below this depth halves are equal, which bounds the rest by 32 levels

double half_area(const Eigen::AlignedBox3d& box) {
  if (box.isEmpty()) return 0;
  const Eigen::Vector3d s = box.sizes();
  return s.x() * s.y() + s.y() * s.z() + s.z() * s.x();
}

class Builder {
 public:
  explicit Builder(const std::vector<Eigen::AlignedBox3d>& boxes) : boxes_(boxes) {
    for (const auto& box : boxes) centers_.push_back(box.center());
    tree_.items.resize(boxes.size());
    std::iota(tree_.items.begin(), tree_.items.end(), 0u);
    if (!boxes.empty()) build(0, static_cast<std::uint32_t>(boxes.size()), 0);
  }
  BoxTree take() { return std::move(tree_); }

 private:
  void build(std::uint32_t begin, std::uint32_t end, std::size_t depth) {
    const std::size_t self = tree_.nodes.size();
    BoxTree::Node node{{}, begin, end - begin};
    Eigen::AlignedBox3d centers;
    for (std::uint32_t i = begin; i < end; ++i) {
      node.box.extend(boxes_[tree_.items[i]]);
      centers.extend(centers_[tree_.items[i]]);
    }
    tree_.nodes.push_back(node);
    if (end - begin <= kLeafSize) return;
    const std::uint32_t half = begin + (end - begin) / 2;
    const std::uint32_t middle = depth < kDepthOfHalving ? split(begin, end, centers) : half;
    build(begin, middle, depth + 1);
    tree_.nodes[self].begin = static_cast<std::uint32_t>(tree_.nodes.size());
    tree_.nodes[self].count = 0;
    build(middle, end, depth + 1);
  }

  /// Partitions [begin, end) along the widest axis of the centres; in equal halves when the centres coincide.
  std::uint32_t split(std::uint32_t begin, std::uint32_t end, const Eigen::AlignedBox3d& centers) {
    const std::uint32_t half = begin + (end - begin) / 2;
    Eigen::Index axis = 0;
    const double width = centers.sizes().maxCoeff(&axis);
    if (!(width > 0)) return half;
    const double low = centers.min()[axis];
    const auto bin_of = [&](std::uint32_t item) {
      return std::min(kBins - 1, static_cast<std::size_t>((centers_[item][axis] - low) / width * kBins));
    };
    std::array<Eigen::AlignedBox3d, kBins> boxes;
    std::array<std::uint32_t, kBins> counts = {};
    for (std::uint32_t i = begin; i < end; ++i) {
      const std::size_t bin = bin_of(tree_.items[i]);
      boxes[bin].extend(boxes_[tree_.items[i]]);
      ++counts[bin];
    }
    const std::size_t cut = best_cut(boxes, counts);
    const auto first = tree_.items.begin() + begin;
    const auto middle =
        std::stable_partition(first, tree_.items.begin() + end, [&](std::uint32_t item) { return bin_of(item) < cut; });
    const auto size = static_cast<std::uint32_t>(middle - first);
    return size == 0 || size == end - begin ? half : begin + size;
  }

  /// Bins below the cut go left: the cut of least area x count on both sides.
  static std::size_t best_cut(const std::array<Eigen::AlignedBox3d, kBins>& boxes,
                              const std::array<std::uint32_t, kBins>& counts) {
    std::array<double, kBins> left_cost = {};
    Eigen::AlignedBox3d box;
    std::uint32_t count = 0;
    for (std::size_t cut = 1; cut < kBins; ++cut) {
      box.extend(boxes[cut - 1]);
      count += counts[cut - 1];
      left_cost[cut] = half_area(box) * count;
    }
    box.setEmpty();
    count = 0;
    std::size_t best = kBins / 2;
    double best_cost = std::numeric_limits<double>::infinity();
    for (std::size_t cut = kBins - 1; cut > 0; --cut) {
      box.extend(boxes[cut]);
      count += counts[cut];
      const double cost = left_cost[cut] + half_area(box) * count;
      if (cost < best_cost) {
        best_cost = cost;
        best = cut;
      }
    }
    return best;
  }

  const std::vector<Eigen::AlignedBox3d>& boxes_;
  std::vector<Eigen::Vector3d> centers_;
  BoxTree tree_;
};

}  // namespace

BoxTree build_box_tree(const std::vector<Eigen::AlignedBox3d>& boxes) { return Builder(boxes).take(); }

}  // namespace binpick

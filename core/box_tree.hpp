// A tree of bounding boxes over numbered items, split where the surface-area cost is least. Fixed order: the tree
// depends on the boxes and their numbering only. Private to core.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

namespace binpick {

struct BoxTree {
  static constexpr std::size_t kMaxDepth = 100;  ///< no path from the root is longer, so a fixed stack serves

  struct Node {
    Eigen::AlignedBox3d box;
    std::uint32_t begin = 0;  ///< leaf: first entry of `items`; inner: its second child (the first one follows it)
    std::uint32_t count = 0;  ///< entries of a leaf; 0: inner
  };
  std::vector<Node> nodes;           ///< root first; empty when there are no boxes
  std::vector<std::uint32_t> items;  ///< numbers of the boxes, leaf by leaf
};

BoxTree build_box_tree(const std::vector<Eigen::AlignedBox3d>& boxes);

}  // namespace binpick

// Nearest of a fixed set of points: a k-d tree, built once per part, in a fixed order.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace binpick {

class VertexTree {
 public:
  explicit VertexTree(std::vector<Eigen::Vector3d> points);

  /// Distance from `query` to the nearest point; infinite when there is none.
  double distance(const Eigen::Vector3d& query) const;

 private:
  void build(std::size_t begin, std::size_t end);
  void search(std::size_t begin, std::size_t end, const Eigen::Vector3d& query, double& best_squared) const;

  std::vector<Eigen::Vector3d> points_;  ///< the middle of every range is its node
  std::vector<std::uint8_t> axis_;       ///< split axis of the node at this place
};

}  // namespace binpick

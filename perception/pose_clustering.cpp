#include "perception/pose_clustering.hpp"

#include <algorithm>
#include <cstdint>

namespace binpick {
namespace {

void sort_by_votes(std::vector<PoseHypothesis>& poses) {
  std::stable_sort(poses.begin(), poses.end(),
                   [](const PoseHypothesis& a, const PoseHypothesis& b) { return a.votes > b.votes; });
}

/// Angle to the nearest symmetric twin, only compared with a limit: axes suffice for parts of revolution.
bool near_in_angle(const Pose& X_1, const Pose& X_2, const Symmetry& symmetry, double limit) {
  if (symmetry.center_P) return true;
  for (const Pose& S : symmetry.finite) {
    if (symmetry.axis) {
      const Eigen::Vector3d a = X_1.linear() * (S.linear() * symmetry.axis->direction_P);
      if (a.dot(X_2.linear() * symmetry.axis->direction_P) > std::cos(limit)) return true;
    } else if (((X_1.linear() * S.linear()).cwiseProduct(X_2.linear())).sum() > 1 + 2 * std::cos(limit)) {
      return true;  // trace of R_1 S R_2^T = 1 + 2 cos(angle)
    }
  }
  return false;
}

/// Clusters by the place of their centre: those of a cell of the limit's size hang in one chain. Cells that fall on the
/// same chain only cost time, since every candidate is compared.
class Places {
 public:
  explicit Places(double distance) : inverse_(1 / distance), head_(kChains, -1) {}

  void add(const Eigen::Vector3d& center) {
    std::int32_t& head = head_[chain_of(cell_of(center))];
    next_.push_back(head);
    head = static_cast<std::int32_t>(next_.size()) - 1;
  }
  /// Calls visit(index) for at least every cluster whose centre lies within the limit, in no particular order.
  template <class Visit>
  void near(const Eigen::Vector3d& center, Visit&& visit) const {
    const Eigen::Array3<std::int64_t> cell = cell_of(center);
    for (int k = 0; k < 27; ++k) {
      const Eigen::Array3<std::int64_t> beside(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
      for (std::int32_t i = head_[chain_of(cell + beside)]; i >= 0; i = next_[static_cast<std::size_t>(i)]) visit(i);
    }
  }

 private:
  static constexpr std::size_t kChains = 1 << 12;
  Eigen::Array3<std::int64_t> cell_of(const Eigen::Vector3d& p) const {
    return (p.array() * inverse_).max(-1e15).min(1e15).floor().cast<std::int64_t>();
  }
  static std::size_t chain_of(const Eigen::Array3<std::int64_t>& cell) {
    const auto part = [&](int k) { return static_cast<std::uint64_t>(cell[k]); };
    return static_cast<std::size_t>((part(0) * 73856093u) ^ (part(1) * 19349663u) ^ (part(2) * 83492791u)) % kChains;
  }
  double inverse_;
  std::vector<std::int32_t> head_, next_;
};

}  // namespace

bool same_pose(const Pose& X_1, const Pose& X_2, const Symmetry& symmetry, const SamePose& limits) {
  if ((X_1 * limits.center_P - X_2 * limits.center_P).squaredNorm() > limits.distance * limits.distance) return false;
  return near_in_angle(X_1, X_2, symmetry, limits.angle);
}

std::vector<PoseHypothesis> cluster_poses(std::vector<PoseHypothesis> poses, const Symmetry& symmetry,
                                          const SamePose& limits) {
  sort_by_votes(poses);
  std::vector<PoseHypothesis> clusters;
  std::vector<Eigen::Vector3d> centers;
  Places places(limits.distance);
  for (const PoseHypothesis& pose : poses) {
    const Eigen::Vector3d center = pose.X_CP * limits.center_P;
    std::int32_t first = -1;  // the earliest that is the same, as if they were tried in turn
    places.near(center, [&](std::int32_t c) {
      const auto i = static_cast<std::size_t>(c);
      if ((first < 0 || c < first) && (centers[i] - center).squaredNorm() <= limits.distance * limits.distance &&
          near_in_angle(clusters[i].X_CP, pose.X_CP, symmetry, limits.angle))
        first = c;
    });
    if (first >= 0) {
      clusters[static_cast<std::size_t>(first)].votes += pose.votes;
      continue;
    }
    places.add(center);
    centers.push_back(center);
    clusters.push_back(pose);
  }
  sort_by_votes(clusters);
  return clusters;
}

}  // namespace binpick

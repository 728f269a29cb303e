#include "robot/obstacle_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "robot/primitive_distance.hpp"

namespace binpick {
namespace {

constexpr double kColumn = 0.02;  // m, edge of a look-up column
constexpr double kVoxel = 0.005;  // m, thinning
constexpr double kSkin = 0.004;   // m, floor and walls as seen, to which three sigma of the camera are added

constexpr double kOverRim = 0.15;  // m, a heap does not stand higher over the bin's rim

struct Voxel {
  std::array<int, 3> key;
  Eigen::Vector3d point;
};

std::vector<Eigen::Vector3d> thinned(std::vector<Voxel>& voxels, int least) {
  std::stable_sort(voxels.begin(), voxels.end(), [](const Voxel& a, const Voxel& b) { return a.key < b.key; });
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < voxels.size();) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    std::size_t j = i;
    for (; j < voxels.size() && voxels[j].key == voxels[i].key; ++j) sum += voxels[j].point;
    if (static_cast<int>(j - i) >= least) points.push_back(sum / static_cast<double>(j - i));
    i = j;
  }
  return points;
}

/// Inside the bin's opening and clear of floor and walls.
bool in_bin(const BinSpec& bin, const Eigen::Vector3d& p_B, double skin) {
  const Eigen::Vector2d half = bin.half_at(p_B.z());
  return std::abs(p_B.x()) < half.x() - skin && std::abs(p_B.y()) < half.y() - skin && p_B.z() > skin &&
         p_B.z() < bin.inner_size.z() + kOverRim;
}

}  // namespace

ObstacleMap::ObstacleMap(std::vector<Eigen::Vector3d> points_W) : points_(std::move(points_W)) {
  if (points_.empty()) return;
  Eigen::Vector2d low = points_[0].head<2>(), high = low;
  for (const Eigen::Vector3d& p : points_) {
    low = low.cwiseMin(p.head<2>());
    high = high.cwiseMax(p.head<2>());
  }
  origin_ = low;
  columns_x_ = static_cast<int>((high.x() - low.x()) / kColumn) + 1;
  columns_y_ = static_cast<int>((high.y() - low.y()) / kColumn) + 1;
  const auto column = [&](const Eigen::Vector3d& p) {
    return static_cast<std::size_t>((p.y() - low.y()) / kColumn) * static_cast<std::size_t>(columns_x_) +
           static_cast<std::size_t>((p.x() - low.x()) / kColumn);
  };
  std::stable_sort(points_.begin(), points_.end(),
                   [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return column(a) < column(b); });
  const std::size_t columns = static_cast<std::size_t>(columns_x_) * static_cast<std::size_t>(columns_y_);
  first_.assign(columns + 1, 0);
  top_.assign(columns, -std::numeric_limits<double>::infinity());
  for (const Eigen::Vector3d& p : points_) {
    ++first_[column(p) + 1];
    top_[column(p)] = std::max(top_[column(p)], p.z());
  }
  for (std::size_t c = 0; c < columns; ++c) first_[c + 1] += first_[c];
}

std::vector<std::uint32_t> ObstacleMap::candidates(const Eigen::Vector3d& center_W, const Eigen::Vector3d& half) const {
  std::vector<std::uint32_t> out;
  if (points_.empty()) return out;
  const auto index = [](double offset, int count) {
    return std::clamp(static_cast<int>(std::floor(offset / kColumn)), 0, count - 1);
  };
  const Eigen::Vector2d low = center_W.head<2>() - half.head<2>() - origin_, high = low + 2 * half.head<2>();
  if (high.x() < 0 || high.y() < 0 || low.x() > columns_x_ * kColumn || low.y() > columns_y_ * kColumn) return out;
  for (int y = index(low.y(), columns_y_); y <= index(high.y(), columns_y_); ++y) {
    for (int x = index(low.x(), columns_x_); x <= index(high.x(), columns_x_); ++x) {
      const auto c = static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_x_) + static_cast<std::size_t>(x);
      if (top_[c] < center_W.z() - half.z()) continue;
      for (std::uint32_t i = first_[c]; i < first_[c + 1]; ++i) out.push_back(i);
    }
  }
  return out;
}

bool ObstacleMap::touches(const Primitive& shape, const Pose& X_WO, double clearance,
                          const std::vector<char>& ignored) const {
  const Pose X_WS = X_WO * shape.X_OS, X_SW = X_WS.inverse();
  const Eigen::Vector3d half = half_extents_W(shape, X_WS.linear()) + Eigen::Vector3d::Constant(clearance);
  bool touched = false;
  for_each_in(X_WS.translation(), half, [&](std::uint32_t i) {
    if (!touched && (ignored.empty() || !ignored[i])) touched = signed_distance_S(shape, X_SW * points_[i]) < clearance;
  });
  return touched;
}

/// Points with fewer than two others nearby float in the air: mixed pixels at edges, not a surface.
static std::vector<Eigen::Vector3d> without_loners(const std::vector<Eigen::Vector3d>& points) {
  constexpr double kNear = 0.010;  // m, two cells of the thinning grid
  const ObstacleMap map(points);
  std::vector<Eigen::Vector3d> kept;
  for (const Eigen::Vector3d& p : map.points_W()) {
    int near = -1;  // itself
    map.for_each_in(p, Eigen::Vector3d::Constant(kNear), [&](std::uint32_t) { ++near; });
    if (near >= 2) kept.push_back(p);
  }
  return kept;
}

ObstacleMap perceived_heap(const SceneView& view, const Pose& X_WC) {
  const bool frame = std::holds_alternative<DepthFrame>(view.seen);
  const PointCloud cloud_C = frame ? unproject(std::get<DepthFrame>(view.seen)) : std::get<PointCloud>(view.seen);
  const Pose X_BC = view.X_CB.inverse();
  std::vector<Voxel> voxels;
  for (const Eigen::Vector3d& p_C : cloud_C.points) {
    const Eigen::Vector3d p_W = X_WC * p_C;
    const double skin = kSkin + 3 * view.noise().sigma(p_C.z());
    if (view.bin ? !in_bin(*view.bin, X_BC * p_C, skin) : p_W.z() < skin) continue;
    const Eigen::Vector3d at = p_W / kVoxel;
    voxels.push_back({{static_cast<int>(std::floor(at.x())), static_cast<int>(std::floor(at.y())),
                       static_cast<int>(std::floor(at.z()))},
                      p_W});
  }
  const bool noisy = frame || view.noise().sigma(1.0) > 0;  // not a cloud that somebody has cleaned
  const std::vector<Eigen::Vector3d> points = thinned(voxels, noisy ? 3 : 1);
  return ObstacleMap(noisy ? without_loners(points) : points);
}

}  // namespace binpick

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/check.hpp"
#include "perception/preprocess.hpp"

namespace binpick {
namespace {

constexpr float kSameSide = 0.7f;  // cosine: normals further apart stay two points

struct Keyed {
  std::uint64_t key;
  std::uint32_t index;
};

std::uint64_t voxel_key(const Eigen::Vector3f& p, float inverse) {
  std::uint64_t key = 0;
  for (int i = 0; i < 3; ++i) {
    const auto c = static_cast<std::int64_t>(std::floor(p[i] * inverse)) + (1 << 20);
    key = (key << 21) | static_cast<std::uint64_t>(std::clamp<std::int64_t>(c, 0, (1 << 21) - 1));
  }
  return key;
}

/// Means of the points of one voxel, one for each side.
struct Side {
  Eigen::Vector3f first, point, normal;
  int count;
};

void add_to_sides(std::vector<Side>& sides, const Eigen::Vector3f& p, const Eigen::Vector3f& n) {
  for (Side& side : sides)
    if (side.first.dot(n) > kSameSide) {
      side.point += p;
      side.normal += n;
      ++side.count;
      return;
    }
  sides.push_back({n, p, n, 1});
}

PointCloud grid(const std::vector<Eigen::Vector3f>& points, const std::vector<Eigen::Vector3f>& normals, double voxel) {
  const float inverse = static_cast<float>(1 / voxel);
  std::vector<Keyed> keyed(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    keyed[i] = {voxel_key(points[i], inverse), static_cast<std::uint32_t>(i)};
  std::sort(keyed.begin(), keyed.end(),
            [](const Keyed& a, const Keyed& b) { return a.key != b.key ? a.key < b.key : a.index < b.index; });
  PointCloud out;
  std::vector<Side> sides;
  for (std::size_t i = 0; i < keyed.size();) {
    sides.clear();
    const std::uint64_t key = keyed[i].key;
    for (; i < keyed.size() && keyed[i].key == key; ++i)
      add_to_sides(sides, points[keyed[i].index], normals[keyed[i].index]);
    for (const Side& side : sides) {
      out.points.push_back((side.point / static_cast<float>(side.count)).cast<double>());
      out.normals.push_back(side.normal.normalized().cast<double>());
    }
  }
  return out;
}

}  // namespace

PointCloud voxel_grid(const Scene& scene, double voxel) {
  std::vector<Eigen::Vector3f> points, normals;
  for (int v = 0; v < scene.depth.height(); ++v)
    for (int u = 0; u < scene.depth.width(); ++u)
      if (scene.wanted(u, v) && !scene.normals(u, v).isZero()) {
        points.push_back(scene.point(u, v, scene.depth(u, v)));
        normals.push_back(scene.normals(u, v));
      }
  return grid(points, normals, voxel);
}

PointCloud voxel_grid(const PointCloud& cloud, double voxel) {
  BP_CHECK(cloud.has_normals() || cloud.points.empty());
  std::vector<Eigen::Vector3f> points, normals;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    points.push_back(cloud.points[i].cast<float>());
    normals.push_back(cloud.normals[i].cast<float>());
  }
  return grid(points, normals, voxel);
}

}  // namespace binpick

#include "sim/silhouette.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace binpick {
namespace {

constexpr double kNearest = 1e-3;  // m

// Pixels of a window whose upper left one is (u0, v0) of the camera's grid.
class Mask {
 public:
  Mask(int u0, int v0, int width, int height)
      : u0_(u0), v0_(v0), width_(width), height_(height), covered_(static_cast<std::size_t>(width) * height, 0) {}

  void fill(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
    const int first = std::max(ceil_of(std::min({a.y(), b.y(), c.y()})) - v0_, 0);
    const int end = std::min(ceil_of(std::max({a.y(), b.y(), c.y()})) - v0_, height_);
    if (first >= end || ceil_of(std::min({a.x(), b.x(), c.x()})) >= ceil_of(std::max({a.x(), b.x(), c.x()}))) return;
    const std::array<Edge, 3> edges = {Edge(a, b), Edge(b, c), Edge(c, a)};
    for (int row = first; row < end; ++row) {
      const double v = row + v0_;
      double left = std::numeric_limits<double>::infinity(), right = -left;
      for (const Edge& edge : edges) {
        if (!(edge.top <= v && v < edge.bottom)) continue;  // of a triangle's three edges two hold
        const double u = edge.u + (v - edge.v) * edge.slope;
        left = std::min(left, u);
        right = std::max(right, u);
      }
      if (left < right) cover(row, ceil_of(left) - u0_, ceil_of(right) - u0_);
    }
  }
  int count() const {
    int sum = 0;
    for (const std::uint8_t pixel : covered_) sum += pixel;
    return sum;
  }

 private:
  struct Edge {
    Edge(const Eigen::Vector2d& p, const Eigen::Vector2d& q)
        : top(std::min(p.y(), q.y())), bottom(std::max(p.y(), q.y())), u(p.x()), v(p.y()) {
      // From the same end for both triangles at an edge, so that they meet without a gap.
      if (q.y() < p.y()) u = q.x(), v = q.y();
      slope = bottom > top ? (q.x() - p.x()) / (q.y() - p.y()) : 0;
    }
    double top, bottom, u, v, slope = 0;
  };
  // A cast rounds towards zero, hence from the side where all numbers are positive; std::ceil is a call.
  static int ceil_of(double x) {
    constexpr std::int64_t kAway = std::int64_t{1} << 31;
    return static_cast<int>(kAway - static_cast<std::int64_t>(static_cast<double>(kAway) - x));
  }
  void cover(int row, int first, int end) {
    first = std::max(first, 0);
    end = std::min(end, width_);
    for (int u = first; u < end; ++u) covered_[static_cast<std::size_t>(row) * width_ + u] = 1;
  }

  int u0_, v0_, width_, height_;
  std::vector<std::uint8_t> covered_;
};

}  // namespace

std::optional<int> silhouette_pixels(const TriangleMesh& mesh_O, const Pose& X_CO, const PinholeCamera& camera) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(mesh_O.vertices.size());
  PixelSpan columns, rows;
  bool some_before = false, some_behind = false;
  for (const Eigen::Vector3d& p_O : mesh_O.vertices) {
    const Eigen::Vector3d p_C = X_CO * p_O;
    const bool before = p_C.z() > kNearest;
    some_before |= before;
    some_behind |= !before;
    points.push_back(before ? camera.project(p_C) : Eigen::Vector2d::Zero());
    columns.add(points.back().x());
    rows.add(points.back().y());
  }
  if (!some_before) return 0;
  if (some_behind) return std::nullopt;
  const int u0 = columns.first(camera.width), v0 = rows.first(camera.height);
  const int width = columns.last(camera.width) - u0 + 1, height = rows.last(camera.height) - v0 + 1;
  if (width < 1 || height < 1) return 0;
  Mask mask(u0, v0, width, height);
  for (const auto& [a, b, c] : mesh_O.triangles) mask.fill(points[a], points[b], points[c]);
  return mask.count();
}

}  // namespace binpick

#include "sim/visibility.hpp"

#include <algorithm>
#include <cmath>

#include "core/check.hpp"

namespace binpick {
namespace {

// The silhouette is drawn on at most this many pixels a side, and for points at least this far in front of the camera.
constexpr int kMaxSide = 4096;
constexpr double kNearest = 1e-3;

// Columns (or rows) that a mesh covers: focal * x / z + centre over its vertices, one pixel wider on both sides.
struct Span {
  double low = 1e9, high = -1e9;
  void add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  int first(int size) const { return static_cast<int>(std::floor(std::max(low, -double(kMaxSide - size) / 2))) - 1; }
  int last(int size) const { return static_cast<int>(std::ceil(std::min(high, double(kMaxSide + size) / 2))) + 1; }
};

int count_id(const Image<std::int32_t>& ids, std::int32_t id) {
  return static_cast<int>(std::count(ids.begin(), ids.end(), id));
}

// Pixels of one item drawn alone. The window lies on the camera's own pixel grid: only whole pixels are added to cx,
// cy.
int silhouette(DepthRenderer& renderer, const RenderItem& item, const PinholeCamera& camera, const Pose& X_WC) {
  const Pose X_CO = X_WC.inverse() * item.X_WO;
  Span columns, rows;
  double nearest = 1e9, farthest = 0;
  for (const Eigen::Vector3d& p_O : item.mesh_O->vertices) {
    Eigen::Vector3d p_C = X_CO * p_O;
    nearest = std::min(nearest, p_C.z());
    farthest = std::max(farthest, p_C.z());
    p_C.z() = std::max(p_C.z(), kNearest);
    const Eigen::Vector2d pixel = camera.project(p_C);
    columns.add(pixel.x());
    rows.add(pixel.y());
  }
  if (farthest <= kNearest) return 0;
  const int first_u = columns.first(camera.width), first_v = rows.first(camera.height);
  PinholeCamera window = camera;
  window.width = columns.last(camera.width) - first_u + 1;
  window.height = rows.last(camera.height) - first_v + 1;
  if (window.width < 1 || window.height < 1) return 0;
  window.cx -= first_u;
  window.cy -= first_v;
  RenderScene alone;
  alone.items.push_back(item);
  const ExactFrame frame =
      renderer.render(alone, window, X_WC, std::max(0.5 * nearest, kNearest), 1.1 * farthest + kNearest);
  return count_id(frame.ids, item.id);
}

}  // namespace

std::vector<Visibility> part_visibility(DepthRenderer& renderer, const RenderScene& scene, const ExactFrame& frame,
                                        const PinholeCamera& camera, const Pose& X_WC, std::size_t parts) {
  std::vector<Visibility> result(parts);
  const auto is_part = [&](std::int32_t id) { return id >= 0 && static_cast<std::size_t>(id) < parts; };
  for (const std::int32_t id : frame.ids)
    if (is_part(id)) ++result[static_cast<std::size_t>(id)].visible_pixels;
  for (const RenderItem& item : scene.items) {
    if (!is_part(item.id) || item.mesh_O->empty()) continue;
    Visibility& part = result[static_cast<std::size_t>(item.id)];
    BP_CHECK(part.silhouette_pixels == 0, "part id " << item.id << " appears twice");
    part.silhouette_pixels = silhouette(renderer, item, camera, X_WC);
    // The rasteriser rounds corners to 1/256 pixel; in another window a border pixel may fall the other way.
    part.silhouette_pixels = std::max(part.silhouette_pixels, part.visible_pixels);
  }
  return result;
}

}  // namespace binpick

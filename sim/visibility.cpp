#include "sim/visibility.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/check.hpp"
#include "core/parallel.hpp"
#include "sim/silhouette.hpp"

namespace binpick {
namespace {

constexpr double kNearest = 1e-3;  // m

int count_id(const Image<std::int32_t>& ids, std::int32_t id) {
  return static_cast<int>(std::count(ids.begin(), ids.end(), id));
}

// Pixels of one item drawn alone, for an item that reaches through the plane of the camera. The window lies on the
// camera's own pixel grid: only whole pixels are added to cx, cy.
int drawn_silhouette(DepthRenderer& renderer, const RenderItem& item, const PinholeCamera& camera, const Pose& X_WC) {
  const Pose X_CO = X_WC.inverse() * item.X_WO;
  PixelSpan columns, rows;
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
                                        const PinholeCamera& camera, const Pose& X_WC, std::size_t parts, int threads) {
  std::vector<Visibility> result(parts);
  const auto is_part = [&](std::int32_t id) { return id >= 0 && static_cast<std::size_t>(id) < parts; };
  for (const std::int32_t id : frame.ids)
    if (is_part(id)) ++result[static_cast<std::size_t>(id)].visible_pixels;
  std::vector<const RenderItem*> items(parts, nullptr);
  for (const RenderItem& item : scene.items) {
    if (!is_part(item.id) || item.mesh_O->empty()) continue;
    BP_CHECK(items[static_cast<std::size_t>(item.id)] == nullptr, "part id " << item.id << " appears twice");
    items[static_cast<std::size_t>(item.id)] = &item;
  }
  const Pose X_CW = X_WC.inverse();
  std::vector<std::optional<int>> counts(parts, 0);
  parallel_for(parts, threads, [&](std::size_t i) {
    if (items[i]) counts[i] = silhouette_pixels(*items[i]->mesh_O, X_CW * items[i]->X_WO, camera);
  });
  for (std::size_t i = 0; i < parts; ++i) {
    const int count = counts[i] ? *counts[i] : drawn_silhouette(renderer, *items[i], camera, X_WC);
    // A renderer rounds corners (OSMesa: to 1/256 pixel); a border pixel may fall the other way.
    result[i].silhouette_pixels = std::max(count, result[i].visible_pixels);
  }
  return result;
}

}  // namespace binpick

#include "perception/bin_finder.hpp"

#include <algorithm>
#include <cmath>

#include "perception/box_search.hpp"

namespace binpick {
namespace {

constexpr double kPatch = 0.011;      // m, edge of a patch
constexpr std::size_t kFewest = 40;   // patches in view
constexpr double kMostBeyond = 0.03;  // of the patches whose rays look into the box
constexpr double kWallSeen = 0.25;    // of the rays that end on a wall: patches that lie there
constexpr double kNear = 0.006;       // m
constexpr double kHidden = 0.27;      // sine: a wall seen more obliquely, or from behind, may be there unseen
constexpr double kWallReach = 0.4, kLongReach = 0.6;  // of a wall's length
constexpr int kFewestOnWall = 8, kFewestOnFloor = 6;
constexpr double kTableShare = 0.15;  // of all patches
constexpr double kReach = 1.3;        // of the largest part
constexpr double kDrafted = 0.0175;   // tangent, a degree
constexpr double kStep = 0.002;       // m, of the histogram that shows where walls end
constexpr double kLowest = 0.011;     // m, height of what has no walls (BinSpec wants some)

struct Range {
  double low = 1e9, high = -1e9;
  void add(double x) { low = std::min(low, x), high = std::max(high, x); }
  double length() const { return std::max(0.0, high - low); }
};

/// How far the patches on each face reach along x and y of H (of a wall: along it).
std::array<std::array<Range, 2>, kBoxFaces> reaches(const OpenBox& box, const Surfels& surfels, double near) {
  std::array<std::array<Range, 2>, kBoxFaces> out;
  const BoxRays rays(box);
  for (const Surfel& s : surfels) {
    const BoxRay ray = rays.of(s);
    if (ray.face < 0 || std::abs(ray.distance) > near) continue;
    const Eigen::Vector3d q = box.R_CH.transpose() * s.p;
    for (int axis = 0; axis < 2; ++axis) out[ray.face][axis].add(q[axis]);
  }
  return out;
}

/// Does enough speak for every wall of the box?
bool walls_certain(const OpenBox& box, const Surfels& surfels, const StatedNoise& noise, double largest_part) {
  const BoxSupport support = support_of(box, surfels, noise);
  const auto reach = reaches(box, surfels, kNear);
  for (int k = 0; k < 4; ++k) {
    if (!box.wall[k]) continue;
    const int beside = k < 2 ? 2 : 0;
    const double length = -box.offset[beside] - box.offset[beside + 1];
    const double seen = reach[k + 1][k < 2 ? 1 : 0].length();
    if (support.on[k + 1] < kFewestOnWall || support.on[k + 1] < kWallSeen * support.rays[k + 1]) return false;
    if (seen < std::max(kWallReach * length, std::min(kLongReach * length, kReach * largest_part))) return false;
  }
  return support.beyond <= kMostBeyond * support.inside() && support.on[0] >= kFewestOnFloor;
}

/// The box with its faces in place; false when it is none for certain.
bool confirm(OpenBox& box, const Surfels& surfels, const StatedNoise& noise, double largest_part) {
  settle_floor(box, surfels);
  box = fitted(box, surfels, noise);
  return walls_certain(box, surfels, noise, largest_part);
}

/// The largest plane that nothing is seen behind.
bool find_table(const Surfels& surfels, const StatedNoise& noise, double largest_part, OpenBox& out) {
  int most = 0;
  for (const Eigen::Vector3d& up : common_normals(surfels)) {
    OpenBox box;
    box.R_CH << up.unitOrthogonal(), up.cross(up.unitOrthogonal()), up;
    std::vector<double> heights;
    for (const Surfel& s : surfels)
      if (s.n.dot(up) > 0.97) heights.push_back(up.dot(s.p));
    for (const double at : offset_peaks(heights, kTableShare * static_cast<double>(surfels.size()))) {
      box.floor = at;
      if (!(at < 0)) continue;
      OpenBox fit = fitted(box, surfels, noise);
      const BoxSupport support = support_of(fit, surfels, noise);
      const auto reach = reaches(fit, surfels, kNear)[0];
      const bool good = support.on[0] > most && support.on[0] > kTableShare * static_cast<double>(surfels.size()) &&
                        support.beyond <= kMostBeyond * support.inside() &&
                        std::hypot(reach[0].length(), reach[1].length()) > kReach * largest_part;
      if (good) most = support.on[0], out = fit;
    }
  }
  return most > 0;
}

/// Height of the walls: where the pixels on them end.
double wall_height(const Scene& scene, const OpenBox& box) {
  std::vector<int> histogram(1000, 0);
  for (int v = 0; v < scene.depth.height(); v += 2)
    for (int u = v % 4 / 2; u < scene.depth.width(); u += 2) {
      if (!(scene.depth(u, v) > 0)) continue;
      const Eigen::Vector3d q =
          box.R_CH.transpose() * scene.camera.unproject(u, v, static_cast<double>(scene.depth(u, v)));
      const int bin = static_cast<int>((q.z() - box.floor) / kStep);
      if (bin < 5 || bin >= static_cast<int>(histogram.size())) continue;
      bool on = false, outside = false;
      for (int k = 0; k < 4; ++k) {
        if (!box.wall[k]) continue;
        const double distance = box.normal(k + 1).dot(q) - box.level(k + 1);
        on |= std::abs(distance) < kNear;
        outside |= distance < -kNear;
      }
      histogram[static_cast<std::size_t>(bin)] += on && !outside;
    }
  std::vector<int> filled;
  for (const int count : histogram)
    if (count > 0) filled.push_back(count);
  if (filled.empty()) return box.height;
  std::nth_element(filled.begin(), filled.begin() + static_cast<std::ptrdiff_t>(filled.size() / 2), filled.end());
  int top = static_cast<int>(histogram.size()) - 1;
  while (top > 0 && 3 * histogram[static_cast<std::size_t>(top)] < filled[filled.size() / 2]) --top;
  return (top + 1) * kStep;
}

/// A side that ends without a wall in view, but would not show it: seen from behind, or too obliquely.
bool hidden_wall(const OpenBox& box, int k) {
  const double middle = box.floor + 0.5 * box.height;
  return !box.wall[k] && box.edge[k] && -box.offset[k] < kHidden * std::hypot(box.offset[k], middle);
}

/// Inner edges along x and y of H at a height; open sides go a part farther than what is seen of them.
std::array<Range, 2> inner_edges(const OpenBox& box, const Surfels& surfels, double height, double largest_part) {
  const auto floor = reaches(box, surfels, kNear)[0];
  std::array<Range, 2> out;
  for (int k = 0; k < 4; ++k) {
    const Range& seen = floor[k / 2];
    double from = box.wall[k] || box.edge[k] ? box.offset[k] : k % 2 == 0 ? seen.low : -seen.high;
    from -= box.wall[k] ? box.slope[k] * height : hidden_wall(box, k) ? 0 : largest_part;
    (k % 2 == 0 ? out[k / 2].low : out[k / 2].high) = k % 2 == 0 ? from : -from;
  }
  return out;
}

FoundBin as_bin(OpenBox box, const Surfels& surfels, double largest_part) {
  FoundBin found;
  for (int k = 0; k < 4; ++k) found.drafted |= box.wall[k] && std::abs(box.slope[k]) > kDrafted;
  const auto edges = inner_edges(box, surfels, found.drafted ? box.height : 0.5 * box.height, largest_part);
  const Eigen::Vector3d centre((edges[0].low + edges[0].high) / 2, (edges[1].low + edges[1].high) / 2, box.floor);
  found.bin.inner_size = {edges[0].length(), edges[1].length(), std::max(kLowest, box.height)};
  found.X_CB = pose_from(box.R_CH, box.R_CH * centre);
  if (edges[0].length() < edges[1].length()) {  // x along the longer side
    found.X_CB = found.X_CB * pose_from(exp_so3({0, 0, std::acos(0.0)}), Eigen::Vector3d::Zero());
    std::swap(found.bin.inner_size.x(), found.bin.inner_size.y());
  }
  found.box = box;
  return found;
}

/// Of something without walls: as high as what stands there.
double highest_patch(const OpenBox& box, const Surfels& surfels) {
  double top = box.floor;
  for (const Surfel& s : surfels) top = std::max(top, box.R_CH.col(2).dot(s.p));
  return top - box.floor;
}

}  // namespace

std::optional<FoundBin> find_bin(const Scene& scene, double largest_part) {
  const Surfels surfels = surfels_of(scene, kPatch);
  if (surfels.size() < kFewest) return std::nullopt;
  for (OpenBox& box : likeliest_boxes(surfels, scene.noise)) {
    if (!confirm(box, surfels, scene.noise, largest_part)) continue;
    box.height = wall_height(scene, box);
    return as_bin(box, surfels, largest_part);
  }
  OpenBox table;
  if (!find_table(surfels, scene.noise, largest_part, table)) return std::nullopt;
  table.height = highest_patch(table, surfels);
  return as_bin(table, surfels, largest_part);
}

void unmark_faces(Scene& scene, const FoundBin& found, double margin) {
  for (int v = 0; v < scene.depth.height(); ++v)
    for (int u = 0; u < scene.depth.width(); ++u) {
      if (!scene.wanted(u, v)) continue;
      const Eigen::Vector3d q =
          found.box.R_CH.transpose() * scene.camera.unproject(u, v, static_cast<double>(scene.depth(u, v)));
      for (int k = 0; k < 4; ++k)
        if (found.box.wall[k] && found.box.normal(k + 1).dot(q) < found.box.level(k + 1) + margin)
          scene.wanted(u, v) = 0;
    }
}

}  // namespace binpick

#include "perception/ray_kernel.hpp"

#include <algorithm>

#include "perception/lanes.hpp"

namespace binpick {
namespace {

using namespace lanes;

/// The pixel of each lane, or -1 outside the image (and for what is NaN).
Ints pixel_of(const Vectors& p, const RayImage& image) {
  const Floats inverse = 1 / p.z;
  const Floats u = p.x * inverse * image.fx + image.cx + 0.5f, v = p.y * inverse * image.fy + image.cy + 0.5f;
  const Ints inside = (p.z > 0.0f) & (u >= 0.0f) & (u < static_cast<float>(image.width)) & (v >= 0.0f) &
                      (v < static_cast<float>(image.height));
  const Ints column = __builtin_convertvector(inside ? u : Floats{}, Ints),
             row = __builtin_convertvector(inside ? v : Floats{}, Ints);
  return inside ? row * image.width + column : Ints{} - 1;
}

/// What the image holds at the pixels; unknown depth outside.
struct Seen {
  Floats depth, wanted;
  Vectors normal;
};
Seen look(const RayImage& image, Ints pixel) {
  alignas(32) std::int32_t index[kLanes];
  alignas(32) float depth[kLanes], wanted[kLanes], n[3][kLanes];
  store(index, pixel);
  for (int i = 0; i < kLanes; ++i) {
    const bool known = index[i] >= 0;
    const auto at = static_cast<std::size_t>(known ? index[i] : 0);
    depth[i] = known ? image.depth[at] : __builtin_nanf("");
    wanted[i] = static_cast<float>(image.wanted[at]);
    for (int k = 0; k < 3; ++k) n[k][i] = image.normals[3 * at + static_cast<std::size_t>(k)];
  }
  return {load(depth), load(wanted), {load(n[0]), load(n[1]), load(n[2])}};
}

Floats tolerance_at(Floats z, Floats facing, const RayQuery& query) {
  const Floats sigma = query.constant + query.linear * z + query.quadratic * z * z;
  const Floats flat = larger(all(query.floor), query.sigmas * sigma);
  return query.widened * flat / larger(all(query.least_slant), facing);
}

}  // namespace

void add_rays(const ModelPointsView& model, const RayImage& image, const RayQuery& query, RaySums& sums) {
  Motion X_CP;
  std::copy_n(query.R_CP, 9, X_CP.R);
  std::copy_n(query.p_CP, 3, X_CP.p);
  Floats tried{}, inliers{}, occluded{}, through{}, unknown{}, off{};
  for (int i = 0; i < model.count; i += kLanes) {
    const Vectors p = moved(X_CP, {load(model.x + i), load(model.y + i), load(model.z + i)});
    const Vectors n = turned(X_CP, {load(model.nx + i), load(model.ny + i), load(model.nz + i)});
    const Floats facing = -dot(n, p) / square_root(dot(p, p));
    const Ints counts = (p.z > 0.0f) & (facing > query.least_facing);
    const Floats weight = counts ? facing : Floats{};
    const Seen seen = look(image, pixel_of(p, image));
    const Floats tolerance = tolerance_at(p.z, facing, query), behind = seen.depth - p.z;
    const Ints known = seen.depth == seen.depth, farther = behind > tolerance, nearer = behind < -tolerance;
    const Ints agrees = known & ~farther & ~nearer, wanted = seen.wanted > 0.0f;
    const Ints normal = (dot(seen.normal, seen.normal) == 0.0f) | (dot(seen.normal, n) >= query.least_normal);
    tried += weight;
    through += known & farther ? weight : Floats{};
    occluded += known & nearer ? weight : Floats{};
    unknown += ~known | (agrees & ~wanted) ? weight : Floats{};
    inliers += agrees & wanted & normal ? weight : Floats{};
    off += agrees & wanted & ~normal ? weight : Floats{};
  }
  sums.tried += static_cast<float>(sum(tried));
  sums.inliers += static_cast<float>(sum(inliers));
  sums.occluded += static_cast<float>(sum(occluded));
  sums.through += static_cast<float>(sum(through));
  sums.unknown += static_cast<float>(sum(unknown));
  sums.off += static_cast<float>(sum(off));
}

}  // namespace binpick

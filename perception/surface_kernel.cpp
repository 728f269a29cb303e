#include "perception/surface_kernel.hpp"

#include <algorithm>
#include <cstddef>

#include "perception/lanes.hpp"

namespace binpick {
namespace {

using namespace lanes;

constexpr int kBlock = 64;  // points between two additions in double
constexpr int kTerms = 30;  // 21 + 6 + 3
constexpr std::int32_t kNone[2] = {-1, -1};
const SurfacePoint kUnseen;  // stands for "no surface point near"

/// A block of scene points in P with their nearest surface points beside them.
struct Block {
  alignas(32) float p[3][kBlock], s[3][kBlock], q[3][kBlock], n[3][kBlock], seen[kBlock];
  alignas(32) std::int32_t cell[kBlock];
};

/// One axis of the grid: whole cell, and whether it lies inside (false for NaN).
Ints cell_of(Floats x, float low, float inverse, std::int32_t size, Ints& inside) {
  const Floats c = (x - low) * inverse;
  inside &= (c >= 0.0f) & (c < static_cast<float>(size));
  const Floats held = inside ? c : Floats{};
  return __builtin_convertvector(held, Ints);
}

void to_model_frame(const ScenePointsView& scene, int first, int count, const SurfaceGrid& grid, const Motion& X_PC,
                    Block& block) {
  for (int i = 0; i < count; i += kLanes) {
    const int k = first + i;
    const Vectors p = moved(X_PC, {load(scene.x + k), load(scene.y + k), load(scene.z + k)});
    const Vectors s = turned(X_PC, {load(scene.nx + k), load(scene.ny + k), load(scene.nz + k)});
    store(block.p[0] + i, p.x), store(block.p[1] + i, p.y), store(block.p[2] + i, p.z);
    store(block.s[0] + i, s.x), store(block.s[1] + i, s.y), store(block.s[2] + i, s.z);
    Ints inside = Ints{} - 1;
    const Ints x = cell_of(p.x, grid.low[0], grid.inverse_cell, grid.size[0], inside);
    const Ints y = cell_of(p.y, grid.low[1], grid.inverse_cell, grid.size[1], inside);
    const Ints z = cell_of(p.z, grid.low[2], grid.inverse_cell, grid.size[2], inside);
    const Ints cell = (z * grid.size[1] + y) * grid.size[0] + x;
    store(block.cell + i, inside ? cell : Ints{} - 1);
  }
}

void look_up(const SurfaceGrid& grid, int view, int count, Block& block) {
  for (int i = 0; i < count; ++i) {
    const std::int32_t* pair = block.cell[i] < 0 ? kNone : grid.cells + 2 * static_cast<std::ptrdiff_t>(block.cell[i]);
    const SurfacePoint& first = pair[0] < 0 ? kUnseen : grid.points[pair[0]];
    const bool turn = pair[1] >= 0 && ((first.views >> view) & 1u) == 0;
    const SurfacePoint& near = turn ? grid.points[pair[1]] : first;
    for (int k = 0; k < 3; ++k) {
      block.q[k][i] = near.p[k];
      block.n[k][i] = near.n[k];
    }
    block.seen[i] = static_cast<float>((near.views >> view) & 1u);
  }
}

void add_lanes(const Block& block, int i, const SurfaceQuery& query, Floats* terms) {
  const auto three = [i](const float(&a)[3][kBlock]) {
    return Vectors{load(a[0] + i), load(a[1] + i), load(a[2] + i)};
  };
  const Vectors p = three(block.p), q = three(block.q), n = three(block.n), s = three(block.s);
  const Vectors eye = {query.p_PC[0] - q.x, query.p_PC[1] - q.y, query.p_PC[2] - q.z}, off = minus(p, q);
  const Floats r = dot(n, off), squared = dot(off, off), r2 = r * r;
  const Ints counts = (load(block.seen + i) > 0.0f) & (dot(n, eye) > 0.0f) & (r2 <= query.gate) &
                      (squared - r2 <= query.sideways) &
                      ((dot(s, s) == 0.0f) | (dot(n, s) >= query.agreement));  // false for NaN
  const Floats x = r * (1 / (query.robust * query.scale));
  const Floats weight = counts ? 1 / (query.scale * query.scale * (1 + x * x)) : Floats{};
  const Floats held = counts ? r : Floats{};
  const Vectors m = {p.y * n.z - p.z * n.y, p.z * n.x - p.x * n.z, p.x * n.y - p.y * n.x};
  Floats a[6] = {n.x, n.y, n.z, m.x, m.y, m.z};
  for (Floats& c : a) c = counts ? c : Floats{};
  int t = 0;
  for (int row = 0; row < 6; ++row) {
    const Floats weighted = weight * a[row];
    for (int column = 0; column <= row; ++column) terms[t++] += weighted * a[column];
  }
  for (int row = 0; row < 6; ++row) terms[t++] += weight * held * a[row];
  terms[t++] += absolute(held);
  terms[t++] += held * held;
  terms[t++] += counts ? all(1.0f) : Floats{};
}

}  // namespace

void add_surface_points(const ScenePointsView& scene, const SurfaceGrid& grid, const SurfaceQuery& query,
                        SurfaceSums& sums) {
  Motion X_PC;
  std::copy_n(query.R_PC, 9, X_PC.R);
  std::copy_n(query.p_PC, 3, X_PC.p);
  Block block;
  for (int first = 0; first < scene.count; first += kBlock) {
    const int count = std::min(kBlock, scene.count - first);
    to_model_frame(scene, first, count, grid, X_PC, block);
    look_up(grid, query.view, count, block);
    Floats terms[kTerms] = {};
    for (int i = 0; i < count; i += kLanes) add_lanes(block, i, query, terms);
    for (int t = 0; t < 21; ++t) sums.A[t] += sum(terms[t]);
    for (int t = 0; t < 6; ++t) sums.b[t] += sum(terms[21 + t]);
    sums.sum_abs += sum(terms[27]);
    sums.sum_squares += sum(terms[28]);
    sums.points += sum(terms[29]);
  }
}

}  // namespace binpick

#include "perception/normal_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace binpick {
namespace {

using Floats = float __attribute__((vector_size(32)));
using Ints = std::int32_t __attribute__((vector_size(32)));
constexpr int kLanes = 8;

Floats load(const float* from) {
  Floats out;
  std::memcpy(&out, from, sizeof out);
  return out;
}
void store(float* to, const Floats& x) { std::memcpy(to, &x, sizeof x); }
Floats all(float x) { return Floats{x, x, x, x, x, x, x, x}; }
Floats where(const Ints& mask, const Floats& x) { return (Floats)(mask & (Ints)x); }
Floats absolute(const Floats& x) { return (Floats)((Ints)x & 0x7fffffff); }
Floats root(const Floats& x) {
  Floats out;
  for (int l = 0; l < kLanes; ++l) out[l] = std::sqrt(x[l]);
  return out;
}

/// What is summed over a window: offsets a, b in pixels, r the inverse depth less the pixel's own.
struct Sums {
  Floats n = all(0), a = all(0), b = all(0), aa = all(0), ab = all(0), bb = all(0), r = all(0), ar = all(0),
         br = all(0);
};

struct Window {
  const float* depth;  // at the first lane's pixel
  const float* inverse;
  std::ptrdiff_t pitch;
  Floats z, w, jump;  // of the lanes' own pixels: depth, inverse depth, largest difference in depth
};

Sums sums_over(const Window& window, int half) {
  const int step = half > 6 ? 2 : 1;
  Sums s;
  for (int b = -half; b <= half; b += step) {
    const float *depth = window.depth + b * window.pitch, *inverse = window.inverse + b * window.pitch;
    Floats n = all(0), sum_a = all(0), sum_aa = all(0), sum_r = all(0), sum_ar = all(0);
    for (int a = -half; a <= half; a += step) {
      const Ints near = absolute(load(depth + a) - window.z) < window.jump;  // false for NaN
      const Floats r = where(near, load(inverse + a) - window.w);
      const auto at = static_cast<float>(a);
      n += where(near, all(1));
      sum_a += where(near, all(at));
      sum_aa += where(near, all(at * at));
      sum_r += r;
      sum_ar += r * at;
    }
    const auto at = static_cast<float>(b);
    s.n += n, s.a += sum_a, s.aa += sum_aa, s.r += sum_r, s.ar += sum_ar;
    s.b += n * at, s.ab += sum_a * at, s.bb += n * (at * at), s.br += sum_r * at;
  }
  return s;
}

struct Lanes {
  Floats x, y, z;
  Ints good;
};

/// Regression r = mean + g_u a + g_v b, and the normal of the plane it is.
Lanes normals_from(const Sums& s, const Floats& own, const Floats& from_cx, float from_cy, const NormalRule& rule) {
  const Floats inverse = 1 / (s.n + where(s.n < all(1), all(1)));
  const Floats a = s.a * inverse, b = s.b * inverse, r = s.r * inverse;
  const Floats aa = s.aa * inverse - a * a, ab = s.ab * inverse - a * b, bb = s.bb * inverse - b * b;
  const Floats ar = s.ar * inverse - a * r, br = s.br * inverse - b * r;
  const Floats determinant = aa * bb - ab * ab;
  const Ints good = (s.n >= all(static_cast<float>(rule.fewest))) & (determinant > all(0.05f));
  const Floats divide = 1 / (determinant + where(~good, all(1)));
  const Floats g_u = (ar * bb - br * ab) * divide, g_v = (br * aa - ar * ab) * divide;
  const Floats here = own + r - g_u * a - g_v * b;  // the plane's inverse depth at the pixel itself
  // q . p = 1 on the plane: q leads away from the camera.
  const Floats q_x = g_u * rule.fx, q_y = g_v * rule.fy, q_z = here - g_u * from_cx - g_v * from_cy;
  const Floats scale = -1 / root(q_x * q_x + q_y * q_y + q_z * q_z);
  return {q_x * scale, q_y * scale, q_z * scale, good};
}

/// One block of eight pixels; windows of different size are done one after another.
void normals_of_block(const NormalRow& row, const NormalRule& rule, int u, const NormalColumns& out) {
  const Floats z = load(row.depth + u);
  Ints wanted{}, half{};
  int smallest = kNormalReach, largest = 0;
  for (int l = 0; l < kLanes; ++l) {
    wanted[l] = u + l < row.width && row.wanted[u + l] && z[l] > 0 ? -1 : 0;
    const float px = rule.radius * rule.fx / z[l] + 0.5f;
    half[l] = wanted[l] ? static_cast<int>(std::clamp(px, 2.0f, static_cast<float>(kNormalReach))) : 0;
    if (!wanted[l]) continue;
    smallest = std::min(smallest, half[l]);
    largest = std::max(largest, half[l]);
  }
  const Floats sigma = rule.sigma_constant + z * (rule.sigma_linear + z * rule.sigma_quadratic);
  const Window window{row.depth + u, row.inverse + u, row.pitch, z, load(row.inverse + u), rule.radius + 2 * sigma};
  Floats from_cx;
  for (int l = 0; l < kLanes; ++l) from_cx[l] = static_cast<float>(u + l) - rule.cx;
  Floats x = all(0), y = all(0), n_z = all(0);
  for (int h = smallest; h <= largest; ++h) {
    const Ints mine = wanted & (half == h);
    bool any = false;
    for (int l = 0; l < kLanes; ++l) any |= mine[l] != 0;
    if (!any) continue;
    const Lanes n = normals_from(sums_over(window, h), window.w, from_cx, static_cast<float>(row.v) - rule.cy, rule);
    x += where(mine & n.good, n.x), y += where(mine & n.good, n.y), n_z += where(mine & n.good, n.z);
  }
  store(out.x + u, x), store(out.y + u, y), store(out.z + u, n_z);
}

}  // namespace

void normals_of_row(const NormalRow& row, const NormalRule& rule, const NormalColumns& out) {
  for (int u = 0; u < row.width; u += kLanes) {
    std::uint64_t eight;
    std::memcpy(&eight, row.wanted + u, sizeof eight);
    if (eight != 0) {
      normals_of_block(row, rule, u, out);
    } else {
      store(out.x + u, all(0)), store(out.y + u, all(0)), store(out.z + u, all(0));
    }
  }
}

}  // namespace binpick

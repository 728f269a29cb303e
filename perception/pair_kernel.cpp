#include "perception/pair_kernel.hpp"

namespace binpick {

using namespace pair_math;

void pair_cells(const PairReference& reference, const PairColumns& partners, int count, const PairLimits& limits,
                int* __restrict cell, int* __restrict alpha) {
  const PairReference r = reference;
  const PairSteps steps = limits.steps;
  const float* __restrict px = partners.px;
  const float* __restrict py = partners.py;
  const float* __restrict pz = partners.pz;
  const float* __restrict nx = partners.nx;
  const float* __restrict ny = partners.ny;
  const float* __restrict nz = partners.nz;
  for (int k = 0; k < count; ++k) {
    const float dx = px[k] - r.point[0], dy = py[k] - r.point[1], dz = pz[k] - r.point[2];
    const float squared = dot(dx, dy, dz, dx, dy, dz);
    const float length = std::sqrt(squared), inverse = 1 / std::max(length, 1e-12f);
    const float cosine_1 = dot(r.x[0], r.x[1], r.x[2], dx, dy, dz) * inverse;
    const float cosine_2 = dot(nx[k], ny[k], nz[k], dx, dy, dz) * inverse;
    const float cosine_n = dot(r.x[0], r.x[1], r.x[2], nx[k], ny[k], nz[k]);
    const int bin = static_cast<int>(std::min(length * steps.per_metre, static_cast<float>(steps.length_bins)));
    const int at = cell_of(bin, angle_bin(unit_angle(cosine_1), steps), angle_bin(unit_angle(cosine_2), steps),
                           angle_bin(unit_angle(cosine_n), steps), steps);
    const bool none = (squared <= 0) | (squared > limits.radius_squared) | (bin >= steps.length_bins);
    cell[k] = none ? -1 : at;
    alpha[k] = turns_of(dot(r.y[0], r.y[1], r.y[2], dx, dy, dz), dot(r.z[0], r.z[1], r.z[2], dx, dy, dz));
  }
}

}  // namespace binpick

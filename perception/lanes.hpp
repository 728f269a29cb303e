// Private to the kernels of this room: eight floats side by side, written with the compiler's own vectors. Every lane
// is computed as a scalar float would be (IEEE, no contraction), and what is summed over lanes is summed in a fixed
// order, so that the bits depend on neither the machine nor the number of threads.
#pragma once

#include <cstdint>
#include <cstring>

namespace binpick::lanes {

constexpr int kLanes = 8;
using Floats [[gnu::vector_size(32)]] = float;
using Ints [[gnu::vector_size(32)]] = std::int32_t;

inline Floats load(const float* from) {
  Floats out;
  std::memcpy(&out, from, sizeof out);
  return out;
}
inline Ints load(const std::int32_t* from) {
  Ints out;
  std::memcpy(&out, from, sizeof out);
  return out;
}
inline void store(float* to, Floats x) { std::memcpy(to, &x, sizeof x); }
inline void store(std::int32_t* to, Ints x) { std::memcpy(to, &x, sizeof x); }
inline Floats all(float x) { return Floats{} + x; }
inline Floats absolute(Floats x) { return x < 0 ? -x : x; }
inline Floats larger(Floats a, Floats b) { return a > b ? a : b; }
inline Floats square_root(Floats x) {
  Floats out;
  for (int i = 0; i < kLanes; ++i) out[i] = __builtin_sqrtf(x[i]);
  return out;
}
/// First lane first.
inline double sum(Floats x) {
  double out = 0;
  for (int i = 0; i < kLanes; ++i) out += static_cast<double>(x[i]);
  return out;
}

/// A rigid motion as numbers: R row by row, then p.
struct Motion {
  float R[9], p[3];
};

struct Vectors {
  Floats x, y, z;
};
inline Vectors turned(const Motion& m, const Vectors& a) {
  return {m.R[0] * a.x + m.R[1] * a.y + m.R[2] * a.z, m.R[3] * a.x + m.R[4] * a.y + m.R[5] * a.z,
          m.R[6] * a.x + m.R[7] * a.y + m.R[8] * a.z};
}
inline Vectors moved(const Motion& m, const Vectors& a) {
  const Vectors t = turned(m, a);
  return {t.x + m.p[0], t.y + m.p[1], t.z + m.p[2]};
}
inline Vectors minus(const Vectors& a, const Vectors& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Floats dot(const Vectors& a, const Vectors& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

}  // namespace binpick::lanes

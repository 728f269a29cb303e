// The scene of the benches: rings of known triangle count, dropped by the physics and at rest in a bin, seen from
// above.
#pragma once

#include <cstdint>

#include "core/camera.hpp"
#include "core/part.hpp"
#include "core/random.hpp"
#include "sim/render_scene.hpp"

namespace binpick {

struct BenchHeap {
  RenderScene scene;  ///< parts 0 .. parts-1, then bin and table
  std::size_t parts = 0;
  std::size_t triangles = 0;  ///< of one part
  PinholeCamera camera;       ///< 848 x 480
  Pose X_WC = Pose::Identity();
};

/// A ring of 100 x 70 x 16 mm (the bearing's envelope), 5,120 triangles, eight convex pieces.
Part bench_ring();

/// `parts` rings dropped with `seed` into a bin of 0.4 x 0.3 x 0.2 m; the camera looks down from 0.6 m above its floor.
BenchHeap bench_heap(std::size_t parts, Seed seed);

}  // namespace binpick

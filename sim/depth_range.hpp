// Near and far planes about everything in a scene, for pictures: a sensor brings its own range.
#pragma once

#include <utility>

#include "sim/render_scene.hpp"

namespace binpick {

/// Smallest and largest z of C of the scene's vertices, a little widened; near at least 20 mm.
std::pair<double, double> depth_range(const RenderScene& scene, const Pose& X_WC);

}  // namespace binpick

// Private to sim: a shaded picture for people, made from exact frames of any DepthRenderer: two lights, a shadow,
// corners darkened, one calm colour for each id; drawn at twice the size and averaged down.
#pragma once

#include "core/image_io.hpp"
#include "sim/depth_renderer.hpp"

namespace binpick {

Image<Rgb> shaded_picture(DepthRenderer& renderer, const RenderScene& scene, const PinholeCamera& camera,
                          const Pose& X_WC);

}  // namespace binpick

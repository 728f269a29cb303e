// The interface of the exact renderers: scene + camera -> noise-free depth, normals and instance ids in one frame.
// OSMesa first; a ray caster is the reference; another back end is one file.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/camera.hpp"
#include "core/image.hpp"
#include "core/image_io.hpp"
#include "core/pose.hpp"
#include "sim/render_scene.hpp"

namespace binpick {

struct ExactFrame {
  Image<float> depth;               ///< z of C in m; NaN where nothing is
  Image<std::int32_t> ids;          ///< kIdNothing where nothing is
  Image<Eigen::Vector3f> normals_C; ///< unit, of the visible side (towards the camera); zero where nothing is
  MaterialTable materials;          ///< of what is in the scene, by id
};

class DepthRenderer {
 public:
  virtual ~DepthRenderer() = default;
  /// `near` and `far` (m) bound the depth range; nothing outside is drawn.
  virtual ExactFrame render(const RenderScene& scene, const PinholeCamera& camera, const Pose& X_WC, double near,
                            double far) = 0;
  /// A shaded picture for people, from any camera, coloured by id.
  virtual Image<Rgb> picture(const RenderScene& scene, const PinholeCamera& camera, const Pose& X_WC) = 0;
  /// Version strings of the back end, for environment.json.
  virtual std::string description() const = 0;
};

/// One off-screen context, owned by the thread that calls this. No display, no GPU. Throws std::runtime_error.
std::unique_ptr<DepthRenderer> make_osmesa_renderer();

/// The exact reference: a ray caster on the CPU, depth to the rounding of a float. Belongs to one thread at a time, may
/// use as many as are given, and gives the same bits for any number. Throws std::runtime_error.
std::unique_ptr<DepthRenderer> make_raycast_renderer(int threads = 1);

/// What a scene may call them.
std::vector<std::string> renderer_names();
std::unique_ptr<DepthRenderer> make_renderer(const std::string& name);  ///< throws SpecError with the nearest name

}  // namespace binpick

#include "core/error.hpp"
#include "core/yaml.hpp"
#include "sim/depth_renderer.hpp"

namespace binpick {

std::vector<std::string> renderer_names() { return {"osmesa", "raycast"}; }

std::unique_ptr<DepthRenderer> make_renderer(const std::string& name) {
  if (name == "osmesa") return make_osmesa_renderer();
  if (name == "raycast") return make_raycast_renderer();
  const std::string near = nearest_name(name, renderer_names());
  throw SpecError("renderer '" + name + "' is not known" + (near.empty() ? "" : "; did you mean '" + near + "'?"));
}

}  // namespace binpick

#include "perception/why_nothing.hpp"

#include <algorithm>
#include <cmath>

namespace binpick {
namespace {

constexpr std::ptrdiff_t kFewestPixels = 60;  // of a part, to be told from anything else

}  // namespace

bool larger_than_bin(const PreparedPart& part, const Scene& scene, double headroom) {
  if (!scene.bin) return false;
  const Eigen::Vector3d room = scene.bin->inner_size + Eigen::Vector3d(0, 0, headroom);
  return part.diameter > room.norm();
}

std::string why_nothing(const Scene& scene, const std::vector<PreparedPart>& parts, double headroom) {
  const auto known = std::count_if(scene.depth.begin(), scene.depth.end(), [](float z) { return z > 0; });
  const auto wanted = std::count_if(scene.wanted.begin(), scene.wanted.end(), [](std::uint8_t w) { return w != 0; });
  if (known == 0) return "no depth in view";
  if (wanted == 0 && scene.bin) return "nothing stands above the floor of the bin as it is believed to stand";
  if (wanted < kFewestPixels)
    return "only " + std::to_string(wanted) + " points to look at, at least " + std::to_string(kFewestPixels) +
           " are needed";
  const auto larger = [&](const PreparedPart& part) { return larger_than_bin(part, scene, headroom); };
  if (std::all_of(parts.begin(), parts.end(), larger))
    return parts.size() == 1 ? "the part is larger than the bin" : "all parts are larger than the bin";
  return "no pose of a wanted part is borne out by the view";
}

}  // namespace binpick

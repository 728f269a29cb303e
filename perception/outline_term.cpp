#include "perception/outline_term.hpp"

#include <array>

namespace binpick {
namespace {

enum class Seen : char { kSurface, kBehind, kCovered };
constexpr int kWidest = 16;  // px, largest search

/// What the scene shows k pixels outside the rim, against the model's depth at the rim.
Seen classify(const Scene& scene, const OutlinePixel& rim, int k, float tolerance) {
  // Half a pixel and a large whole number up: a cast rounds towards zero.
  const auto rounded = [](float x) { return static_cast<int>(x + 64.5f) - 64; };
  const int u = rounded(static_cast<float>(rim.u) + static_cast<float>(k) * rim.outward.x());
  const int v = rounded(static_cast<float>(rim.v) + static_cast<float>(k) * rim.outward.y());
  if (!scene.depth.contains(u, v)) return Seen::kCovered;
  const float z = scene.depth(u, v);
  if (!(z <= rim.z + tolerance)) return Seen::kBehind;  // farther, or unknown as in the shadow of a stereo camera
  if (z < rim.z - tolerance) return Seen::kCovered;
  // Known floor and walls, and what other parts explain, end a surface however near they are: a plate of 4 mm that lies
  // on the floor has no depth step to speak of.
  return scene.wanted(u, v) ? Seen::kSurface : Seen::kBehind;
}

}  // namespace

std::vector<OutlineOffset> outline_offsets(const Scene& scene, const PartView& view, int search, float tolerance) {
  std::vector<OutlineOffset> out;
  search = std::min(search, kWidest);
  for (const OutlinePixel& rim : outline_of(view)) {
    std::array<Seen, 2 * kWidest + 3> seen;
    for (int k = -search; k <= search + 1; ++k) seen[k + search] = classify(scene, rim, k, tolerance);
    float best = 1e9f;
    for (int k = -search; k < search; ++k) {
      const bool step = seen[k + search] == Seen::kSurface && seen[k + 1 + search] == Seen::kBehind &&
                        seen[k + 2 + search] != Seen::kSurface;
      // The rim pixel is the last one inside: a step right behind it means no offset.
      if (step && std::abs(static_cast<float>(k)) < std::abs(best)) best = static_cast<float>(k);
    }
    if (best > 1e8f) continue;
    const float px = best - static_cast<float>(scene.noise.fattening_px);
    out.push_back(
        {scene.point(rim.u, rim.v, rim.z), {rim.outward.x(), rim.outward.y(), 0.0f}, px * scene.pixel(rim.z)});
  }
  return out;
}

}  // namespace binpick

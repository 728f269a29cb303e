#include "perception/outline_term.hpp"

#include <array>

namespace binpick {
namespace {

enum class Seen : char { kUnset, kSurface, kBehind, kCovered };
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

/// What is seen across the rim, looked at when it is asked for.
class Profile {
 public:
  Profile(const Scene& scene, const OutlinePixel& rim, float tolerance)
      : scene_(scene), rim_(rim), tolerance_(tolerance) {}
  /// The surface ends right behind pixel k. The rim pixel is the last one inside: a step at 0 means no offset.
  bool steps_at(int k) { return at(k) == Seen::kSurface && at(k + 1) == Seen::kBehind && at(k + 2) != Seen::kSurface; }

 private:
  Seen at(int k) {
    Seen& seen = seen_[static_cast<std::size_t>(k + kWidest)];
    if (seen == Seen::kUnset) seen = classify(scene_, rim_, k, tolerance_);
    return seen;
  }
  const Scene& scene_;
  const OutlinePixel& rim_;
  float tolerance_;
  std::array<Seen, 2 * kWidest + 3> seen_{};
};

}  // namespace

std::vector<OutlineOffset> outline_offsets(const Scene& scene, const PartView& view, int search, float tolerance) {
  std::vector<OutlineOffset> out;
  search = std::min(search, kWidest);
  const int growth = static_cast<int>(std::lround(scene.noise.fattening_px));
  for (const OutlinePixel& rim : outline_of(growth > 0 ? grown(view, growth) : view)) {
    Profile profile(scene, rim, tolerance);
    float best = 1e9f;
    for (int k = 0; k <= search && best > 1e8f; ++k)  // the nearest step, inward before outward
      for (const int at : {-k, k})
        if (best > 1e8f && at < search && profile.steps_at(at)) best = static_cast<float>(at);
    if (best > 1e8f) continue;
    const float px = best - static_cast<float>(scene.noise.fattening_px - growth);
    out.push_back(
        {scene.point(rim.u, rim.v, rim.z), {rim.outward.x(), rim.outward.y(), 0.0f}, px * scene.pixel(rim.z)});
  }
  return out;
}

}  // namespace binpick

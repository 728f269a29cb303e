#include "perception/rim_evidence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace binpick {
namespace {

constexpr int kBeyond = 5, kBeyondInHole = 3;  // px outside the outline: past fattening and mixed pixels
constexpr int kInside = 3;                     // px inside it, where the surface is taken from
constexpr int kStart = 2;                      // px inside it, from where a depth step is looked for
constexpr float kLeastFacing = 0.2f;           // cosine, of a surface that is carried on
constexpr float kLeastAlike = 0.9f;            // cosine between the normals on either side
constexpr int kSides = 8;
constexpr double kFewOfSide = 4;  // judged outline pixels that a side's share is damped by

enum class Rim { kUnknown, kEnds, kGoesOn };

/// The pixel so far outside (or, negative, inside) of an outline pixel.
Eigen::Vector2i pixel_across(const OutlinePixel& o, int px) {
  return {static_cast<int>(std::lround(static_cast<float>(o.u) + static_cast<float>(px) * o.outward.x())),
          static_cast<int>(std::lround(static_cast<float>(o.v) + static_cast<float>(px) * o.outward.y()))};
}

class RimJudge {
 public:
  RimJudge(const Scene& scene, const PartView& view, const std::vector<std::uint8_t>& taken, const CheckConfig& config)
      : scene_(scene), view_(view), taken_(taken), config_(config) {}

  /// Does the scene's own surface, as it lies inside the outline, reach beyond it?
  Rim goes_on(const OutlinePixel& o) const {
    Eigen::Vector2i out;
    if (!beyond(o, out) || !scene_.depth.contains(out.x(), out.y())) return Rim::kUnknown;
    const Eigen::Vector2i in = pixel_across(o, -kInside);
    if (!view_.inside(in.x(), in.y())) return Rim::kUnknown;
    const float inside = scene_.depth(in.x(), in.y()), seen = scene_.depth(out.x(), out.y());
    const float tolerance = depth_tolerance(scene_, o.z, config_);
    const Eigen::Vector3f& n = scene_.normals(in.x(), in.y());
    if (!(std::abs(inside - view_.at(in.x(), in.y())) < 2 * tolerance) || n.isZero() || std::isnan(seen))
      return Rim::kUnknown;
    const float facing = n.dot(scene_.point(out.x(), out.y(), 1));
    const float expected = facing < -kLeastFacing ? n.dot(scene_.point(in.x(), in.y(), inside)) / facing : 0;
    if (seen < expected - tolerance) return Rim::kUnknown;  // something nearer covers the place
    const bool turns = scene_.normals(out.x(), out.y()).dot(n) < kLeastAlike;
    if (seen > expected + tolerance || turns || !scene_.wanted(out.x(), out.y())) return Rim::kEnds;
    return taken(out) ? Rim::kUnknown : Rim::kGoesOn;
  }

  /// Does the scene cross the outline without a depth step, whichever way it turns? Two parts may touch at a point, but
  /// hardly along a whole side.
  Rim attached(const OutlinePixel& o) const {
    const float tolerance = depth_tolerance(scene_, o.z, config_);
    const Eigen::Vector2i in = pixel_across(o, -kStart);
    if (!scene_.depth.contains(in.x(), in.y()) || !view_.inside(in.x(), in.y())) return Rim::kUnknown;
    float before = scene_.depth(in.x(), in.y());
    if (!(std::abs(before - view_.at(in.x(), in.y())) < 2 * tolerance)) return Rim::kUnknown;
    for (int k = 1 - kStart; k <= kBeyond; ++k) {
      const Eigen::Vector2i at = pixel_across(o, k);
      if (!scene_.depth.contains(at.x(), at.y()) || (k > 1 && view_.inside(at.x(), at.y()))) return Rim::kUnknown;
      const float z = scene_.depth(at.x(), at.y());
      if (z < before - tolerance || (k > 1 && taken(at))) return Rim::kUnknown;
      if (!(z <= before + tolerance) || !scene_.wanted(at.x(), at.y())) return Rim::kEnds;  // or no depth: a shadow
      before = z;
    }
    return Rim::kGoesOn;
  }

 private:
  /// The pixel as far out as the part itself lets it be; false inside of narrow gaps.
  bool beyond(const OutlinePixel& o, Eigen::Vector2i& out) const {
    for (int px = kBeyond; px >= kBeyondInHole; --px) {
      out = pixel_across(o, px);
      if (!view_.inside(out.x(), out.y())) return true;
    }
    return false;
  }

  bool taken(const Eigen::Vector2i& at) const {
    return taken_[static_cast<std::size_t>(at.y()) * static_cast<std::size_t>(scene_.depth.width()) +
                  static_cast<std::size_t>(at.x())] > 0;
  }

  const Scene& scene_;
  const PartView& view_;
  const std::vector<std::uint8_t>& taken_;
  const CheckConfig& config_;
};

/// Shares by side, damped where a side has few pixels.
struct Sides {
  std::array<double, kSides> on{}, judged{};

  void add(int side, Rim rim) {
    if (rim == Rim::kUnknown) return;
    judged[static_cast<std::size_t>(side)] += 1;
    if (rim == Rim::kGoesOn) on[static_cast<std::size_t>(side)] += 1;
  }
  double worst() const {
    double share = 0;
    for (std::size_t k = 0; k < kSides; ++k) share = std::max(share, on[k] / (judged[k] + kFewOfSide));
    return share;
  }
};

}  // namespace

RimEvidence judge_rims(const Scene& scene, const PartView& view, const std::vector<std::uint8_t>& taken,
                       const CheckConfig& config) {
  const RimJudge judge(scene, view, taken, config);
  Sides straight, bent;
  double judged = 0, all = 0;
  for (const OutlinePixel& o : outline_of(view)) {
    const double turn = std::atan2(o.outward.y(), o.outward.x()) / (2 * std::numbers::pi) + 1;  // 0.5 .. 1.5
    const int side = static_cast<int>(std::lround(turn * kSides)) % kSides;
    const Rim rim = judge.goes_on(o);
    straight.add(side, rim);
    bent.add(side, judge.attached(o));
    all += 1;
    if (rim != Rim::kUnknown) judged += 1;
  }
  return {straight.worst(), bent.worst(), all > 0 ? judged / all : 0};
}

}  // namespace binpick

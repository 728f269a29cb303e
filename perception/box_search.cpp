#include "perception/box_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace binpick {
namespace {

constexpr std::size_t kTried = 1200;  // patches that a set of faces is held against at first
constexpr int kMostUps = 5, kMostPeaks = 3;
constexpr double kSameWay = 0.97;                     // cosine, 14 degrees: normals of one face
constexpr double kUpright = 0.26;                     // sine: normals of a wall off the floor's plane, draft and noise
constexpr double kBinWidth = 0.003;                   // m, of histograms of offsets
constexpr double kApart = 0.015;                      // m, between two peaks
constexpr double kHalfPatch = 0.005;                  // m
constexpr double kLeastShare = 0.0025;                // of all patches, in a peak
constexpr int kBeyondCosts = 3;                       // patches on a face
constexpr int kFewestOnWall = 8, kFewestOnFloor = 6;  // patches
constexpr double kLeastWidth = 0.06, kMostWidth = 3, kLeastHeight = 0.02;
constexpr double kDrafted = 0.0175;  // tangent, a degree

double quantile(std::vector<double> values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Axes with z up and the walls, if any, along x and y; false when nothing stands upright.
bool upright_axes(const Surfels& surfels, const Eigen::Vector3d& up, Eigen::Matrix3d& R_CH) {
  const Eigen::Vector3d x = up.unitOrthogonal(), y = up.cross(x);
  R_CH << x, y, up;
  std::vector<double> angles;  // modulo a quarter turn
  for (const Surfel& s : surfels)
    if (std::abs(s.n.dot(up)) < kUpright) {
      const double a = std::atan2(s.n.dot(y), s.n.dot(x)) / (std::numbers::pi / 2);
      angles.push_back(a - std::floor(a));
    }
  if (angles.size() < static_cast<std::size_t>(2 * kFewestOnWall)) return false;
  constexpr int kBins = 90, kHalf = 4;
  std::array<int, kBins> histogram{};
  for (const double a : angles) ++histogram[static_cast<int>(a * kBins) % kBins];
  int most = 0, best = 0;
  for (int b = 0; b < kBins; ++b) {
    int count = 0;
    for (int k = -kHalf; k <= kHalf; ++k) count += histogram[(b + k + kBins) % kBins];
    if (count > most) most = count, best = b;
  }
  double sum = 0;
  int n = 0;
  for (const double a : angles) {
    const double off = std::remainder(a - (best + 0.5) / kBins, 1.0);
    if (std::abs(off) * kBins < kHalf + 1) sum += off, ++n;
  }
  const double turn = ((best + 0.5) / kBins + sum / std::max(1, n)) * std::numbers::pi / 2;
  R_CH = R_CH * exp_so3(Eigen::Vector3d(0, 0, turn));
  return true;
}

/// A wall that some patches propose.
struct WallGuess {
  bool there = false;
  double offset = 0, slope = 0, top = 0;  // at the origin's height; tangent; z of H of its upper end
  double low = 0, high = 0;               // of its ends, along x or y of H
};

/// The places of walls facing one way; the last guess is: none.
std::vector<WallGuess> wall_guesses(const Surfels& surfels, const Eigen::Matrix3d& R_CH, int wall) {
  OpenBox facing;
  const Eigen::Vector3d inwards = R_CH * facing.normal(wall + 1), up = R_CH.col(2), along = R_CH.col(wall < 2 ? 1 : 0);
  std::vector<const Surfel*> members;
  std::vector<double> leaning;
  for (const Surfel& s : surfels)
    if (s.n.dot(inwards) > 0.9 && s.n.dot(inwards) * inwards.dot(s.p) < 0) {
      members.push_back(&s);
      leaning.push_back(s.n.dot(up) / s.n.dot(inwards));
    }
  std::vector<WallGuess> out;
  if (members.size() >= static_cast<std::size_t>(kFewestOnWall)) {
    // Most walls are upright; a draft shows in the patches' own normals.
    const double lean = quantile(leaning, 0.5), slope = std::abs(lean) < 2 * kDrafted ? 0 : lean;
    std::vector<double> offsets;
    for (const Surfel* s : members) offsets.push_back((inwards + slope * up).dot(s->p));
    const double fewest = std::max<double>(kFewestOnWall, kLeastShare * static_cast<double>(surfels.size()));
    for (const double at : offset_peaks(offsets, fewest)) {
      std::vector<double> heights, places;
      for (std::size_t i = 0; i < members.size(); ++i) {
        if (std::abs(offsets[i] - at) > 2 * kBinWidth) continue;
        heights.push_back(up.dot(members[i]->p));
        places.push_back(along.dot(members[i]->p));
      }
      out.push_back({true, at, slope, quantile(heights, 0.95), quantile(places, 0.02), quantile(places, 0.98)});
    }
  }
  out.push_back({});
  return out;
}

/// What a set of guesses says; false when it cannot be a box.
bool box_of(const std::array<const WallGuess*, 4>& guess, double floor, OpenBox& box) {
  std::vector<double> tops;
  for (int k = 0; k < 4; ++k) {
    box.wall[k] = guess[k]->there;
    box.slope[k] = guess[k]->slope;
    box.offset[k] = guess[k]->offset - guess[k]->slope * floor;
    if (box.wall[k]) tops.push_back(guess[k]->top);
  }
  if (tops.size() < 2) return false;
  for (int k = 0; k < 4; ++k) {
    if (box.wall[k]) continue;
    box.edge[k] = true;  // where the walls beside it end
    box.offset[k] = 1e9;
    for (const int beside : {k < 2 ? 2 : 0, k < 2 ? 3 : 1})
      if (box.wall[beside])
        box.offset[k] = std::min(box.offset[k], (k % 2 == 0 ? guess[beside]->low : -guess[beside]->high) - kHalfPatch);
  }
  for (int k = 0; k < 4; k += 2) {
    const double width = -box.offset[k] - box.offset[k + 1];
    if (box.wall[k] && box.wall[k + 1] && !(width > kLeastWidth && width < kMostWidth)) return false;
  }
  box.floor = floor;
  box.height = quantile(tops, 0.5) - floor;
  return box.height > kLeastHeight && floor < 0;
}

double worth(const OpenBox& box, std::span<const Surfel> surfels, const StatedNoise& noise) {
  const BoxSupport s = support_of(box, surfels, noise);
  return s.all_on() - kBeyondCosts * s.beyond;
}

struct Best {
  double worth = 0;
  OpenBox box;
};

/// Every set of walls on every floor, for one upward direction; keeps the best of each number of walls. (The floor
/// about a bin, seen between two of its walls, has more patches than the bin.)
void try_boxes(const Surfels& few, const Surfels& all, const Eigen::Matrix3d& R_CH, const StatedNoise& noise,
               std::array<Best, 5>& best) {
  std::array<std::vector<WallGuess>, 4> walls;
  for (int k = 0; k < 4; ++k) walls[k] = wall_guesses(all, R_CH, k);
  std::vector<double> heights;
  for (const Surfel& s : all)
    if (s.n.dot(R_CH.col(2)) > kSameWay) heights.push_back(R_CH.col(2).dot(s.p));
  const std::vector<double> floors = offset_peaks(heights, kFewestOnFloor);
  for (const WallGuess& a : walls[0])
    for (const WallGuess& b : walls[1])
      for (const WallGuess& c : walls[2])
        for (const WallGuess& d : walls[3])
          for (const double floor : floors) {
            OpenBox box;
            box.R_CH = R_CH;
            if (!box_of({&a, &b, &c, &d}, floor, box)) continue;
            const double score = worth(box, few, noise);
            if (Best& known = best[box.walls()]; score > known.worth) known = {score, box};
          }
}

}  // namespace

std::vector<Eigen::Vector3d> common_normals(const Surfels& surfels) {
  std::vector<char> used(surfels.size(), 0);
  std::vector<Eigen::Vector3d> out;
  const std::size_t step = std::max<std::size_t>(1, surfels.size() / 250), every = surfels.size() / 2000 + 1;
  for (int k = 0; k < kMostUps; ++k) {
    std::size_t most = 0;
    Eigen::Vector3d best = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < surfels.size(); i += step) {
      if (used[i]) continue;
      std::size_t count = 0;
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (std::size_t j = 0; j < surfels.size(); j += every)
        if (!used[j] && surfels[j].n.dot(surfels[i].n) > kSameWay) ++count, sum += surfels[j].n;
      if (count > most) most = count, best = sum;
    }
    if (static_cast<double>(most * every) < 0.02 * static_cast<double>(surfels.size())) break;
    out.push_back(best.normalized());
    for (std::size_t j = 0; j < surfels.size(); ++j) used[j] |= surfels[j].n.dot(out.back()) > kSameWay;
  }
  return out;
}

std::vector<double> offset_peaks(const std::vector<double>& values, double fewest) {
  if (values.empty()) return {};
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double from = std::max(*low, -10.0), to = std::min(*high, 10.0);
  std::vector<double> histogram(static_cast<std::size_t>((to - from) / kBinWidth) + 5, 0.0), smooth = histogram;
  for (const double x : values)
    if (x >= from && x <= to) histogram[static_cast<std::size_t>((x - from) / kBinWidth) + 2] += 1;
  for (std::size_t b = 2; b + 2 < smooth.size(); ++b)
    smooth[b] =
        histogram[b] + 0.75 * (histogram[b - 1] + histogram[b + 1]) + 0.3 * (histogram[b - 2] + histogram[b + 2]);
  std::vector<double> out;
  for (int k = 0; k < kMostPeaks; ++k) {
    const auto top = std::max_element(smooth.begin(), smooth.end());
    if (*top < fewest) break;
    const auto at = top - smooth.begin(), reach = static_cast<std::ptrdiff_t>(kApart / kBinWidth);
    out.push_back(from + (static_cast<double>(at) - 1.5) * kBinWidth);
    for (auto b = std::max<std::ptrdiff_t>(0, at - reach); b <= at + reach && b < std::ssize(smooth); ++b)
      smooth[b] = 0;
  }
  return out;
}

std::vector<OpenBox> likeliest_boxes(const Surfels& surfels, const StatedNoise& noise) {
  Surfels few;
  const std::size_t step = surfels.size() / kTried + 1;
  for (std::size_t i = 0; i < surfels.size(); i += step) few.push_back(surfels[i]);
  std::array<Best, 5> best;
  for (const Eigen::Vector3d& up : common_normals(surfels)) {
    Eigen::Matrix3d R_CH;
    if (upright_axes(surfels, up, R_CH)) try_boxes(few, surfels, R_CH, noise, best);
  }
  std::vector<OpenBox> out;
  for (int walls = 4; walls >= 2; --walls)
    if (best[walls].worth > 0) out.push_back(best[walls].box);
  return out;
}

void settle_floor(OpenBox& box, const Surfels& surfels) {
  constexpr double kWidth = 0.001, kRange = 0.02;
  constexpr int kBins = static_cast<int>(2 * kRange / kWidth);
  std::array<double, kBins> histogram{}, smooth{};
  const BoxRays rays(box);
  for (const Surfel& s : surfels) {
    const BoxRay ray = rays.of(s);
    if (ray.face != 0 || ray.aligned < kSameWay || std::abs(ray.distance) >= kRange) continue;
    histogram[std::clamp(static_cast<int>((ray.distance + kRange) / kWidth), 0, kBins - 1)] += 1;
  }
  for (int b = 1; b + 1 < kBins; ++b) smooth[b] = histogram[b - 1] + 2 * histogram[b] + histogram[b + 1];
  const double most = *std::max_element(smooth.begin(), smooth.end());
  for (int b = 1; b + 1 < kBins && most > 0; ++b)
    if (smooth[b] >= 0.3 * most && smooth[b] >= smooth[b - 1] && smooth[b] >= smooth[b + 1]) {
      box.floor += (b + 0.5) * kWidth - kRange;
      return;
    }
}

}  // namespace binpick

#include "perception/large_planes.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <vector>

#include "core/random.hpp"

namespace binpick {
namespace {

constexpr int kMostPlanes = 8;             // a floor, four walls, a table and two more
constexpr int kSamples = 300;              // triples a plane
constexpr int kNear = 60;                  // px, reach of a triple
constexpr std::size_t kCounted = 4000;     // pixels that a triple is held against, about
constexpr double kFewest = 0.02;           // of the wanted pixels: smaller planes are not looked for
constexpr float kSameNormal = 0.8f;        // cosine, 37 degrees
constexpr float kLeastTolerance = 0.003f;  // m
constexpr int kErode = 3;                  // px: pieces that hang together by a thinner neck are two
constexpr double kTooLarge = 1.3;          // of the largest part

struct Plane {
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();
  float offset = 0;
};

/// The view's pixels with a normal, in the order of the image.
struct Surface {
  const Scene& scene;
  std::vector<std::uint32_t> pixels;
  std::vector<char> taken;  // by image index

  explicit Surface(const Scene& s) : scene(s), taken(s.depth.size(), 0) {
    for (std::size_t i = 0; i < s.depth.size(); ++i)
      if (s.wanted[i] && !s.normals[i].isZero()) pixels.push_back(static_cast<std::uint32_t>(i));
  }
  Eigen::Vector3f point(std::uint32_t i) const {
    const int width = scene.depth.width();
    return scene.point(static_cast<int>(i) % width, static_cast<int>(i) / width, scene.depth[i]);
  }
  bool on(const Plane& plane, std::uint32_t i) const {
    if (taken[i]) return false;
    const float z = scene.depth[i], tolerance = std::max(kLeastTolerance, 3 * scene.sigma(z));
    return std::abs(plane.normal.dot(point(i)) - plane.offset) < tolerance &&
           std::abs(plane.normal.dot(scene.normals[i])) > kSameNormal;
  }
  void drop_taken() {
    std::erase_if(pixels, [&](std::uint32_t i) { return taken[i] != 0; });
  }
};

/// The plane through a pixel and two others of its neighbourhood; false when they do not agree.
bool sample_plane(const Surface& surface, Rng& rng, Plane& out) {
  const int width = surface.scene.depth.width();
  const std::uint32_t a = surface.pixels[rng.below(surface.pixels.size())];
  Eigen::Vector3f p[3] = {surface.point(a), {}, {}};
  for (int k = 1; k < 3; ++k) {
    const int u = static_cast<int>(a) % width + static_cast<int>(rng.below(2 * kNear + 1)) - kNear;
    const int v = static_cast<int>(a) / width + static_cast<int>(rng.below(2 * kNear + 1)) - kNear;
    if (!surface.scene.depth.contains(u, v) || !surface.scene.wanted(u, v)) return false;
    p[k] = surface.point(static_cast<std::uint32_t>(v * width + u));
  }
  const Eigen::Vector3f n = (p[1] - p[0]).cross(p[2] - p[0]);
  if (!(n.norm() > 1e-5f)) return false;
  out.normal = n.normalized();
  out.offset = out.normal.dot(p[0]);
  return std::abs(out.normal.dot(surface.scene.normals[a])) > kSameNormal;
}

std::vector<std::uint32_t> members(const Surface& surface, const Plane& plane) {
  std::vector<std::uint32_t> out;
  std::copy_if(surface.pixels.begin(), surface.pixels.end(), std::back_inserter(out),
               [&](std::uint32_t i) { return surface.on(plane, i); });
  return out;
}

/// Least squares through the plane's pixels.
Plane fitted(const Surface& surface, const std::vector<std::uint32_t>& on) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const std::uint32_t i : on) mean += surface.point(i).cast<double>();
  mean /= static_cast<double>(on.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const std::uint32_t i : on) {
    const Eigen::Vector3d d = surface.point(i).cast<double>() - mean;
    spread += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
  const Eigen::Vector3d n = solver.eigenvectors().col(0);
  return {n.cast<float>(), static_cast<float>(n.dot(mean))};
}

/// The plane that most pixels lie on; its pixels.
std::vector<std::uint32_t> best_plane(const Surface& surface, Rng& rng) {
  const std::size_t step = std::max<std::size_t>(1, surface.pixels.size() / kCounted);
  std::size_t most = 0;
  Plane best;
  for (int k = 0; k < kSamples; ++k) {
    Plane plane;
    if (!sample_plane(surface, rng, plane)) continue;
    std::size_t count = 0;
    for (std::size_t i = 0; i < surface.pixels.size(); i += step) count += surface.on(plane, surface.pixels[i]);
    if (count > most) most = count, best = plane;
  }
  std::vector<std::uint32_t> on = members(surface, best);
  for (int round = 0; round < 2 && on.size() > 50; ++round) on = members(surface, fitted(surface, on));
  return on;
}

/// Pixels of the mask all of whose neighbours within kErode are in it, too.
Image<std::uint8_t> eroded(const Image<std::uint8_t>& mask) {
  Image<std::uint8_t> out(mask.width(), mask.height(), 0);
  for (int v = kErode; v < mask.height() - kErode; ++v)
    for (int u = kErode; u < mask.width() - kErode; ++u) {
      bool all = mask(u, v) != 0;
      for (int b = -kErode; b <= kErode && all; ++b)
        for (int a = -kErode; a <= kErode && all; ++a) all = mask(u + a, v + b) != 0;
      out(u, v) = all;
    }
  return out;
}

/// The connected pieces of a mask, pixels in the order they are reached.
std::vector<std::vector<std::uint32_t>> pieces_of(Image<std::uint8_t> mask) {
  std::vector<std::vector<std::uint32_t>> pieces;
  const int width = mask.width();
  for (std::size_t start = 0; start < mask.size(); ++start) {
    if (!mask[start]) continue;
    std::vector<std::uint32_t> piece = {static_cast<std::uint32_t>(start)};
    mask[start] = 0;
    for (std::size_t k = 0; k < piece.size(); ++k) {
      const int u = static_cast<int>(piece[k]) % width, v = static_cast<int>(piece[k]) / width;
      for (const auto& [a, b] : {std::pair{-1, 0}, std::pair{1, 0}, std::pair{0, -1}, std::pair{0, 1}}) {
        if (!mask.contains(u + a, v + b) || !mask(u + a, v + b)) continue;
        mask(u + a, v + b) = 0;
        piece.push_back(static_cast<std::uint32_t>((v + b) * width + u + a));
      }
    }
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

/// Reach of a piece along its widest direction of a few, m.
float reach_of(const Surface& surface, const std::vector<std::uint32_t>& piece) {
  Eigen::AlignedBox3f box;
  for (const std::uint32_t i : piece) box.extend(surface.point(i));
  return box.diagonal().norm();
}

}  // namespace

void unmark_large_planes(Scene& scene, double largest_part) {
  Surface surface(scene);
  const double fewest = kFewest * static_cast<double>(surface.pixels.size());
  scene.plane_of = Image<std::uint8_t>(scene.depth.width(), scene.depth.height(), 0);
  Rng rng = Seed{0x706c616e}.rng();
  for (int k = 0; k < kMostPlanes && surface.pixels.size() > 100; ++k) {
    const std::vector<std::uint32_t> on = best_plane(surface, rng);
    if (static_cast<double>(on.size()) < std::max(50.0, fewest)) break;
    Image<std::uint8_t> mask(scene.depth.width(), scene.depth.height(), 0);
    for (const std::uint32_t i : on) mask[i] = 1, surface.taken[i] = 1;
    const auto pieces = pieces_of(eroded(mask));
    const bool large = std::any_of(pieces.begin(), pieces.end(), [&](const auto& piece) {
      return reach_of(surface, piece) > kTooLarge * largest_part;
    });
    // All of it: no part has a face in the plane of the floor it lies on, or of the wall it leans against.
    if (large) {
      const Plane plane = fitted(surface, on);
      const float towards = plane.offset > 0 ? -1.0f : 1.0f;
      scene.planes.emplace_back(towards * plane.normal.x(), towards * plane.normal.y(), towards * plane.normal.z(),
                                towards * plane.offset);
      for (const std::uint32_t i : on) {
        scene.wanted[i] = 0;
        scene.plane_of[i] = static_cast<std::uint8_t>(scene.planes.size());
      }
    }
    surface.drop_taken();
  }
}

}  // namespace binpick

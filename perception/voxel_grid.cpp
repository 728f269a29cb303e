#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/check.hpp"
#include "perception/preprocess.hpp"

namespace binpick {
namespace {

constexpr float kSameSide = 0.7f;  // cosine: normals further apart stay two points

/// floor as an int; std::floor is a call on the oldest processors.
std::int64_t whole(float x) {
  const auto i = static_cast<std::int64_t>(x);
  return i - (x < static_cast<float>(i));
}

std::uint64_t voxel_key(const Eigen::Vector3f& p, float inverse) {
  std::uint64_t key = 0;
  for (int i = 0; i < 3; ++i)
    key = (key << 21) |
          static_cast<std::uint64_t>(std::clamp<std::int64_t>(whole(p[i] * inverse) + (1 << 20), 0, (1 << 21) - 1));
  return key;
}

/// Sums of the points of one voxel that face one way, and the next of the same voxel.
struct Side {
  Eigen::Vector3f first, point, normal;
  std::int32_t count, next;
};

/// Voxels in the order in which they are met: a table of their keys (open addressing), each with a chain of sides.
class Voxels {
 public:
  Voxels() : slots_(1 << 14) {}

  void add(std::uint64_t key, const Eigen::Vector3f& p, const Eigen::Vector3f& n) {
    std::int32_t* side = key == last_key_ ? last_ : (last_ = first_side(key));
    last_key_ = key;
    while (*side >= 0) {
      Side& s = sides_[static_cast<std::size_t>(*side)];
      if (s.first.dot(n) > kSameSide) {
        s.point += p;
        s.normal += n;
        ++s.count;
        return;
      }
      side = &s.next;
    }
    *side = static_cast<std::int32_t>(sides_.size());
    sides_.push_back({n, p, n, 1, -1});
  }

  PointCloud means() const {
    PointCloud out;
    out.points.reserve(sides_.size());
    out.normals.reserve(sides_.size());
    for (const Side& side : sides_) {
      out.points.push_back((side.point / static_cast<float>(side.count)).cast<double>());
      out.normals.push_back(side.normal.normalized().cast<double>());
    }
    return out;
  }

 private:
  static constexpr std::uint64_t kFree = ~std::uint64_t{0};  // no key has its highest bit set
  struct Slot {
    std::uint64_t key = kFree;
    std::int32_t side = -1;
  };

  std::int32_t* first_side(std::uint64_t key) {
    if (2 * used_ >= slots_.size()) grow();
    Slot& slot = slots_[place_of(key)];
    if (slot.key == kFree) {
      slot.key = key;
      ++used_;
    }
    return &slot.side;
  }
  std::size_t place_of(std::uint64_t key) const {
    std::size_t at = static_cast<std::size_t>((key * 0x9e3779b97f4a7c15ull) >> 32) & (slots_.size() - 1);
    while (slots_[at].key != key && slots_[at].key != kFree) at = (at + 1) & (slots_.size() - 1);
    return at;
  }
  void grow() {
    std::vector<Slot> old(2 * slots_.size());
    old.swap(slots_);
    for (const Slot& slot : old)
      if (slot.key != kFree) slots_[place_of(slot.key)] = slot;
  }

  std::vector<Slot> slots_;
  std::size_t used_ = 0;
  std::vector<Side> sides_;
  std::uint64_t last_key_ = kFree;
  std::int32_t* last_ = nullptr;  // the last key's first side; stays valid until the table grows for another key
};

}  // namespace

PointCloud voxel_grid(const Scene& scene, double voxel) {
  const float inverse = static_cast<float>(1 / voxel);
  Voxels voxels;
  for (int v = 0; v < scene.depth.height(); ++v)
    for (int u = 0; u < scene.depth.width(); ++u) {
      if (!scene.wanted(u, v) || scene.normals(u, v).isZero(0)) continue;
      const Eigen::Vector3f p = scene.point(u, v, scene.depth(u, v));
      voxels.add(voxel_key(p, inverse), p, scene.normals(u, v));
    }
  return voxels.means();
}

PointCloud voxel_grid(const PointCloud& cloud, double voxel) {
  BP_CHECK(cloud.has_normals() || cloud.points.empty());
  const float inverse = static_cast<float>(1 / voxel);
  Voxels voxels;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f p = cloud.points[i].cast<float>();
    voxels.add(voxel_key(p, inverse), p, cloud.normals[i].cast<float>());
  }
  return voxels.means();
}

}  // namespace binpick

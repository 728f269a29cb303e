#include "perception/covisibility.hpp"

#include "perception/neighbours.hpp"

namespace binpick {
namespace {

constexpr float kBeside = 2;    // spacings of the surface's points
constexpr float kAlike = 0.7f;  // cosine, as in the voxel grid

}  // namespace

std::vector<SurfaceModel::ViewMask> views_of(const PointCloud& cloud_P, const SurfaceModel& surface, Facing facing) {
  const float reach = kBeside * surface.spacing();
  const PointGrid grid(surface.points(), reach);
  std::vector<SurfaceModel::ViewMask> views(cloud_P.size(), 0);
  for (std::size_t i = 0; i < cloud_P.size(); ++i) {
    const Eigen::Vector3f normal = cloud_P.normals[i].cast<float>();
    grid.within(cloud_P.points[i].cast<float>(), reach, [&](std::uint32_t k) {
      if (facing == Facing::kAny || surface.normals()[k].dot(normal) > kAlike) views[i] |= surface.views_of(k);
    });
    if (views[i] == 0) views[i] = ~SurfaceModel::ViewMask{0};
  }
  return views;
}

}  // namespace binpick

#include "perception/hypothesis_check.hpp"

#include <algorithm>

#include "core/error.hpp"

namespace binpick {
namespace {

constexpr double kThrough = 0.03;      // of a part's surface on either side of a plane it cannot reach through
constexpr int kMostVoxels = 400;       // along one edge: bounds the memory when stray points lie far away
constexpr float kLeastFacing = 0.05f;  // cosine, flatter points are not judged
constexpr float kLeastSlant = 0.35f;   // cosine: on a slanted surface a small step sideways is a large one in depth

/// The view from which the camera sees the part at a pose.
int view_at(const SurfaceModel& model, const Eigen::Isometry3f& X_CP) {
  const Eigen::Vector3f eye_P = X_CP.inverse() * Eigen::Vector3f::Zero();
  return model.view_of((eye_P - model.center()).normalized());
}

}  // namespace

float depth_tolerance(const Scene& scene, float z, const CheckConfig& config) {
  return std::max(static_cast<float>(config.tolerance), static_cast<float>(config.tolerance_sigmas) * scene.sigma(z));
}

void CheckConfig::visit(ConfigVisitor& v) {
  v.field("voxel", voxel, Unit::kNone, "edge of the verification grid, of the diameter (paper 4.2)");
  v.field("least_voxel_share", least_voxel_share, Unit::kNone,
          "least share of visible model points in occupied voxels");
  v.field("tolerance", tolerance, Unit::kLength, "depth agreement of an inlier, at least");
  v.field("tolerance_sigmas", tolerance_sigmas, Unit::kNone, "the same in standard deviations of the sensor");
  v.field("rough", rough, Unit::kNone, "factor on the tolerance before refinement");
  v.field("normal_tolerance", normal_tolerance, Unit::kAngle, "normal agreement of an inlier");
  v.field("wall_tolerance", wall_tolerance, Unit::kLength,
          "how far a pose may reach into floor or wall, beside 2 sigma");
  v.field("points", points, "model points tried on a hypothesis");
}

void CheckConfig::validate() const {
  if (!(voxel >= 0.01 && voxel <= 0.2)) throw SpecError("check.voxel: must lie between 0.01 and 0.2");
  if (!(least_voxel_share >= 0 && least_voxel_share <= 1))
    throw SpecError("check.least_voxel_share: must lie between 0 and 1");
  if (!(tolerance > 0 && tolerance < 0.1)) throw SpecError("check.tolerance: must lie between 0 and 100 mm");
  if (!(tolerance_sigmas >= 0 && tolerance_sigmas <= 20))
    throw SpecError("check.tolerance_sigmas: must lie between 0 and 20");
  if (!(rough >= 1 && rough <= 10)) throw SpecError("check.rough: must lie between 1 and 10");
  if (!(normal_tolerance > 0 && normal_tolerance <= 3.2))
    throw SpecError("check.normal_tolerance: must lie between 0 and pi");
  if (!(wall_tolerance >= 0 && wall_tolerance < 0.1))
    throw SpecError("check.wall_tolerance: must lie between 0 and 100 mm");
  if (points < 20) throw SpecError("check.points: must be at least 20");
}

VoxelSet::VoxelSet(const Scene& scene, double voxel) {
  std::vector<Eigen::Vector3f> points;
  for (int v = 0; v < scene.depth.height(); ++v)
    for (int u = 0; u < scene.depth.width(); ++u)
      if (scene.wanted(u, v)) points.push_back(scene.point(u, v, scene.depth(u, v)));
  if (points.empty()) {
    filled_.assign(1, 0);
    return;
  }
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : points) box.extend(p);
  const float edge = std::max(static_cast<float>(voxel), box.sizes().maxCoeff() / kMostVoxels);
  inverse_ = 1 / edge;
  low_ = box.min().array() - 1.5f * edge;
  size_ = (box.sizes().array() * inverse_).cast<int>() + 4;
  filled_.assign(static_cast<std::size_t>(size_.prod()), 0);
  for (const Eigen::Vector3f& p : points) {
    const Eigen::Array3i c = ((p - low_).array() * inverse_).cast<int>();
    const auto at = [&](int x, int y, int z) -> std::uint8_t& {
      return filled_[(static_cast<std::size_t>(z) * size_.y() + y) * size_.x() + x];
    };
    at(c.x(), c.y(), c.z()) = 1;
    at(c.x() - 1, c.y(), c.z()) = at(c.x() + 1, c.y(), c.z()) = 1;
    at(c.x(), c.y() - 1, c.z()) = at(c.x(), c.y() + 1, c.z()) = 1;
    at(c.x(), c.y(), c.z() - 1) = at(c.x(), c.y(), c.z() + 1) = 1;
  }
}

double voxel_share(const VoxelSet& voxels, const SurfaceModel& model, const Pose& X_CP, int points) {
  const Eigen::Isometry3f X = X_CP.cast<float>();
  const auto& seen = model.seen_from(view_at(model, X));
  const std::size_t count = std::min(seen.size(), static_cast<std::size_t>(points));
  if (count == 0) return 0;
  int inside = 0;
  for (std::size_t k = 0; k < count; ++k) inside += voxels.contains(X * model.points()[seen[k]]);
  return static_cast<double>(inside) / static_cast<double>(count);
}

CheckCounts check_rays(const Scene& scene, const SurfaceModel& model, const Pose& X_CP, const CheckConfig& config,
                       double widened) {
  const Eigen::Isometry3f X = X_CP.cast<float>();
  const RayImage image{scene.depth.data(),
                       scene.wanted.data(),
                       scene.normals.data()->data(),
                       scene.depth.width(),
                       scene.depth.height(),
                       static_cast<float>(scene.camera.fx),
                       static_cast<float>(scene.camera.fy),
                       static_cast<float>(scene.camera.cx),
                       static_cast<float>(scene.camera.cy)};
  RayQuery query;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) query.R_CP[3 * row + column] = X.linear()(row, column);
    query.p_CP[row] = X.translation()[row];
  }
  query.least_facing = kLeastFacing;
  query.least_slant = kLeastSlant;
  query.least_normal = static_cast<float>(std::cos(config.normal_tolerance));
  query.widened = static_cast<float>(widened);
  query.floor = static_cast<float>(config.tolerance);
  query.sigmas = static_cast<float>(config.tolerance_sigmas);
  query.constant = static_cast<float>(scene.noise.constant);
  query.linear = static_cast<float>(scene.noise.linear);
  query.quadratic = static_cast<float>(scene.noise.quadratic);
  RaySums sums;
  add_rays(model.seen_points(view_at(model, X), config.points), image, query, sums);
  return {sums.tried, sums.inliers, sums.occluded, sums.through, sums.unknown, sums.off};
}

/// False when a pose reaches through a large plane: some of it stands before the plane, and some is hidden behind where
/// the plane is seen. (A part wholly behind, as behind a wall, is only covered.)
static bool clear_of_planes(const Scene& scene, const SurfaceModel& model, const Pose& X_CP,
                            const CheckConfig& config) {
  const Eigen::Isometry3f X = X_CP.cast<float>();
  const float slack = static_cast<float>(config.wall_tolerance) + 2 * scene.sigma(X.translation().z());
  const std::size_t step = std::max<std::size_t>(1, model.points().size() / 300);
  std::vector<int> before(scene.planes.size(), 0), behind(scene.planes.size(), 0);
  int all = 0;
  for (std::size_t i = 0; i < model.points().size(); i += step, ++all) {
    const Eigen::Vector3f p = X * model.points()[i];
    const Eigen::Vector2d pixel = scene.camera.project(p.cast<double>());
    const int u = static_cast<int>(std::lround(pixel.x())), v = static_cast<int>(std::lround(pixel.y()));
    const std::size_t seen = scene.plane_of.contains(u, v) ? scene.plane_of(u, v) : 0;
    for (std::size_t k = 0; k < scene.planes.size(); ++k) {
      const float height = scene.planes[k].head<3>().dot(p) - scene.planes[k].w();
      before[k] += height > slack;
      behind[k] += height < -slack && seen == k + 1;
    }
  }
  for (std::size_t k = 0; k < scene.planes.size(); ++k)
    if (before[k] > kThrough * all && behind[k] > kThrough * all) return false;
  return true;
}

bool fits_bin(const Scene& scene, const SurfaceModel& model, const Pose& X_CP, const CheckConfig& config) {
  if (!scene.bin) return scene.planes.empty() || clear_of_planes(scene, model, X_CP, config);
  const Eigen::Isometry3f X_BP = (scene.X_CB.inverse() * X_CP).cast<float>();
  const float slack =
      static_cast<float>(config.wall_tolerance) + 2 * scene.sigma(static_cast<float>(X_CP.translation().z()));
  const std::size_t step = std::max<std::size_t>(1, model.points().size() / 300);
  for (std::size_t i = 0; i < model.points().size(); i += step) {
    const Eigen::Vector3f p = X_BP * model.points()[i];
    if (p.z() < -slack) return false;
    const bool beside_wall = p.z() < static_cast<float>(scene.bin->inner_size.z());
    const Eigen::Vector2f half = scene.bin->half_at(static_cast<double>(p.z())).cast<float>();
    if (beside_wall && (std::abs(p.x()) > half.x() + slack || std::abs(p.y()) > half.y() + slack)) return false;
  }
  return true;
}

}  // namespace binpick

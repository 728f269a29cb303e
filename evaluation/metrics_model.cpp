#include "evaluation/metrics_model.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace binpick {
namespace {

/// The first few places go to points as far from each other as can be, by farthest-point sampling; the rest stays.
std::vector<Eigen::Vector3d> far_ones_first(std::vector<Eigen::Vector3d> points) {
  constexpr std::size_t kFar = 24;
  std::vector<double> nearest(points.size(), std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k + 1 < std::min(kFar, points.size()); ++k) {
    std::size_t farthest = k + 1;
    for (std::size_t i = k + 1; i < points.size(); ++i) {
      nearest[i] = std::min(nearest[i], (points[i] - points[k]).squaredNorm());
      if (nearest[i] > nearest[farthest]) farthest = i;
    }
    std::swap(points[k + 1], points[farthest]);
    std::swap(nearest[k + 1], nearest[farthest]);
  }
  return points;
}

}  // namespace

FieldModel::FieldModel(const Part& part) : FieldModel(part, bop_symmetries(part.symmetry)) {}

FieldModel::FieldModel(const Part& part, const BopSymmetries& listed)
    : scoring_(part),
      surface_(part.mesh_P, part.symmetry),
      toolkit_list_(toolkit_group(listed)),
      vertices_P_(far_ones_first(part.mesh_P.vertices)),
      hull_P_(far_ones_first(scoring_.hull_P())) {}

}  // namespace binpick

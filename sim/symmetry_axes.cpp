// The axes of a symmetry group, and what they say in words.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "sim/part_sheet.hpp"

namespace binpick {
namespace {

/// The point nearest to the origin on the line that a turn leaves in place.
Eigen::Vector3d fixed_point(const Pose& turn, const Eigen::Vector3d& direction) {
  // (1 - R) p = t has the line as its solutions; asking for p . direction = 0 as well makes it one point.
  const Eigen::Matrix3d A = Eigen::Matrix3d::Identity() - turn.linear() + direction * direction.transpose();
  return A.inverse() * (turn.translation() - direction * direction.dot(turn.translation()));
}

/// The sign that makes the first component beyond rounding positive.
Eigen::Vector3d as_line(Eigen::Vector3d direction) {
  for (const Eigen::Index k : {2, 1, 0})
    if (std::abs(direction[k]) > 1e-6) return direction[k] < 0 ? Eigen::Vector3d(-direction) : direction;
  return direction;
}

std::string text_of(const Eigen::Vector3d& direction) {
  std::ostringstream text;
  text.precision(3);
  text << "(";
  for (Eigen::Index k = 0; k < 3; ++k)
    text << (k ? " " : "") << (std::abs(direction[k]) < 5e-4 ? 0.0 : std::round(1e3 * direction[k]) / 1e3);
  return text.str() + ")";
}

}  // namespace

std::vector<SymmetryAxis> symmetry_axes(const Symmetry& symmetry) {
  std::vector<SymmetryAxis> axes;
  if (symmetry.center_P) return axes;
  if (symmetry.axis) axes.push_back({as_line(symmetry.axis->direction_P.normalized()), symmetry.axis->point_P, 0});
  for (const Pose& member : symmetry.finite) {
    const Eigen::Vector3d turn = log_so3(member.linear());
    if (turn.norm() < 1e-6) continue;
    const Eigen::Vector3d direction = as_line(turn.normalized());
    const auto known = std::find_if(axes.begin(), axes.end(), [&](const SymmetryAxis& axis) {
      return axis.direction_P.cross(direction).norm() < 1e-4;
    });
    if (known == axes.end())
      axes.push_back({direction, fixed_point(member, direction), 2});
    else if (known->order > 0)
      ++known->order;
  }
  std::stable_sort(axes.begin(), axes.end(), [](const SymmetryAxis& a, const SymmetryAxis& b) {
    return (a.order == 0 ? 1000 : a.order) > (b.order == 0 ? 1000 : b.order);
  });
  return axes;
}

std::string symmetry_in_words(const Symmetry& symmetry) {
  if (symmetry.center_P) return "any rotation";
  const std::vector<SymmetryAxis> axes = symmetry_axes(symmetry);
  if (axes.empty()) return "none";
  std::string text;
  for (std::size_t i = 0; i < axes.size();) {
    const int order = axes[i].order;
    std::size_t next = i;
    while (next < axes.size() && axes[next].order == order) ++next;
    text += text.empty() ? "" : "; ";
    text += order == 0   ? "any turn about "
            : order == 2 ? "half turns about "
                         : "turns of 1/" + std::to_string(order) + " about ";
    if (next - i > 3)
      text += std::to_string(next - i) + " axes";
    else if (axes[0].order == 0 && order == 2)
      text += "any axis across it";
    else
      for (std::size_t k = i; k < next; ++k)
        text += (k == i ? "" : k + 1 == next ? " and " : ", ") + text_of(axes[k].direction_P);
    i = next;
  }
  return text;
}

}  // namespace binpick

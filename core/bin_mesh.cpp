#include "core/bin_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "core/mesh_io.hpp"
#include "core/quantity.hpp"
#include "core/sample_surface.hpp"

namespace binpick {
namespace {

constexpr double kOff = 0.010;      // m, by which floor and walls may lie elsewhere than stated: ribs, steps, rounding
constexpr int kRays = 9;            // each way, at the floor and at every wall
constexpr double kFound = 0.5;      // share of the rays that must agree
constexpr double kSpacing = 0.003;  // m, of the samples of the surface
constexpr double kSkin = 0.001;     // m: so much beyond is left to the clearance that planners keep
constexpr double kCell = 0.04;      // m, edge of the cells that collect what lies beyond
constexpr double kSlack = 0.004;    // m, by which a side of two boxes may differ and they still become one
constexpr std::size_t kMostBoxes = 200;  // each costs time in every collision check of the planner

std::string mm(double metres) { return format_double(std::round(metres * 1e4) / 10) + " mm"; }

/// Share of the rays from `eyes` along `direction` that meet a face turned to them within kOff of `distance`.
double share_at(const MeshQuery& surface, const std::vector<Eigen::Vector3d>& eyes, const Eigen::Vector3d& direction,
                const std::vector<double>& distances) {
  std::size_t met = 0;
  for (std::size_t i = 0; i < eyes.size(); ++i) {
    const double start = std::max(0.0, distances[i] - kOff);
    const auto hit = surface.ray(eyes[i] + start * direction, direction, distances[i] - start + kOff);
    met += hit && hit->normal.dot(direction) < 0;
  }
  return static_cast<double>(met) / static_cast<double>(eyes.size());
}

double between(double low, double high, int k) { return low + (high - low) * (k + 0.5) / kRays; }

void check_floor(const BinSpec& bin, const MeshQuery& surface) {
  std::vector<Eigen::Vector3d> eyes;
  const Eigen::Vector2d half = bin.inner_size.head<2>() / 2;
  for (int i = 0; i < kRays; ++i)
    for (int k = 0; k < kRays; ++k)
      eyes.push_back({between(-half.x(), half.x(), i), between(-half.y(), half.y(), k), bin.inner_size.z()});
  const std::vector<double> distances(eyes.size(), bin.inner_size.z());
  if (share_at(surface, eyes, -Eigen::Vector3d::UnitZ(), distances) < kFound)
    throw AssetError(bin.mesh + ": no floor within " + mm(kOff) + " of z = 0 over " + mm(bin.inner_size.x()) + " x " +
                     mm(bin.inner_size.y()) + ": the origin of a bin's mesh is the centre of its inner floor, z is up");
}

void check_wall(const BinSpec& bin, const MeshQuery& surface, int axis, double sign) {
  std::vector<Eigen::Vector3d> eyes;
  std::vector<double> distances;
  for (int i = 0; i < kRays; ++i)
    for (int k = 0; k < kRays; ++k) {
      Eigen::Vector3d eye(0, 0, between(0, bin.inner_size.z(), k));
      eye[1 - axis] = between(-0.5, 0.5, i) * bin.inner_size[1 - axis];
      eyes.push_back(eye);
      distances.push_back(bin.half_at(eye.z())[axis]);
    }
  if (share_at(surface, eyes, sign * Eigen::Vector3d::Unit(axis), distances) >= kFound) return;
  throw AssetError(bin.mesh + ": no wall at " + (sign > 0 ? "+" : "-") + (axis == 0 ? "x" : "y") + " within " +
                   mm(kOff) + " of where bin.inner_size and bin.draft put it (" + mm(distances.front()) +
                   " from the middle at the floor, " + mm(bin.half_at(bin.inner_size.z())[axis]) + " at the rim)");
}

using Boxes = std::vector<Eigen::AlignedBox3d>;

bool in_plain(const std::vector<Primitive>& plain, const Eigen::Vector3d& p_B) {
  return std::any_of(plain.begin(), plain.end(), [&](const Primitive& box) {
    return ((box.X_OS.inverse() * p_B).cwiseAbs() - box.size / 2).maxCoeff() <= kSkin;
  });
}

Boxes cells_of(const std::vector<Eigen::Vector3d>& points_B) {
  std::map<std::tuple<long, long, long>, Eigen::AlignedBox3d> cells;
  const auto index = [](double x) { return std::lround(std::floor(x / kCell)); };
  for (const Eigen::Vector3d& p : points_B) cells[{index(p.x()), index(p.y()), index(p.z())}].extend(p);
  Boxes boxes;
  for (const auto& [cell, box] : cells) boxes.push_back(box);
  return boxes;
}

/// Boxes that follow one another along `axis` and are alike in the other two become one.
Boxes joined_along(Boxes boxes, int axis) {
  const auto follows = [&](const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b) {
    for (const int other : {(axis + 1) % 3, (axis + 2) % 3})
      if (std::abs(a.min()[other] - b.min()[other]) > kSlack || std::abs(a.max()[other] - b.max()[other]) > kSlack)
        return false;
    return b.min()[axis] - a.max()[axis] <= 1.5 * kSpacing && a.min()[axis] <= b.min()[axis];
  };
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (std::size_t k = 0; k < boxes.size();) {
      if (k == i || !follows(boxes[i], boxes[k])) {
        ++k;
        continue;
      }
      boxes[i].extend(boxes[k]);
      boxes.erase(boxes.begin() + static_cast<std::ptrdiff_t>(k));
      if (k < i) --i;
      k = 0;
    }
  return boxes;
}

std::vector<Primitive> beyond_plain_boxes(const BinSpec& bin, const TriangleMesh& mesh_B) {
  const std::vector<Primitive> plain = bin_boxes(bin, bin.wall);
  std::vector<Eigen::Vector3d> beyond;
  const auto add = [&](const Eigen::Vector3d& p) {
    if (!in_plain(plain, p)) beyond.push_back(p);
  };
  for (const Eigen::Vector3d& p : sample_surface(mesh_B, kSpacing, Seed{0}.child("bin_mesh")).points) add(p);
  for (const Eigen::Vector3d& p : mesh_B.vertices) add(p);
  Boxes boxes = cells_of(beyond);
  for (const int axis : {2, 0, 1}) boxes = joined_along(std::move(boxes), axis);
  if (boxes.size() > kMostBoxes)
    throw AssetError(bin.mesh + ": too much of it lies beyond the plain floor and walls of bin.inner_size, bin.draft " +
                     "and bin.wall (" + std::to_string(boxes.size()) + " boxes around it, " +
                     std::to_string(kMostBoxes) + " at most)");
  std::vector<Primitive> result;
  for (const Eigen::AlignedBox3d& box : boxes)
    result.push_back(
        Primitive::box(box.sizes() + Eigen::Vector3d::Constant(kSpacing), Pose(Eigen::Translation3d(box.center()))));
  return result;
}

}  // namespace

BinMesh read_bin_mesh(const BinSpec& bin) {
  MeshReadReport report;
  MeshReadOptions options;
  options.unit = bin.mesh_unit;
  TriangleMesh mesh_B = read_mesh(bin.mesh, options, &report);
  if (!report.closed) throw AssetError(bin.mesh + ": the mesh of a bin must be closed");
  MeshQuery surface(mesh_B);
  check_floor(bin, surface);
  for (const int axis : {0, 1})
    for (const double sign : {1.0, -1.0}) check_wall(bin, surface, axis, sign);
  std::vector<Primitive> beyond = beyond_plain_boxes(bin, mesh_B);
  return {std::move(mesh_B), std::move(surface), std::move(beyond)};
}

}  // namespace binpick

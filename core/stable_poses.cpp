#include "core/stable_poses.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>

#include "core/convex_hull.hpp"

namespace binpick {
namespace {

constexpr double kFlat = 1e-3;                             // rad, hull triangles nearer than this are one face
constexpr double kSliver = 1e-5;                           // thickness by length of a triangle without a normal
constexpr double kTwin = 2 * std::numbers::pi / 180;       // rad, between a face and the image of another
constexpr double kRoll = 20 * std::numbers::pi / 180;      // rad, from a facet of a round side to the next
constexpr double kTwinHeight = 0.01, kRollHeight = 0.005;  // of the size

struct Edge {
  std::size_t neighbour;        ///< face on the other side
  double inside;                ///< m, from the foot of the mass centre to the edge, negative when it lies beyond
  double along_from, along_to;  ///< m, of the edge's ends from the point of its line nearest to the foot
};

struct Face {
  Eigen::Vector3d normal;
  double height = 0;  ///< of the mass centre
  double probability = 0;
  std::vector<Edge> edges;

  bool holds() const {
    return std::all_of(edges.begin(), edges.end(), [](const Edge& edge) { return edge.inside > 0; });
  }
  /// Over which edge it topples: the nearest of those that the foot lies beyond.
  std::size_t topples_to() const {
    const Edge* best = nullptr;
    double least = INFINITY;
    for (const Edge& edge : edges) {
      if (edge.inside > 0) continue;
      const double along = std::max({edge.along_from, -edge.along_to, 0.0});
      const double distance = std::hypot(edge.inside, along);
      // At a corner two edges are equally near: the one that the foot lies farther beyond is turned over first.
      if (distance < least - 1e-12 || (distance < least + 1e-12 && best && edge.inside < best->inside)) {
        best = &edge;
        least = distance;
      }
    }
    return best->neighbour;
  }
};

/// Solid angle of a triangle seen from the origin (Van Oosterom and Strackee 1983).
double solid_angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

/// Which of a set of numbers belong together.
class Groups {
 public:
  explicit Groups(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
  std::size_t of(std::size_t i) const {
    while (parent_[i] != i) i = parent_[i];
    return i;
  }
  void join(std::size_t a, std::size_t b) {
    a = of(a), b = of(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parent_;
};

using EdgeMap = std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t>;  // directed edge -> triangle

EdgeMap edges_of(const TriangleMesh& hull) {
  EdgeMap edges;
  for (std::size_t i = 0; i < hull.triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) edges[{hull.triangles[i][k], hull.triangles[i][(k + 1) % 3]}] = i;
  return edges;
}

/// Is the triangle so thin that its normal says nothing, and `edge` its longest one?
bool is_sliver(const TriangleMesh& hull, std::size_t triangle, const std::pair<std::uint32_t, std::uint32_t>& edge) {
  const auto& t = hull.triangles[triangle];
  const Eigen::Vector3d &a = hull.vertices[t[0]], &b = hull.vertices[t[1]], &c = hull.vertices[t[2]];
  const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  return (b - a).cross(c - a).norm() < kSliver * longest * longest &&
         (hull.vertices[edge.first] - hull.vertices[edge.second]).norm() >= longest;
}

/// Triangles that are one flat face.
Groups coplanar(const TriangleMesh& hull, const EdgeMap& edges, const std::vector<Eigen::Vector3d>& normals) {
  Groups groups(hull.triangles.size());
  for (const auto& [edge, triangle] : edges) {
    const auto other = edges.find({edge.second, edge.first});
    if (other == edges.end()) continue;
    const Eigen::Vector3d &a = normals[triangle], &b = normals[other->second];
    const bool flat = a.cross(b).norm() < kFlat && a.dot(b) > 0;
    if (flat || is_sliver(hull, triangle, edge)) groups.join(triangle, other->second);
  }
  return groups;
}

/// The hull's faces with their share of the directions seen from the mass centre, nothing toppled yet. `hull` has the
/// mass centre in its origin.
std::vector<Face> faces_of(const TriangleMesh& hull) {
  const EdgeMap edges = edges_of(hull);
  std::vector<Eigen::Vector3d> normals;
  for (const auto& t : hull.triangles) {
    const Eigen::Vector3d& a = hull.vertices[t[0]];
    normals.push_back((hull.vertices[t[1]] - a).cross(hull.vertices[t[2]] - a).stableNormalized());
  }
  const Groups groups = coplanar(hull, edges, normals);
  std::map<std::size_t, std::size_t> number;  // group -> face
  std::vector<Face> faces;
  for (std::size_t i = 0; i < hull.triangles.size(); ++i) {
    if (number.emplace(groups.of(i), faces.size()).second) faces.push_back({Eigen::Vector3d::Zero(), 0, 0, {}});
    Face& face = faces[number[groups.of(i)]];
    const auto& t = hull.triangles[i];
    const Eigen::Vector3d &a = hull.vertices[t[0]], &b = hull.vertices[t[1]], &c = hull.vertices[t[2]];
    face.normal += (b - a).cross(c - a);
    face.probability += solid_angle(a, b, c) / (4 * std::numbers::pi);
  }
  for (Face& face : faces) face.normal.normalize();
  for (const auto& [edge, triangle] : edges) {
    const auto other = edges.find({edge.second, edge.first});
    if (other == edges.end() || groups.of(triangle) == groups.of(other->second)) continue;
    Face& face = faces[number[groups.of(triangle)]];
    const Eigen::Vector3d &from = hull.vertices[edge.first], &to = hull.vertices[edge.second];
    const Eigen::Vector3d direction = (to - from).normalized(), outwards = direction.cross(face.normal);
    face.height = std::max(face.height, face.normal.dot(from));
    face.edges.push_back(
        {number[groups.of(other->second)], outwards.dot(from), direction.dot(from), direction.dot(to)});
  }
  return faces;
}

/// Moves the probability of faces that do not hold to where they end up: the mass centre sinks with every step.
void topple(std::vector<Face>& faces) {
  for (Face& face : faces) {
    if (face.holds()) continue;
    Face* at = &face;
    for (std::size_t step = 0; step < faces.size() && !at->holds(); ++step) at = &faces[at->topples_to()];
    // Going round in circles is rounding between faces of equal height: it may stay here.
    if (!at->holds()) at->edges.clear();
    if (at == &face) continue;
    at->probability += face.probability;
    face.probability = 0;
  }
}

/// Does a member of the group carry `from` onto `to`?
bool are_twins(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Symmetry& symmetry) {
  if (symmetry.center_P) return true;
  for (const Pose& member : symmetry.finite) {
    const Eigen::Vector3d image = member.linear() * from;
    double angle = std::atan2(image.cross(to).norm(), image.dot(to));
    if (symmetry.axis) {
      const Eigen::Vector3d axis = symmetry.axis->direction_P.normalized();
      const auto from_axis = [&](const Eigen::Vector3d& v) { return std::atan2(axis.cross(v).norm(), axis.dot(v)); };
      angle = std::abs(from_axis(image) - from_axis(to));
    }
    if (angle < kTwin) return true;
  }
  return false;
}

/// Faces that hold and are neighbours of a round side.
Groups rolling(const std::vector<Face>& faces, const std::vector<std::size_t>& held, double size) {
  Groups groups(faces.size());
  for (const std::size_t i : held)
    for (const Edge& edge : faces[i].edges) {
      const Face& next = faces[edge.neighbour];
      if (next.holds() && faces[i].normal.dot(next.normal) > std::cos(kRoll) &&
          std::abs(faces[i].height - next.height) < kRollHeight * size)
        groups.join(i, edge.neighbour);
    }
  return groups;
}

/// Joins the groups of faces that the symmetry carries into each other.
void join_twins(const std::vector<Face>& faces, const std::vector<std::size_t>& held, const Symmetry& symmetry,
                double size, Groups& groups) {
  for (const std::size_t i : held)
    for (const std::size_t j : held)
      if (j < i && groups.of(i) != groups.of(j) && std::abs(faces[i].height - faces[j].height) < kTwinHeight * size &&
          are_twins(faces[i].normal, faces[j].normal, symmetry))
        groups.join(i, j);
}

/// Least angle over an edge behind which another pose begins.
double tilt_of(const Face& face, std::size_t group, const Groups& groups) {
  double least = std::numbers::pi / 2;
  for (const Edge& edge : face.edges)
    if (groups.of(edge.neighbour) != group) least = std::min(least, std::atan2(edge.inside, face.height));
  return least;
}

Pose resting_pose(const Face& face, const Eigen::Vector3d& center_P) {
  const Eigen::Matrix3d R_FP =
      Eigen::Quaterniond::FromTwoVectors(face.normal, -Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return pose_from(R_FP, Eigen::Vector3d(0, 0, face.height) - R_FP * center_P);
}

}  // namespace

std::vector<StablePose> stable_poses(const std::vector<Eigen::Vector3d>& points_P, const Eigen::Vector3d& center_P,
                                     const Symmetry& symmetry) {
  TriangleMesh hull = convex_hull(points_P);
  for (Eigen::Vector3d& v : hull.vertices) v -= center_P;
  double size = 0;
  for (const Eigen::Vector3d& v : hull.vertices) size = std::max(size, 2 * v.norm());
  std::vector<Face> faces = faces_of(hull);
  topple(faces);
  std::vector<std::size_t> held;
  for (std::size_t i = 0; i < faces.size(); ++i)
    if (faces[i].holds()) held.push_back(i);
  const Groups rolls = rolling(faces, held, size);
  Groups groups = rolls;
  join_twins(faces, held, symmetry, size, groups);
  std::map<std::size_t, StablePose> poses;  // group -> pose
  std::map<std::size_t, double> best;
  for (const std::size_t i : held) {
    const auto [entry, fresh] = poses.try_emplace(groups.of(i));
    StablePose& pose = entry->second;
    pose.faces = fresh ? 1 : pose.faces + 1;
    pose.probability += faces[i].probability;
    if (!fresh && faces[i].probability <= best[groups.of(i)]) continue;
    best[groups.of(i)] = faces[i].probability;
    pose.down_P = faces[i].normal;
    pose.height = faces[i].height;
    pose.tilt = tilt_of(faces[i], rolls.of(i), rolls);
    pose.X_FP = resting_pose(faces[i], center_P);
  }
  std::vector<StablePose> result;
  for (const auto& [group, pose] : poses) result.push_back(pose);
  std::stable_sort(result.begin(), result.end(),
                   [](const StablePose& a, const StablePose& b) { return a.probability > b.probability; });
  return result;
}

}  // namespace binpick

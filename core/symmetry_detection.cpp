#include "core/symmetry_detection.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <sstream>

#include "core/check.hpp"
#include "core/mesh_properties.hpp"
#include "core/sample_surface.hpp"

namespace binpick {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kHighestOrder = 64;
constexpr std::size_t kMaxPoints = 3000;  // per rotation that is tried
constexpr std::size_t kMaxFaces = 400;    // directions of a curved surface say nothing
constexpr std::size_t kMaxMembers = 128;  // of a finite group; the closure of true symmetries stays below

struct Moments {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Vector3d spread = Eigen::Vector3d::Zero();    // m^2, ascending
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  // columns
};

// Exact first and second moments of the surface: of a triangle, A / 12 (aa' + bb' + cc' + ss'), s = a + b + c.
Moments surface_moments(const TriangleMesh& mesh) {
  double area = 0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const double A = 0.5 * (b - a).cross(c - a).norm();
    const Eigen::Vector3d s = a + b + c;
    area += A;
    first += A / 3 * s;
    second += A / 12 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose());
  }
  Moments moments;
  if (!(area > 0)) return moments;
  moments.center = first / area;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(second / area -
                                                              moments.center * moments.center.transpose());
  moments.spread = solver.eigenvalues();
  moments.axes = solver.eigenvectors();
  return moments;
}

// Tries rotations about the centroid on points of the surface.
class Trial {
 public:
  Trial(const TriangleMesh& mesh, double tolerance)
      : query_(mesh), moments_(surface_moments(mesh)), diameter_(mesh_diameter(mesh)), limit_(tolerance * diameter_) {
    points_ = sample_surface(mesh, diameter_ / 40, Seed{1}.child("symmetry")).points;
    points_.insert(points_.end(), mesh.vertices.begin(), mesh.vertices.end());
    Seed{1}.child("order").rng().shuffle(points_);  // a wrong rotation is found out by the first few
    if (points_.size() > kMaxPoints) points_.resize(kMaxPoints);
  }

  /// Largest distance from the surface of any point after the rotation; infinite as soon as it passes the limit.
  double deviation(const Eigen::Matrix3d& R) const {
    double worst = 0;
    for (const Eigen::Vector3d& p : points_) {
      const auto hit = query_.closest(moments_.center + R * (p - moments_.center), limit_);
      if (!hit) return std::numeric_limits<double>::infinity();
      worst = std::max(worst, hit->distance);
    }
    return worst;
  }
  bool holds(const Eigen::Vector3d& axis, double angle) const { return std::isfinite(deviation(turn(axis, angle))); }
  static Eigen::Matrix3d turn(const Eigen::Vector3d& axis, double angle) {
    return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  }

  const Moments& moments() const { return moments_; }
  /// What the limit may change of a second moment: all of the surface shifted by it.
  double like() const { return limit_ * diameter_; }
  double limit() const { return limit_; }        ///< m
  double diameter() const { return diameter_; }  ///< m

 private:
  MeshQuery query_;
  Moments moments_;
  double diameter_, limit_;
  std::vector<Eigen::Vector3d> points_;
};

// Parts are drawn along their axes: a direction that a coordinate axis explains as well is that axis.
Eigen::Vector3d snapped(const Eigen::Vector3d& axis) {
  Eigen::Index largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  const Eigen::Vector3d along = Eigen::Vector3d::Unit(largest) * (axis[largest] < 0 ? -1 : 1);
  const Eigen::Vector3d direction = axis[largest] < 0 ? Eigen::Vector3d(-axis) : axis;
  return axis.cross(along).norm() < 0.01 ? Eigen::Vector3d::Unit(largest) : direction.normalized();
}

bool revolves(const Trial& trial, const Eigen::Vector3d& axis) {
  // Angles that no turn of an order up to 64 comes near.
  for (const double angle : {1.0, 2.0, 0.3, 0.05, 0.7, 1.618})
    if (!trial.holds(axis, angle)) return false;
  return true;
}

// The highest order of turns about the axis; 1: none. Every multiple must hold too: a turn of few degrees alone leaves
// a hexagon of 36 mm within 1 mm of itself.
int order_of(const Trial& trial, const Eigen::Vector3d& axis) {
  const auto all_hold = [&](int n) {
    for (int k = 1; 2 * k <= n; ++k)
      if (!trial.holds(axis, 2 * kPi * k / n)) return false;
    return true;
  };
  for (int n = kHighestOrder; n >= 2; --n)
    if (all_hold(n)) return n;
  return 1;
}

// An axis of a half turn across `axis`, if there is one: the best of a grid of directions, then refined.
std::optional<Eigen::Vector3d> half_turn_across(const Trial& trial, const Eigen::Vector3d& axis) {
  const Eigen::Vector3d x = snapped(axis).unitOrthogonal(), y = axis.cross(x);
  const auto at = [&](double angle) { return Eigen::Vector3d(std::cos(angle) * x + std::sin(angle) * y); };
  const auto score = [&](double angle) { return trial.deviation(Trial::turn(at(angle), kPi)); };
  // An axis off by half a step turns the farthest point by a quarter of the limit.
  const double grid = std::max(0.5 * trial.limit() / trial.diameter(), 1e-3);
  double best = 0, best_score = score(0);
  for (double angle = grid; angle < kPi; angle += grid) {
    const double value = score(angle);
    if (value < best_score - 1e-12) best = angle, best_score = value;
  }
  if (!std::isfinite(best_score)) return std::nullopt;
  for (double step = grid / 2; step > 1e-5; step /= 2)
    for (const double angle : {best - step, best + step}) {
      const double value = score(angle);
      if (value < best_score - 1e-12) best = angle, best_score = value;
    }
  const Eigen::Vector3d found = at(best), drawn = snapped(found);
  return trial.deviation(Trial::turn(drawn, kPi)) <= best_score + 0.1 * trial.limit() ? drawn : found;
}

// Directions of faces, edges and corners of a body whose principal moments are all alike (a cube, a nut).
std::vector<Eigen::Vector3d> special_directions(const TriangleMesh& mesh) {
  std::vector<std::pair<double, Eigen::Vector3d>> faces;  // area, normal
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d n =
        (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]);
    if (!(n.norm() > 0)) continue;
    const auto same = std::find_if(faces.begin(), faces.end(),
                                   [&](const auto& face) { return face.second.cross(n).norm() < 0.02 * n.norm(); });
    if (same != faces.end()) {
      same->first += 0.5 * n.norm();
    } else if (faces.size() < kMaxFaces) {
      faces.emplace_back(0.5 * n.norm(), n.normalized());
    }
  }
  std::stable_sort(faces.begin(), faces.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  faces.resize(std::min<std::size_t>(faces.size(), 8));
  std::vector<Eigen::Vector3d> directions;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    directions.push_back(faces[i].second);
    for (std::size_t j = i + 1; j < faces.size(); ++j) {
      directions.push_back((faces[i].second + faces[j].second).normalized());
      directions.push_back((faces[i].second - faces[j].second).normalized());
      for (std::size_t k = j + 1; k < faces.size(); ++k)
        for (const double s : {1.0, -1.0})
          for (const double r : {1.0, -1.0})
            directions.push_back((faces[i].second + s * faces[j].second + r * faces[k].second).normalized());
    }
  }
  return directions;
}

Pose about_center(const Eigen::Matrix3d& R, const Eigen::Vector3d& center) {
  Pose S = Pose::Identity();
  S.linear() = R;
  for (double& entry : S.linear().reshaped())
    if (std::abs(entry - std::round(entry)) < 1e-12) entry = std::round(entry);
  S.translation() = center - S.linear() * center;
  return S;
}

bool near_member(const std::vector<Eigen::Matrix3d>& group, const Eigen::Matrix3d& R, double norm) {
  return std::any_of(group.begin(), group.end(),
                     [&](const Eigen::Matrix3d& member) { return (member - R).norm() < norm; });
}

// Adds a generator to a group, and products until nothing new comes. What lies near a member already is that member,
// found a little off.
void extend(std::vector<Eigen::Matrix3d>& group, std::vector<Eigen::Matrix3d>& generators, const Eigen::Matrix3d& R) {
  if (near_member(group, R, 0.1)) return;
  generators.push_back(R);
  for (std::size_t i = 0; i < group.size(); ++i)
    for (const Eigen::Matrix3d& generator : generators) {
      const Eigen::Matrix3d product = group[i] * generator;
      if (group.size() < kMaxMembers && !near_member(group, product, 0.05)) group.push_back(product);
    }
}

struct Axes {
  std::vector<Eigen::Vector3d> any_order;  // turns of any order may hold about these
  std::vector<Eigen::Vector3d> half;       // half turns only
  bool all_alike = false;
};

Axes axes_to_try(const Trial& trial, const TriangleMesh& mesh) {
  const Moments& m = trial.moments();
  const bool low = m.spread[1] - m.spread[0] < trial.like(), high = m.spread[2] - m.spread[1] < trial.like();
  Axes axes;
  axes.all_alike = low && high;
  if (axes.all_alike)  // these are exact, the principal axes then are not
    for (const Eigen::Vector3d& direction : special_directions(mesh)) axes.any_order.push_back(snapped(direction));
  for (int i = 0; i < 3; ++i) {
    const bool others_alike = i == 0 ? high : i == 2 ? low : m.spread[2] - m.spread[0] < trial.like();
    (others_alike ? axes.any_order : axes.half).push_back(snapped(m.axes.col(i)));
  }
  return axes;
}

std::optional<Symmetry> continuous(const Trial& trial, const Axes& axes) {
  const Eigen::Vector3d& center = trial.moments().center;
  Symmetry symmetry;
  for (const Eigen::Vector3d& axis : axes.any_order) {
    if (!revolves(trial, axis)) continue;
    const Eigen::Vector3d across = axis.unitOrthogonal();
    if (axes.all_alike && revolves(trial, across)) {
      symmetry.center_P = center;
      return symmetry;
    }
    symmetry.axis = Symmetry::Axis{axis, center};
    if (trial.holds(across, kPi)) symmetry.finite.push_back(about_center(Trial::turn(across, kPi), center));
    return symmetry;
  }
  return std::nullopt;
}

}  // namespace

Symmetry detect_symmetry(const TriangleMesh& mesh_P, double tolerance) {
  BP_CHECK(tolerance >= 1e-4 && tolerance <= 0.1, tolerance);
  if (mesh_P.empty()) return {};
  const Trial trial(mesh_P, tolerance);
  const Axes axes = axes_to_try(trial, mesh_P);
  if (const auto found = continuous(trial, axes)) return *found;
  std::vector<Eigen::Matrix3d> group = {Eigen::Matrix3d::Identity()}, generators;
  for (const Eigen::Vector3d& axis : axes.any_order) {
    if (const int order = order_of(trial, axis); order > 1)
      extend(group, generators, Trial::turn(axis, 2 * kPi / order));
    if (axes.all_alike) continue;  // the axes across are among the directions of faces, edges and corners
    if (const auto across = half_turn_across(trial, axis)) extend(group, generators, Trial::turn(*across, kPi));
  }
  for (const Eigen::Vector3d& axis : axes.half)
    if (trial.holds(axis, kPi)) extend(group, generators, Trial::turn(axis, kPi));
  Symmetry symmetry;
  for (std::size_t i = 1; i < group.size(); ++i)
    symmetry.finite.push_back(about_center(group[i], trial.moments().center));
  return symmetry;
}

std::string describe(const Symmetry& symmetry) {
  std::ostringstream text;
  text.precision(3);
  if (symmetry.center_P) return "sphere";
  if (symmetry.axis) {
    const Eigen::Vector3d d = symmetry.axis->direction_P;
    text << "revolution about (" << d.x() << " " << d.y() << " " << d.z() << ")"
         << (symmetry.finite.size() > 1 ? ", and upside down" : "");
  } else if (symmetry.finite.size() > 1) {
    text << symmetry.finite.size() << " rotations";
  } else {
    text << "none";
  }
  return text.str();
}

}  // namespace binpick

#include "perception/self_overlap.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/image.hpp"
#include "core/mesh_properties.hpp"
#include "core/zbuffer.hpp"

namespace binpick {
namespace {

constexpr int kSize = 56;            // px, edge of a drawing
constexpr double kFar = 40;          // diameters from the eye: all but parallel rays
constexpr double kReach = 1.12;      // diameters across a drawing
constexpr int kTurns = 72;           // tried about the line of sight
constexpr double kSameFace = 0.985;  // cosine, 10 degrees
constexpr double kLeastFace = 0.03;  // of the surface
constexpr std::size_t kMostFaces = 10, kMostDirections = 24, kPoints = 60;
constexpr double kSameDepth = 0.02;    // of the diameter
constexpr double kLeastAlike = 0.5;    // of the larger drawing
constexpr double kLeastShift = 0.1;    // of the diameter: MSSD of a wrong pose
constexpr double kSameOverlap = 0.04;  // of the diameter
constexpr int kGroupTurns = 36;        // samples of a continuous axis

struct Drawing {
  Pose X_CP = Pose::Identity();
  std::vector<Eigen::Vector3f> points_C;  // of the silhouette, relative to its middle
  Eigen::Vector3f middle_C = Eigen::Vector3f::Zero();
  Image<float> depth;
};

PinholeCamera distant_camera() {
  PinholeCamera camera;
  camera.width = camera.height = kSize;
  camera.cx = camera.cy = (kSize - 1) / 2.0;
  camera.fx = camera.fy = kSize * kFar / kReach;
  return camera;
}

std::vector<Eigen::Vector3d> face_directions(const TriangleMesh& mesh) {
  struct Face {
    double area;
    Eigen::Vector3d normal;
  };
  std::vector<Face> faces;
  double total = 0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.vertices[t[0]];
    const Eigen::Vector3d n = 0.5 * (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
    const double area = n.norm();
    if (!(area > 0)) continue;
    total += area;
    const auto same =
        std::find_if(faces.begin(), faces.end(), [&](const Face& f) { return f.normal.dot(n) > kSameFace * area; });
    if (same != faces.end()) {
      same->area += area;
    } else if (faces.size() < 400) {  // a curved surface: its directions say nothing
      faces.push_back({area, n / area});
    }
  }
  std::stable_sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.area > b.area; });
  std::vector<Eigen::Vector3d> out;
  for (const Face& f : faces)
    if (f.area >= kLeastFace * total && out.size() < kMostFaces) out.push_back(f.normal);
  return out;
}

/// Faces, box, then edges between the largest faces; one of each orbit of the symmetry group.
std::vector<Eigen::Vector3d> directions_of(const TriangleMesh& mesh, const std::vector<Pose>& group) {
  std::vector<Eigen::Vector3d> wanted = face_directions(mesh);
  const std::size_t faces = std::min<std::size_t>(wanted.size(), 6);
  for (int k = 0; k < 3; ++k)
    for (const double sign : {1.0, -1.0}) wanted.push_back(sign * Eigen::Vector3d::Unit(k));
  for (std::size_t i = 0; i < faces; ++i)
    for (std::size_t j = i + 1; j < faces; ++j)
      if (std::abs(wanted[i].dot(wanted[j])) < 0.9) wanted.push_back((wanted[i] + wanted[j]).normalized());
  std::vector<Eigen::Vector3d> out;
  for (const Eigen::Vector3d& d : wanted) {
    const bool known = std::any_of(out.begin(), out.end(), [&](const Eigen::Vector3d& o) {
      return std::any_of(group.begin(), group.end(),
                         [&](const Pose& S) { return (S.linear() * o).dot(d) > kSameFace; });
    });
    if (!known && out.size() < kMostDirections) out.push_back(d);
  }
  return out;
}

Drawing draw(ZBuffer& buffer, const TriangleMesh& mesh, const Eigen::Vector3d& to_eye_P, const Eigen::Vector3d& center,
             double diameter) {
  Drawing out;
  out.X_CP.linear() = rotation_with_z(-to_eye_P).transpose();
  out.X_CP.translation() = Eigen::Vector3d(0, 0, kFar * diameter) - out.X_CP.linear() * center;
  buffer.clear();
  buffer.draw(mesh, out.X_CP, 0);
  out.depth = buffer.result().depth;
  std::vector<float> depths;
  const float scale = static_cast<float>(kReach * diameter / kSize);
  for (int v = 0; v < kSize; ++v)
    for (int u = 0; u < kSize; ++u)
      if (std::isfinite(out.depth(u, v))) {
        out.points_C.emplace_back(static_cast<float>(u) * scale, static_cast<float>(v) * scale, out.depth(u, v));
        out.middle_C += out.points_C.back();
        depths.push_back(out.depth(u, v));
      }
  if (depths.empty()) return out;
  out.middle_C /= static_cast<float>(depths.size());
  const auto median = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), median, depths.end());
  out.middle_C.z() = *median;
  for (Eigen::Vector3f& p : out.points_C) p -= out.middle_C;
  return out;
}

/// Lays drawing b on drawing a. The move is in the image: a turn about the line of sight, then a shift.
struct Laid {
  double turn = 0;  // rad
  Eigen::Vector3f shift = Eigen::Vector3f::Zero();
  double alike = 0;
};

double alike(const Drawing& a, const Drawing& b, const Laid& laid, double diameter, std::size_t stride) {
  const float c = static_cast<float>(std::cos(laid.turn)), s = static_cast<float>(std::sin(laid.turn));
  const float per_px = static_cast<float>(kReach * diameter / kSize), near = static_cast<float>(kSameDepth * diameter);
  const Eigen::Vector3f to = a.middle_C + laid.shift;
  int same = 0, all = 0;
  for (std::size_t i = 0; i < b.points_C.size(); i += stride, ++all) {
    const Eigen::Vector3f& p = b.points_C[i];
    const int u = static_cast<int>((c * p.x() - s * p.y() + to.x()) / per_px + 0.5f);
    const int v = static_cast<int>((s * p.x() + c * p.y() + to.y()) / per_px + 0.5f);
    same += a.depth.contains(u, v) && std::abs(a.depth(u, v) - p.z() - to.z()) < near;
  }
  const double larger = static_cast<double>(std::max(a.points_C.size(), b.points_C.size()));
  return all > 0 ? static_cast<double>(same) / all * static_cast<double>(b.points_C.size()) / larger : 0;
}

/// Smaller and smaller steps of turn and shift, as long as the drawings grow more alike.
Laid polished(const Drawing& a, const Drawing& b, Laid laid, double diameter) {
  double turn = std::numbers::pi / kTurns;
  float step = static_cast<float>(kReach * diameter / kSize);
  laid.alike = alike(a, b, laid, diameter, 1);
  for (int round = 0; round < 4; ++round, turn /= 2, step /= 2)
    for (int k = 0; k < 8; ++k) {
      Laid trial = laid;
      const float sign = k % 2 == 0 ? 1.0f : -1.0f;
      if (k < 2) {
        trial.turn += sign * turn;
      } else {
        trial.shift[k / 2 - 1] += sign * step;
      }
      trial.alike = alike(a, b, trial, diameter, 1);
      if (trial.alike > laid.alike + 1e-9) laid = trial;
    }
  return laid;
}

/// The part at X_aP * T looks from eye a as the laid drawing b does.
Pose overlap_of(const Drawing& a, const Drawing& b, const Laid& laid, double diameter) {
  Pose A = Pose::Identity();
  A.linear() = Eigen::AngleAxisd(laid.turn, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const double half = (kSize - 1) / 2.0 * kReach * diameter / kSize;
  const Eigen::Vector3d axis(half, half, 0);  // the drawings count from a corner, C from the line of sight
  const Eigen::Vector3d from = b.middle_C.cast<double>() - axis, to = (a.middle_C + laid.shift).cast<double>() - axis;
  A.translation() = to - A.linear() * from;
  return a.X_CP.inverse() * A * b.X_CP;
}

class Collector {
 public:
  Collector(const TriangleMesh& mesh, const Symmetry& symmetry, double diameter)
      : group_(sampled_group(symmetry, kGroupTurns)), points_(hull_vertices(mesh)), diameter_(diameter) {
    std::vector<Eigen::Vector3d> few;
    const std::size_t step = std::max<std::size_t>(1, points_.size() / kPoints);
    for (std::size_t i = 0; i < points_.size(); i += step) few.push_back(points_[i]);
    points_ = few;
  }
  const std::vector<Pose>& group() const { return group_; }

  bool far(const Pose& T, const Pose& from, double share) const {
    return std::all_of(group_.begin(), group_.end(), [&](const Pose& S) {
      const Pose to = from * S;
      return std::any_of(points_.begin(), points_.end(),
                         [&](const Eigen::Vector3d& p) { return (T * p - to * p).norm() > share * diameter_; });
    });
  }
  void add(const Pose& T, double alike) {
    if (!far(T, Pose::Identity(), kLeastShift)) return;
    for (SelfOverlap& known : found_)
      if (!far(T, known.T, kSameOverlap)) {
        if (alike > known.alike) known = {T, alike};
        return;
      }
    found_.push_back({T, alike});
  }
  std::vector<SelfOverlap> best(std::size_t most) {
    std::stable_sort(found_.begin(), found_.end(),
                     [](const SelfOverlap& a, const SelfOverlap& b) { return a.alike > b.alike; });
    if (found_.size() > most) found_.resize(most);
    return found_;
  }

 private:
  std::vector<Pose> group_;
  std::vector<Eigen::Vector3d> points_;
  double diameter_;
  std::vector<SelfOverlap> found_;
};

/// Every turn at which b lies on a better than at the turns beside it.
void lay(const Drawing& a, const Drawing& b, double diameter, bool same_eye, Collector& collector) {
  const double sizes = static_cast<double>(std::min(a.points_C.size(), b.points_C.size())) /
                       static_cast<double>(std::max<std::size_t>({1, a.points_C.size(), b.points_C.size()}));
  if (sizes < kLeastAlike) return;
  std::vector<double> score(kTurns);
  for (int k = 0; k < kTurns; ++k)
    score[k] = alike(a, b, {2 * std::numbers::pi * k / kTurns, {0, 0, 0}, 0}, diameter, 3);
  for (int k = 0; k < kTurns; ++k) {
    const double before = score[(k + kTurns - 1) % kTurns], after = score[(k + 1) % kTurns];
    if (score[k] < kLeastAlike || score[k] < before || score[k] <= after) continue;
    const Laid laid = polished(a, b, {2 * std::numbers::pi * k / kTurns, {0, 0, 0}, 0}, diameter);
    const Pose T = overlap_of(a, b, laid, diameter);
    collector.add(T, laid.alike);
    if (!same_eye) collector.add(T.inverse(), laid.alike);
  }
}

}  // namespace

std::vector<SelfOverlap> self_overlaps(const TriangleMesh& mesh_P, const Symmetry& symmetry, double diameter,
                                       std::size_t most) {
  if (mesh_P.empty() || !(diameter > 0) || symmetry.center_P) return {};
  Collector collector(mesh_P, symmetry, diameter);
  const Eigen::Vector3d center = bounding_box(mesh_P).center();
  ZBuffer buffer(distant_camera(), 0.1 * diameter);
  std::vector<Drawing> drawings;
  for (const Eigen::Vector3d& to_eye_P : directions_of(mesh_P, collector.group()))
    drawings.push_back(draw(buffer, mesh_P, to_eye_P, center, diameter));
  for (std::size_t i = 0; i < drawings.size(); ++i)
    for (std::size_t j = i; j < drawings.size(); ++j) lay(drawings[i], drawings[j], diameter, i == j, collector);
  return collector.best(most);
}

double largest_shift(const Pose& T, const Symmetry& symmetry, const std::vector<Eigen::Vector3d>& points_P) {
  double least = std::numeric_limits<double>::infinity();
  for (const Pose& S : sampled_group(symmetry, kGroupTurns)) {
    double worst = 0;
    for (const Eigen::Vector3d& p : points_P) worst = std::max(worst, (T * p - S * p).norm());
    least = std::min(least, worst);
  }
  return least;
}

}  // namespace binpick

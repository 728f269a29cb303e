#include "robot/pick_sites.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/sample_surface.hpp"
#include "robot/primitive_distance.hpp"

namespace binpick {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kGravity = 9.80665;
constexpr int kSurfaceSamples = 500;
constexpr double kShifts[] = {0.0015, 0.003};  // m: lateral errors that a good site forgives

struct Candidate {
  Eigen::Vector3d point_P, outward_P;
};

void add_direction(std::vector<Eigen::Vector3d>& directions, const Eigen::Vector3d& d) {
  for (const Eigen::Vector3d& known : directions)
    if (known.dot(d) > std::cos(2 * kPi / 180)) return;
  directions.push_back(d.normalized());
}

/// Axes of P, the symmetry axis, principal axes, and the normals that cover most of the surface.
std::vector<Eigen::Vector3d> main_directions(const Part& part) {
  std::vector<Eigen::Vector3d> axes;
  if (part.symmetry.axis) axes.push_back(part.symmetry.axis->direction_P);
  for (int i = 0; i < 3; ++i) axes.push_back(Eigen::Vector3d::Unit(i));
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(part.mass.inertia_P);
  for (int i = 0; i < 3; ++i) axes.push_back(solver.eigenvectors().col(i));
  std::vector<Eigen::Vector3d> directions;
  for (const Eigen::Vector3d& axis : axes)
    for (const double side : {1.0, -1.0}) add_direction(directions, side * axis);

  struct Face {
    Eigen::Vector3d normal;
    double area;
  };
  std::vector<Face> faces;
  for (const auto& t : part.mesh_P.triangles) {
    const auto& v = part.mesh_P.vertices;
    const Eigen::Vector3d cross = (v[t[1]] - v[t[0]]).cross(v[t[2]] - v[t[0]]);
    const double area = cross.norm() / 2;
    if (area <= 0) continue;
    const auto same = std::find_if(faces.begin(), faces.end(),
                                   [&](const Face& face) { return face.normal.dot(cross) > 2 * area * 0.9995; });
    if (same != faces.end())
      same->area += area;
    else
      faces.push_back({cross.normalized(), area});
  }
  std::stable_sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.area > b.area; });
  for (std::size_t i = 0; i < std::min<std::size_t>(faces.size(), 10); ++i) add_direction(directions, faces[i].normal);
  return directions;
}

std::vector<Candidate> candidates_of(const Part& part) {
  std::vector<Candidate> out;
  for (const Eigen::Vector3d& d : main_directions(part)) {
    out.push_back({part.mass.center_P, d});
    if (part.symmetry.axis) out.push_back({part.symmetry.axis->point_P, d});
  }
  const double spacing = std::sqrt(surface_area(part.mesh_P) / kSurfaceSamples);
  const PointCloud samples = sample_surface(part.mesh_P, spacing, Seed{}.child("robot/pick_sites"));
  for (std::size_t i = 0; i < samples.size(); ++i) out.push_back({samples.points[i], samples.normals[i]});
  return out;
}

class SiteFinder {
 public:
  SiteFinder(const Part& part, const Gripper& gripper, const PickSiteConfig& config)
      : part_(part), gripper_(gripper), config_(config), query_(part.mesh_P), probes_G_(gripper.probe_points_G()) {
    const double spacing = std::clamp(part.diameter / 30, 0.0015, 0.005);
    surface_P_ = sample_surface(part.mesh_P, spacing, Seed{}.child("robot/tool_clearance")).points;
    order_ = turn_order(gripper);
    for (const CupSpec& cup : gripper.cups()) stroke_ = std::max(stroke_, cup.stroke);
  }

  PickSites find() {
    const int spins = order_ == 0 ? 1 : std::max(1, 12 / order_);
    for (const Candidate& candidate : candidates_of(part_)) {
      const Eigen::Matrix3d R_PK = rotation_with_z(candidate.outward_P);
      const bool on_axis = on_symmetry_axis(candidate);
      for (int k = 0; k < (on_axis ? 1 : spins); ++k) {
        const double spin = order_ == 0 ? 0 : 2 * kPi * k / (spins * order_);
        PickSite site;
        site.X_PK = pose_from(R_PK * Eigen::AngleAxisd(spin, Eigen::Vector3d::UnitZ()), candidate.point_P);
        site.free_spin = order_ == 0 || on_axis;
        try_site(site);
      }
    }
    spread();
    if (out_.sites.empty()) explain();
    return std::move(out_);
  }

 private:
  bool on_symmetry_axis(const Candidate& c) const {
    if (!part_.symmetry.axis) return false;
    const auto& axis = *part_.symmetry.axis;
    return axis.direction_P.cross(c.outward_P).norm() < 1e-6 &&
           axis.direction_P.cross(c.point_P - axis.point_P).norm() < 1e-6;
  }

  Contact judged(const PickSite& site) const {
    return gripper_.judge(
        probe_mesh(query_, gripper_, tip_at_site(Pose::Identity(), site), 2 * part_.diameter, part_.diameter));
  }

  void try_site(PickSite site) {
    ++out_.tried;
    if (!lowered(site)) {
      ++out_.leaking;
      return;
    }
    const Contact contact = judged(site);
    if (!contact.sealed) {
      ++out_.leaking;
      return;
    }
    if (!body_clears(site)) {
      ++out_.blocked;
      return;
    }
    const double load = load_of(site, contact.limits);
    if (load >= 1) ++out_.weak;
    if (load >= 1 && !config_.keep_weak) return;
    site.quality = std::max(0.0, 1 - load) * seal_margin(site);
    out_.sites.push_back(site);
  }

  /// Moves K along its normal into the plane where the last of the lips touches. A few rays first: most places that
  /// leak are found out by them. False when the rays miss.
  bool lowered(PickSite& site) const {
    const Pose X_PG = tip_at_site(Pose::Identity(), site);
    const Eigen::Vector3d along = X_PG.linear().col(2);
    const double back = 2 * part_.diameter;
    double first = 1e9;
    std::vector<double> heights;
    const std::size_t step = std::max<std::size_t>(1, probes_G_.size() / gripper_.cups().size() / 6);
    for (std::size_t i = 0; i < probes_G_.size(); i += step) {
      const auto hit = query_.ray(X_PG * probes_G_[i] - back * along, along, 2 * back);
      if (!hit) continue;
      heights.push_back(hit->distance - back);
      first = std::min(first, heights.back());
    }
    double lowest = -1e9;
    for (const double height : heights)
      if (height <= first + stroke_) lowest = std::max(lowest, height);
    if (heights.empty()) return false;
    site.X_PK.translation() += along * lowest;
    return true;
  }

  bool body_clears(const PickSite& site) const {
    Pose X_PG = tip_at_site(Pose::Identity(), site);
    X_PG.translation() += config_.press * X_PG.linear().col(2);
    constexpr double kClear = 0.001;
    for (const Primitive& body : gripper_.body_G()) {
      const Pose X_SP = (X_PG * body.X_OS).inverse();
      for (const Eigen::Vector3d& p_P : surface_P_)
        if (signed_distance_S(body, X_SP * p_P) < kClear) return false;
    }
    return true;
  }

  /// Share of the hold that the part's weight takes when the tool points straight down: W/V + W l/M, which passes 1
  /// exactly where a cup peels, M > (V - W) r (physical_models B1).
  double load_of(const PickSite& site, const HoldLimits& limits) const {
    if (!(limits.pull > 0) || !(limits.moment > 0)) return 1;
    const Eigen::Vector3d p_KM = site.X_PK.inverse() * part_.mass.center_P;
    const double weight = part_.mass.mass * (kGravity + config_.acceleration) * config_.safety;
    return weight / limits.pull + weight * p_KM.head<2>().norm() / limits.moment;
  }

  /// 0.25 .. 1: the share of lateral shifts after which it still seals.
  double seal_margin(const PickSite& site) const {
    int good = 0, all = 0;
    for (const double shift : kShifts) {
      for (int k = 0; k < 8; ++k, ++all) {
        PickSite moved = site;
        moved.X_PK = site.X_PK * Eigen::Translation3d(shift * std::cos(k * kPi / 4), shift * std::sin(k * kPi / 4), 0);
        good += judged(moved).sealed ? 1 : 0;
      }
    }
    return 0.25 + 0.75 * good / all;
  }

  /// Keeps the best, none close to a better one.
  void spread() {
    std::stable_sort(out_.sites.begin(), out_.sites.end(),
                     [](const PickSite& a, const PickSite& b) { return a.quality > b.quality; });
    std::vector<PickSite> kept;
    for (const PickSite& site : out_.sites) {
      if (static_cast<int>(kept.size()) >= config_.max_sites) break;
      const bool near = std::any_of(kept.begin(), kept.end(), [&](const PickSite& better) {
        const double turn = angle_between(better.X_PK.linear(), site.X_PK.linear());
        const double lean =
            std::acos(std::clamp(better.X_PK.linear().col(2).dot(site.X_PK.linear().col(2)), -1.0, 1.0));
        return distance_between(better.X_PK, site.X_PK) < 0.05 * part_.diameter && (site.free_spin ? lean : turn) < 0.2;
      });
      if (!near) kept.push_back(site);
    }
    out_.sites = std::move(kept);
  }

  void explain() {
    if (out_.weak > 0)
      out_.why_none = "every place that seals would peel under the part's weight";
    else if (out_.blocked > 0)
      out_.why_none = "wherever it would seal the tool's body meets the part";
    else
      out_.why_none = "the tool seals nowhere on it";
  }

  const Part& part_;
  const Gripper& gripper_;
  const PickSiteConfig& config_;
  MeshQuery query_;
  std::vector<Eigen::Vector3d> probes_G_;
  std::vector<Eigen::Vector3d> surface_P_;
  int order_ = 1;
  double stroke_ = 0;
  PickSites out_;
};

}  // namespace

std::vector<SurfaceSample> probe_mesh(const MeshQuery& mesh_P, const Gripper& gripper, const Pose& X_PG, double back,
                                      double reach) {
  const Eigen::Vector3d along = X_PG.linear().col(2);
  const Pose X_GP = X_PG.inverse();
  std::vector<SurfaceSample> samples;
  for (const Eigen::Vector3d& probe_G : gripper.probe_points_G()) {
    SurfaceSample sample;
    if (const auto hit = mesh_P.ray(X_PG * probe_G - back * along, along, back + reach))
      sample = {true, X_GP * hit->point, X_GP.linear() * hit->normal, 0};
    samples.push_back(sample);
  }
  return samples;
}

int turn_order(const Gripper& gripper) {
  const std::vector<CupSpec>& cups = gripper.cups();
  const auto on_axis = [](const CupSpec& cup) {
    return cup.X_GU.translation().head<2>().norm() < 1e-6 && cup.X_GU.linear()(2, 2) > 1 - 1e-9;
  };
  if (std::all_of(cups.begin(), cups.end(), on_axis)) return 0;
  for (int n = 12; n > 1; --n) {
    const Eigen::AngleAxisd turn(2 * kPi / n, Eigen::Vector3d::UnitZ());
    const bool same = std::all_of(cups.begin(), cups.end(), [&](const CupSpec& a) {
      return std::any_of(cups.begin(), cups.end(), [&](const CupSpec& b) {
        return (turn * a.X_GU.translation() - b.X_GU.translation()).norm() < 1e-6 && a.radius == b.radius &&
               (turn * a.X_GU.linear().col(2) - b.X_GU.linear().col(2)).norm() < 1e-6;
      });
    });
    if (same) return n;
  }
  return 1;
}

PickSites find_pick_sites(const Part& part, const Gripper& gripper, const PickSiteConfig& config) {
  return SiteFinder(part, gripper, config).find();
}

}  // namespace binpick

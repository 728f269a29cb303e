#include "tools/bench/suction_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "evaluation/statistics.hpp"
#include "tools/validate/suction_bench.hpp"

namespace binpick {
namespace {

constexpr double kGravity = 9.81;
constexpr double kClear = 0.12;               // m: a part that swings down beside one cup hangs free of the slab
constexpr double kRise = 0.15, kHold = 0.10;  // s: the acceleration rises, stays and falls
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct Grasp {
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();  ///< m, of the tool from where it should be
  double spin = 0, tilt = 0, tilt_about = 0;        ///< rad
};

Grasp drawn(const SuctionTableConfig& config, int draw) {
  Rng rng = Seed{config.seed + static_cast<std::uint64_t>(draw)}.child("suction table").rng();
  Grasp grasp;
  grasp.shift.x() = rng.normal(0, config.lateral_sigma);
  grasp.shift.y() = rng.normal(0, config.lateral_sigma);
  grasp.spin = rng.uniform(0, 2 * std::numbers::pi);
  grasp.tilt = rng.normal(0, config.tilt_sigma);
  grasp.tilt_about = rng.uniform(0, 2 * std::numbers::pi);
  return grasp;
}

/// One tool on one part.
class Setup {
 public:
  Setup(const RingSubject& ring, double diameter, int cups, double vacuum)
      : ring_(ring), radius_(diameter / 2), count_(cups) {
    std::string yaml = "cups:\n";
    for (int k = 0; k < cups; ++k) {
      const double angle = 2 * std::numbers::pi * k / cups, R = cups > 1 ? ring.land_radius() : 0;
      places_.push_back({R * std::cos(angle), R * std::sin(angle)});
      yaml += "  - {radius: " + std::to_string(radius_) + ", vacuum: " + std::to_string(vacuum) +
              ", time_constant: 5 ms, stiffness: 100, preload: 0.3, pose: {xyz: [" +
              std::to_string(places_.back().x()) + ", " + std::to_string(places_.back().y()) + ", 0]}}\n";
    }
    tool_ = suction_tool(yaml);
    full_pull_ = tool_->cups().front().limits().pull;
    top_ = bounding_box(ring.part.mesh_P).max().z();
  }

  /// The part on the cups, ready to be lifted; empty when a cup does not seal.
  std::unique_ptr<LiftBench> grasped(const Grasp& grasp) const {
    LiftSetting setting;
    setting.press = 0.003;
    auto bench = std::make_unique<LiftBench>(ring_.part, Pose(Eigen::Translation3d(0, 0, -top_)), *tool_,
                                             tool_pose(grasp), setting);
    bench->press();
    if (!bench->seal().sealed) return nullptr;
    bench->evacuate();
    return bench;
  }

  bool seals_by_theory(const Grasp& grasp) const {
    return std::all_of(places_.begin(), places_.end(), [&](const Eigen::Vector2d& p) {
      const double rho = (tool_pose(grasp) * Eigen::Vector3d(p.x(), p.y(), 0)).head<2>().norm();
      return rho >= ring_.inner + radius_ && rho <= ring_.outer - radius_;
    });
  }

  /// Load (N) at which the first cup lets go by statics.
  double load_limit(const Grasp& grasp) const {
    const Eigen::Vector2d c = mass_centre(grasp);
    if (count_ == 1) return full_pull_ / (1 + c.norm() / radius_);
    const double R2 = places_[0].squaredNorm(), k = count_ == 2 ? 1 : 2;
    double limit = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector2d& p : places_) {
      const double share = (1 + k * c.dot(p) / R2) / count_;
      const double moment = count_ == 2 ? across(c) / 2 : 0;  // per newton of load
      limit = std::min(limit, full_pull_ / (share + moment / radius_));
    }
    return limit;
  }

  double weight(double acceleration) const { return ring_.part.mass.mass * (kGravity + acceleration); }
  double mass() const { return ring_.part.mass.mass; }
  /// Moment (N m) that statics puts on one cup at this acceleration.
  double moment_by_theory(const Grasp& grasp, double acceleration) const {
    const Eigen::Vector2d c = mass_centre(grasp);
    if (count_ == 1) return weight(acceleration) * c.norm();
    return count_ == 2 ? weight(acceleration) * across(c) / 2 : 0;
  }

 private:
  /// Seen from the tool's axis.
  Eigen::Vector2d mass_centre(const Grasp& grasp) const {
    const Eigen::Vector3d p_WM = ring_.part.mass.center_P;
    return (tool_pose(grasp).inverse() * Eigen::Vector3d(p_WM.x(), p_WM.y(), 0)).head<2>();
  }
  /// Its distance from the line through two cups.
  double across(const Eigen::Vector2d& c) const {
    return std::abs(c.x() * places_[0].y() - c.y() * places_[0].x()) / places_[0].norm();
  }

  Pose tool_pose(const Grasp& grasp) const {
    const double aside = count_ == 1 ? ring_.land_radius() : 0;
    const Eigen::Vector3d axis(std::cos(grasp.tilt_about), std::sin(grasp.tilt_about), 0);
    const Eigen::Vector3d place(aside + grasp.shift.x(), grasp.shift.y(), 0);
    return Pose(Eigen::Translation3d(place)) * Eigen::AngleAxisd(grasp.tilt, axis) *
           tool_down(Eigen::Vector3d::Zero()) * Eigen::AngleAxisd(grasp.spin, Eigen::Vector3d::UnitZ());
  }

  const RingSubject& ring_;
  double radius_, full_pull_ = 0, top_ = 0;
  int count_;
  std::vector<Eigen::Vector2d> places_;
  std::unique_ptr<Gripper> tool_;
};

/// Upwards: the acceleration rises as half a cosine wave, stays, and falls again.
bool lifted(LiftBench& bench, double acceleration) {
  const auto profile = [&](double t) {
    const double rise = std::min({t, 2 * kRise + kHold - t, kRise}) / kRise;
    return acceleration * (0.5 - 0.5 * std::cos(std::numbers::pi * std::clamp(rise, 0.0, 1.0)));
  };
  bench.forget_peaks();
  bench.raise(0.005);
  if (!bench.holds_all()) return false;
  bench.accelerate({0, 0, 1}, profile, 2 * kRise + kHold);
  return bench.holds_all();
}

SuctionCell measured(const Setup& setup, const SuctionTableConfig& config, double acceleration) {
  SuctionCell cell;
  cell.acceleration = acceleration;
  cell.draws = config.draws;
  std::vector<double> moments, moments_theory;
  for (int draw = 0; draw < config.draws; ++draw) {
    const Grasp grasp = drawn(config, draw);
    const bool seals = setup.seals_by_theory(grasp);
    const bool holds = seals && setup.weight(acceleration) <= setup.load_limit(grasp);
    const auto bench = setup.grasped(grasp);
    const bool held = bench && lifted(*bench, acceleration);
    cell.sealed_theory += seals ? 1 : 0;
    cell.held_theory += holds ? 1 : 0;
    cell.sealed += bench ? 1 : 0;
    cell.held += held ? 1 : 0;
    cell.same += held == holds ? 1 : 0;
    if (bench) moments.push_back(bench->peaks().moment);
    if (bench) moments_theory.push_back(setup.moment_by_theory(grasp, acceleration));
  }
  cell.moment = quantile(moments, 0.5);
  cell.moment_theory = quantile(moments_theory, 0.5);
  return cell;
}

SuctionLimit limit_of(const Setup& setup) {
  SuctionLimit limit;
  limit.theory = setup.load_limit({}) / setup.mass() - kGravity;
  limit.measured = kNone;
  const auto bench = setup.grasped({});
  if (!bench) return limit;
  bench->raise(kClear);
  bench->wait(0.3);
  if (!bench->holds_all()) return limit;
  const double rate = std::max(limit.theory, 1.0) / 1.5;  // at least a second and a half until it must break
  const double broke = bench->accelerate(
      {0, 0, 1}, [&](double t) { return std::max(0.0, rate * t); }, 3);
  if (!bench->holds_all()) limit.measured = broke;
  return limit;
}

}  // namespace

RingSubject paper_ring() {
  RingSubject ring;
  ring.part = ring_part(ring.inner, ring.outer, 0.016, 2700);
  return ring;
}

SuctionTable suction_table(const RingSubject& ring, const SuctionTableConfig& config) {
  SuctionTable table;
  for (const double diameter : config.diameters)
    for (const int cups : config.cups)
      for (const double vacuum : config.vacuums) {
        const Setup setup(ring, diameter, cups, vacuum);
        SuctionLimit limit = limit_of(setup);
        limit.diameter = diameter, limit.cups = cups, limit.vacuum = vacuum;
        table.limits.push_back(limit);
        for (const double acceleration : config.accelerations) {
          SuctionCell cell = measured(setup, config, acceleration);
          cell.diameter = diameter, cell.cups = cups, cell.vacuum = vacuum;
          table.cells.push_back(cell);
        }
      }
  return table;
}

}  // namespace binpick

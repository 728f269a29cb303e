// `suction`: one or several vacuum cups on a stem, each on a spring plunger.
//
//   preset          one_cup (one 15 mm bellows cup) | two_cups | three_cups | four_cups (10 mm cups on an 85 mm pitch
//                   circle, on long spring plungers), then the other keys override it
//   cups            list of cups: pose in the tip frame G, lip radius, vacuum, plunger ... (core/cup.hpp), each from a
//                   `model:` of core/cup_models.hpp when it names one
//   min_cups        cups that must seal; 0 = all
//   tool_length     flange to tip, 240 mm: reaches the floor of a 200 mm bin with the flange above its rim
//   stem_radius, arm_width, arm_thickness, holder_radius, holder_length, lip_height    sizes of the rigid body
//
// Seal of one cup, from 32 rays on the lip and 16 at half its radius (physical_models B3): every ray meets the same
// body; the plane fitted to the lip's 32 points (the cup's best tilt) leaves no more than `lip_compliance` between the
// highest and the lowest; it is tilted by no more than `max_tilt`; every surface normal under the lip lies within
// `max_tilt` of it (a lip does not follow a steeper slope); nothing inside the lip rises into the cup deeper than its
// hollow; and the plunger can bring the lip there: from touching to full stroke. A lip that closes all but a mean gap
// along its rim leaks: p = p_inf (1 - gap / leak_gap); from 80 % on (the vacuum switch) it counts as sealed, with
// limits that fall as p does.
//
// Limits of several cups about G. V_i pull of cup i at p_i with lip radius r_i, n a direction in the tip plane, s(n)
// the largest n.p_j + r_j (the edge about which the tool tips): the vacuum's moment about that edge is M(n) = sum V_i
// (s(n) - n.p_i). Then moment = min M(n); pull = min(sum V_i, min M(n) / s(n)), the second when G is not the cups'
// centre; shear = sum mu_i V_i; torsion = sum mu_i V_i max(|p_i|, r_i). One cup gives back V, V r, mu V, mu V r; three
// equal cups on a circle R give 3 V and 3 V (R/2 + r).
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/check.hpp"
#include "core/error.hpp"
#include "robot/gripper.hpp"
#include "robot/grippers/registry.hpp"

namespace binpick {
namespace {

constexpr int kRimRays = 32;
constexpr int kInnerRays = 16;
constexpr int kRays = kRimRays + kInnerRays;
// Depth of a cup's hollow over its lip radius: what rises further touches the cup's roof and holds the lip off.
constexpr double kHollow = 0.3;
constexpr double kSwitch = 0.8;  // share of the vacuum at which a vacuum switch says "held" (physical_models B3)

/// The surface under one cup, in its frame U.
struct LipFit {
  double height = 0;                                    ///< of the plane at the cup's axis, along +z_U
  double gap = 0;                                       ///< mean along the rim of what the lip does not close
  Eigen::Vector3d outward = -Eigen::Vector3d::UnitZ();  ///< plane's normal, towards the tool
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
};

LipFit fit_lip(std::span<const Eigen::Vector3d> rim_U, double compliance) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d rhs = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : rim_U) {
    const Eigen::Vector3d row(1, p.x(), p.y());
    A += row * row.transpose();
    rhs += row * p.z();
  }
  const Eigen::Vector3d plane = A.ldlt().solve(rhs);
  LipFit fit;
  fit.height = plane[0];
  fit.slope = plane.tail<2>();
  const auto over = [&](const Eigen::Vector3d& p) { return p.z() - plane[0] - fit.slope.dot(p.head<2>()); };
  double nearest = 1e9;  // the lip rests there and reaches `compliance` farther
  for (const Eigen::Vector3d& p : rim_U) nearest = std::min(nearest, over(p));
  for (const Eigen::Vector3d& p : rim_U)
    fit.gap += std::max(0.0, over(p) - nearest - compliance) / static_cast<double>(rim_U.size());
  fit.outward = Eigen::Vector3d(fit.slope.x(), fit.slope.y(), -1).normalized();
  return fit;
}

/// Why one cup does not seal, "" when it does; `vacuum`: what remains of its steady vacuum.
std::string leak_of(const CupSpec& cup, std::span<const SurfaceSample> samples_G, double& vacuum) {
  vacuum = 0;
  const Pose X_UG = cup.X_GU.inverse();
  std::vector<Eigen::Vector3d> points_U;
  for (const SurfaceSample& sample : samples_G) {
    if (!sample.hit) return points_U.size() < kRimRays ? "rim off the part" : "hole under the cup";
    if (sample.body != samples_G.front().body) return "rim on two bodies";
    points_U.push_back(X_UG * sample.point_G);
  }
  const LipFit fit = fit_lip(std::span(points_U).first(kRimRays), cup.lip_compliance);
  if (fit.gap > 0 && fit.gap >= cup.leak_gap) return "surface uneven";
  const double cosine = std::cos(cup.max_tilt);
  if (-fit.outward.z() < cosine) return "tilted too far";
  for (int i = 0; i < kRimRays; ++i)
    if ((X_UG.linear() * samples_G[static_cast<std::size_t>(i)].normal_G).dot(fit.outward) < cosine)
      return "rim too steep";
  for (const Eigen::Vector3d& p : std::span(points_U).subspan(kRimRays))
    if (fit.height + fit.slope.dot(p.head<2>()) - p.z() > kHollow * cup.radius) return "surface rises into the cup";
  if (fit.height > cup.lip_compliance) return "does not touch";
  if (-fit.height > cup.stroke + cup.lip_compliance) return "plunger at its end";
  vacuum = fit.gap > 0 ? 1 - fit.gap / cup.leak_gap : 1;
  return vacuum < kSwitch ? "leaks" : "";
}

/// What one cup adds, seen from the tip frame.
struct HeldCup {
  Eigen::Vector2d p_G;
  double radius, pull, friction;
};

/// Moment of the vacuum about the tipping edge in direction n, and that edge's distance from G.
std::pair<double, double> tipping(const std::vector<HeldCup>& held, const Eigen::Vector2d& n) {
  double edge = -1e9, moment = 0;
  for (const HeldCup& cup : held) edge = std::max(edge, n.dot(cup.p_G) + cup.radius);
  for (const HeldCup& cup : held) moment += cup.pull * (edge - n.dot(cup.p_G));
  return {moment, edge};
}

HoldLimits combined(const std::vector<HeldCup>& held) {
  HoldLimits limits;
  for (const HeldCup& cup : held) {
    limits.pull += cup.pull;
    limits.shear += cup.friction * cup.pull;
    limits.torsion += cup.friction * cup.pull * std::max(cup.p_G.norm(), cup.radius);
  }
  if (held.empty()) return limits;
  // The least moment belongs to an edge between two cups; a single cup has none, any direction does.
  std::vector<Eigen::Vector2d> directions = {Eigen::Vector2d::UnitX(), -Eigen::Vector2d::UnitX()};
  for (std::size_t i = 0; i < held.size(); ++i) {
    for (std::size_t j = i + 1; j < held.size(); ++j) {
      const Eigen::Vector2d along = held[j].p_G - held[i].p_G;
      if (along.norm() < 1e-9) continue;
      for (const double side : {1.0, -1.0})
        directions.push_back(side * Eigen::Vector2d(-along.y(), along.x()).normalized());
    }
  }
  const double all = limits.pull;
  limits.moment = 1e9;
  for (const Eigen::Vector2d& n : directions) {
    const auto [moment, edge] = tipping(held, n);
    limits.moment = std::min(limits.moment, moment);
    if (edge * all > moment) limits.pull = std::min(limits.pull, moment / edge);
  }
  return limits;
}

class Suction : public Gripper {
 public:
  Suction() { load_preset("one_cup"); }

  void visit(ConfigVisitor& v) override {
    if (v.reading() && v.has("preset")) {
      std::string preset = "one_cup";
      v.choice("preset", preset, {"one_cup", "two_cups", "three_cups", "four_cups"}, "cups and sizes to start from");
      load_preset(preset);
    }
    // A list of cups starts from plain cups, not from those of the preset.
    if (v.reading() && v.has("cups")) cups_.clear();
    v.list("cups", cups_, "suction cups");
    v.field("min_cups", min_cups_, "cups that must seal; 0 means all");
    v.field("tool_length", tool_length_, Unit::kLength, "flange to tip");
    v.field("stem_radius", stem_radius_, Unit::kLength, "radius of the stem");
    v.field("arm_width", arm_width_, Unit::kLength, "width of the arms that carry cups beside the stem");
    v.field("arm_thickness", arm_thickness_, Unit::kLength, "thickness of those arms along the tool");
    v.field("holder_radius", holder_radius_, Unit::kLength, "radius of a plunger's sleeve");
    v.field("holder_length", holder_length_, Unit::kLength, "length of a plunger's sleeve");
    v.field("lip_height", lip_height_, Unit::kLength, "height of a lip, from its edge to the plunger");
  }

  void validate() const override {
    if (cups_.empty()) throw SpecError("gripper.cups: at least one cup is needed");
    if (cups_.size() > 64) throw SpecError("gripper.cups: at most 64 cups");
    for (const CupSpec& cup : cups_) {
      cup.validate();
      if (cup.X_GU.linear()(2, 2) < 0.5)
        throw SpecError("gripper.cups: a cup's z axis must lie within 60 degrees of the tool's");
      if (cup.X_GU.translation().norm() > 0.5)
        throw SpecError("gripper.cups: a cup lies more than 500 mm from the tip");
    }
    if (min_cups_ < 0 || min_cups_ > static_cast<int>(cups_.size()))
      throw SpecError("gripper.min_cups: must lie between 0 (all) and the number of cups");
    for (const double size : {stem_radius_, arm_width_, arm_thickness_, holder_radius_, holder_length_, lip_height_})
      if (!(size > 0 && size < 0.2))
        throw SpecError("gripper: sizes of stem, arms, holders and lips must lie between 0 and 200 mm");
    if (!(tool_length_ <= 1)) throw SpecError("gripper.tool_length: must not exceed 1 m");
    for (const CupSpec& cup : cups_)
      if (tool_length_ < lowest(cup) + arm_thickness_ + 0.005)
        throw SpecError("gripper.tool_length: too short for plunger, holder and arms");
  }

  std::vector<Eigen::Vector3d> probe_points_G() const override {
    std::vector<Eigen::Vector3d> points;
    for (const CupSpec& cup : cups_) {
      for (int i = 0; i < kRays; ++i) {
        const bool rim = i < kRimRays;
        const double angle = 2 * std::numbers::pi * (rim ? i : i - kRimRays) / (rim ? kRimRays : kInnerRays);
        const double r = rim ? cup.radius : cup.radius / 2;
        points.push_back(cup.X_GU * Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), 0));
      }
    }
    return points;
  }

  Contact judge(std::span<const SurfaceSample> samples_G) const override {
    BP_CHECK(samples_G.size() == cups_.size() * kRays, samples_G.size() << " samples for " << cups_.size() << " cups");
    Contact contact;
    std::vector<HeldCup> held;
    for (std::size_t c = 0; c < cups_.size(); ++c) {
      const CupSpec& cup = cups_[c];
      double vacuum = 0;
      contact.why.push_back(leak_of(cup, samples_G.subspan(c * kRays, kRays), vacuum));
      contact.cup_vacuum.push_back(vacuum);
      contact.cup_sealed.push_back(contact.why.back().empty());
      // A cup set at an angle pulls along its own axis; across the tool it is not counted.
      if (contact.cup_sealed.back())
        held.push_back({cup.X_GU.translation().head<2>(), cup.radius,
                        vacuum * cup.limits().pull * cup.X_GU.linear()(2, 2), cup.friction});
    }
    const std::size_t needed = min_cups_ > 0 ? static_cast<std::size_t>(min_cups_) : cups_.size();
    contact.sealed = held.size() >= needed;
    contact.limits = combined(held);
    return contact;
  }

  const std::vector<CupSpec>& cups() const override { return cups_; }

  std::vector<Primitive> body_G() const override {
    const auto at = [](double x, double y, double z) { return Pose(Eigen::Translation3d(x, y, z)); };
    std::vector<Primitive> body;
    double arms_low = 0;  // height of the arms' underside over the tip
    for (const CupSpec& cup : cups_) arms_low = std::max(arms_low, lowest(cup));
    const double stem_length = tool_length_ - arms_low;
    body.push_back(Primitive::cylinder(stem_radius_, stem_length, at(0, 0, -arms_low - stem_length / 2)));
    for (const CupSpec& cup : cups_) {
      const double sleeve_low = cup.stroke + lip_height_;
      body.push_back(
          Primitive::cylinder(holder_radius_, holder_length_, cup.X_GU * at(0, 0, -sleeve_low - holder_length_ / 2)));
      const Eigen::Vector2d p = cup.X_GU.translation().head<2>();
      if (p.norm() < stem_radius_) continue;
      const double length = p.norm() + holder_radius_;
      Pose X_arm = at(0, 0, -arms_low - arm_thickness_ / 2) *
                   Pose(Eigen::AngleAxisd(std::atan2(p.y(), p.x()), Eigen::Vector3d::UnitZ()));
      body.push_back(Primitive::box({length, arm_width_, arm_thickness_}, X_arm * at(length / 2, 0, 0)));
    }
    return body;
  }

  Pose X_FG() const override { return Pose(Eigen::Translation3d(0, 0, tool_length_)); }

 private:
  /// Height of a sleeve's upper end over the tip.
  double lowest(const CupSpec& cup) const {
    return cup.stroke + lip_height_ + holder_length_ - cup.X_GU.translation().z();
  }

  void load_preset(const std::string& name) {
    CupSpec cup;
    if (name == "one_cup") {
      cup.radius = 0.0075;  // 15 mm bellows, 1.5 folds
      cup.effective_area_ratio = 0.8;
      cup.lip_compliance = 0.0008;
      cups_ = {cup};
      return;
    }
    cups_.clear();
    cup.stiffness = 100;
    cup.preload = 0.3;
    cup.stroke = 0.020;  // a long spring plunger: the tool may lean 10 degrees off a ring's face (max_lean)
    const int count = name == "two_cups" ? 2 : name == "three_cups" ? 3 : 4;
    for (int i = 0; i < count; ++i) {
      const double angle = 2 * std::numbers::pi * i / count, pitch_radius = 0.0425;
      cup.X_GU = Pose(Eigen::Translation3d(pitch_radius * std::cos(angle), pitch_radius * std::sin(angle), 0));
      cups_.push_back(cup);
    }
  }

  std::vector<CupSpec> cups_;
  int min_cups_ = 0;
  double tool_length_ = 0.24;
  double stem_radius_ = 0.012;
  double arm_width_ = 0.012;
  double arm_thickness_ = 0.010;
  double holder_radius_ = 0.0055;
  double holder_length_ = 0.030;
  double lip_height_ = 0.006;
};

}  // namespace

std::unique_ptr<Gripper> make_suction() { return std::make_unique<Suction>(); }

}  // namespace binpick

#include "robot/one_cup.hpp"

#include <algorithm>
#include <cmath>

#include "core/check.hpp"

namespace binpick {
namespace {

constexpr double kMarkDown = 0.3;

/// Frame G of this gripper is the lip frame U of the cup it stands for.
class OneCup : public Gripper {
 public:
  OneCup(const Gripper& tool, std::size_t cup) : tool_(tool), cup_(cup), X_GU_(tool.cups()[cup].X_GU) {
    cups_ = {tool.cups()[cup]};
    cups_[0].X_GU = Pose::Identity();
  }

  void visit(ConfigVisitor&) override {}
  void validate() const override {}

  std::vector<Eigen::Vector3d> probe_points_G() const override {
    const std::vector<Eigen::Vector3d> all = tool_.probe_points_G();
    const std::size_t each = all.size() / tool_.cups().size();
    std::vector<Eigen::Vector3d> own(all.begin() + static_cast<std::ptrdiff_t>(cup_ * each),
                                     all.begin() + static_cast<std::ptrdiff_t>((cup_ + 1) * each));
    for (Eigen::Vector3d& p : own) p = X_GU_.inverse() * p;
    return own;
  }

  Contact judge(std::span<const SurfaceSample> samples_U) const override {
    std::vector<SurfaceSample> all(samples_U.size() * tool_.cups().size());  // the other cups meet nothing
    for (std::size_t i = 0; i < samples_U.size(); ++i) {
      SurfaceSample sample = samples_U[i];
      sample.point_G = X_GU_ * sample.point_G;
      sample.normal_G = X_GU_.linear() * sample.normal_G;
      all[cup_ * samples_U.size() + i] = sample;
    }
    const Contact of_tool = tool_.judge(all);
    Contact contact;
    contact.sealed = of_tool.cup_sealed[cup_];
    contact.cup_sealed = {contact.sealed};
    contact.why = {of_tool.why[cup_]};
    contact.cup_vacuum = {of_tool.cup_vacuum[cup_]};
    if (contact.sealed) contact.limits = scaled(cups_[0].limits(), contact.cup_vacuum[0]);
    return contact;
  }

  const std::vector<CupSpec>& cups() const override { return cups_; }

  std::vector<Primitive> body_G() const override {
    std::vector<Primitive> body = tool_.body_G();
    for (Primitive& piece : body) piece.X_OS = X_GU_.inverse() * piece.X_OS;
    return body;
  }

  Pose X_FG() const override { return tool_.X_FG() * X_GU_; }

 private:
  const Gripper& tool_;
  std::size_t cup_;
  Pose X_GU_;
  std::vector<CupSpec> cups_;
};

/// Any turn about the part's axis carries one into the other.
bool same_circle(const PickSite& a, const PickSite& b, const Symmetry::Axis& axis) {
  const auto along = [&](const PickSite& s) { return axis.direction_P.dot(s.X_PK.translation() - axis.point_P); };
  const auto radius = [&](const PickSite& s) {
    return axis.direction_P.cross(s.X_PK.translation() - axis.point_P).norm();
  };
  const auto rise = [&](const PickSite& s) { return axis.direction_P.dot(s.X_PK.linear().col(2)); };
  return std::abs(along(a) - along(b)) < 0.002 && std::abs(radius(a) - radius(b)) < 0.002 &&
         std::abs(rise(a) - rise(b)) < 0.1;
}

}  // namespace

std::vector<PickSite> find_one_cup_sites(const Part& part, const Gripper& gripper, const PickSiteConfig& config) {
  std::vector<PickSite> out;
  const std::size_t cups = gripper.cups().size();
  if (cups < 2) return out;
  const bool alike =
      turn_order(gripper) == static_cast<int>(cups);  // a turn of the tool brings each in the other's place
  for (std::size_t c = 0; c < (alike ? 1 : cups); ++c) {
    for (PickSite site : find_pick_sites(part, OneCup(gripper, c), config).sites) {
      site.cup = static_cast<int>(c);
      site.X_UG = gripper.cups()[c].X_GU.inverse();
      site.quality *= kMarkDown;
      const bool known = part.symmetry.axis && std::any_of(out.begin(), out.end(), [&](const PickSite& better) {
                           return better.cup == site.cup && same_circle(better, site, *part.symmetry.axis);
                         });
      if (!known) out.push_back(site);
    }
  }
  return out;
}

}  // namespace binpick

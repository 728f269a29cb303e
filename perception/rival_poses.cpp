#include "perception/rival_poses.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace binpick {
namespace {

constexpr std::size_t kPoints = 150;  // explained points that are tried
constexpr double kToChange = 1.5;     // times the clear lead, for a pose that replaces what the search had found
constexpr double kOnePlace = 0.08;    // of the radius: corners that lie nearer mean one pose

/// Share of the explained points that lie on the part's surface when it stands at X * T.
double share_on_surface(const std::vector<Eigen::Vector3f>& points_P, const Pose& T, const SurfaceModel& model,
                        float near) {
  if (points_P.empty()) return 0;
  const Eigen::Isometry3f back = T.inverse().cast<float>();
  const float sideways = 4 * model.spacing() * model.spacing();
  int on = 0;
  for (const Eigen::Vector3f& p : points_P) {
    const Eigen::Vector3f q = back * p;
    const int k = model.nearest(q);
    if (k < 0) continue;
    const Eigen::Vector3f d = q - model.points()[k];
    const float r = model.normals()[k].dot(d);
    on += std::abs(r) < near && d.squaredNorm() - r * r < sideways;
  }
  return static_cast<double>(on) / static_cast<double>(points_P.size());
}

std::vector<Eigen::Vector3f> explained_points(const Scene& scene, const Candidate& c) {
  const Eigen::Isometry3f X_PC = c.fit.X_CP.inverse().cast<float>();
  const std::size_t step = std::max<std::size_t>(1, c.check.explained.size() / kPoints);
  std::vector<Eigen::Vector3f> points_P;
  for (std::size_t i = 0; i < c.check.explained.size(); i += step) {
    const int u = static_cast<int>(c.check.explained[i]) % scene.depth.width();
    const int v = static_cast<int>(c.check.explained[i]) / scene.depth.width();
    points_P.push_back(X_PC * scene.point(u, v, scene.depth(u, v)));
  }
  return points_P;
}

bool one_place(const Pose& X_1, const Pose& X_2, const SurfaceModel& model) {
  for (int corner = 0; corner < 8; ++corner) {
    const auto type = static_cast<Eigen::AlignedBox3f::CornerType>(corner);
    const Eigen::Vector3d p_P = model.box().corner(type).cast<double>();
    if ((X_1 * p_P - X_2 * p_P).norm() > kOnePlace * model.radius()) return false;
  }
  return true;
}

/// What speaks for a pose. The depth alone counts: on a narrow strip of a face seen at a grazing angle, which is what
/// often tells two twins apart, the scene has no normal to trust.
struct Evidence {
  double for_it = 0;     ///< pixels that agree and that no other pose explains, less twice those seen through
  double of_others = 0;  ///< pixels that agree, but belong to another pose
};

Evidence evidence(const ViewCheck& check, const std::vector<std::uint8_t>& taken) {
  Evidence e;
  for (const std::uint32_t i : check.explained) (taken[i] == 0 ? e.for_it : e.of_others) += 1;
  e.for_it += check.off - 2.0 * check.through;
  return e;
}

/// Pixels of net evidence that decide between two poses. Twins differ along their outlines, and how sharply these show
/// is the sensor's: where the foreground does not grow they say the same with a third of the pixels (icp weighs them
/// alike).
double clear_lead(const Scene& scene, const RivalConfig& rivals, const Candidate& candidate) {
  return rivals.least_difference * (1 + 2 * scene.noise.fattening_px) / 3 * candidate.check.inliers;
}

}  // namespace

void RivalConfig::visit(ConfigVisitor& v) {
  v.field("least_alike", least_alike, Unit::kNone, "of the explained points that a rival must explain, too");
  v.field("least_difference", least_difference, Unit::kNone,
          "of the explained pixels: net evidence that decides between a pose and its rival, where the sensor's "
          "foreground grows by a pixel; a third of it where it does not");
}

void RivalConfig::validate() const {
  if (!(least_alike >= 0 && least_alike <= 1)) throw SpecError("rivals.least_alike: must lie between 0 and 1");
  if (!(least_difference >= 0 && least_difference <= 1))
    throw SpecError("rivals.least_difference: must lie between 0 and 1");
}

bool settle_rivals(const Scene& scene, const SurfaceModel& model, const std::vector<SelfOverlap>& overlaps,
                   const RivalSettings& settings, const std::vector<std::uint8_t>& taken, Candidate& candidate) {
  const auto z = static_cast<float>((candidate.fit.X_CP * model.center().cast<double>()).z());
  const float near = depth_tolerance(scene, z, settings.check);
  const std::vector<Eigen::Vector3f> points_P = explained_points(scene, candidate);
  const Pose X_CP = candidate.fit.X_CP;
  bool changed = false;
  for (const SelfOverlap& overlap : overlaps) {
    if (share_on_surface(points_P, overlap.T, model, near) < settings.rivals.least_alike) continue;
    Candidate rival = candidate;
    rival.fit = refine_pose(scene, model, X_CP * overlap.T, settings.icp, IcpStage::kFine);
    if (!one_place(rival.fit.X_CP, X_CP * overlap.T, model)) continue;   // slid back, or elsewhere
    if (one_place(rival.fit.X_CP, candidate.fit.X_CP, model)) continue;  // an earlier overlap led here
    if (!fits_bin(scene, model, rival.fit.X_CP, settings.check)) continue;
    rival.check = check_view(scene, model, rival.fit.X_CP, settings.check);
    const Evidence now = evidence(candidate.check, taken), then = evidence(rival.check, taken);
    const double lead = then.for_it - now.for_it;
    const double clear = clear_lead(scene, settings.rivals, candidate);
    if (lead < -clear || then.of_others > now.of_others + clear) continue;
    rival.ambiguous = lead <= kToChange * clear;
    candidate.ambiguous = rival.ambiguous;
    // Between equals the choice is free, and the one that stands better against other poses is the practical one.
    if (rival.ambiguous && rival.check.score() <= candidate.check.score()) continue;
    candidate = rival;
    changed = true;
  }
  return changed;
}

}  // namespace binpick

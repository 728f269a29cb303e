#include "perception/icp.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <memory>
#include <numbers>

#include "core/error.hpp"
#include "perception/icp_points.hpp"
#include "perception/outline_term.hpp"
#include "perception/pose_covariance.hpp"

namespace binpick {
namespace {

constexpr float kRoughAgreement = 0.5f;        // cosine between normals, 60 degrees: from afar
constexpr float kFineAgreement = 0.8f;         // 37 degrees: a window over an edge leans halfway and would pull
constexpr double kRobust = 1.5;                // of the scale, Cauchy's constant
constexpr double kLeastScale = 0.0005;         // m
constexpr double kPriorLength = 0.02;          // m, damping: directions nothing is known about stay where they are
constexpr double kPriorAngle = 0.3;            // rad
constexpr float kShareOfThickness = 0.5f;      // of the thinnest extent
constexpr double kSearchStep = 3;              // px by which the search across the outline narrows
constexpr double kLeastOutlineVariance = 0.1;  // of outline_sigma squared: whole pixels are no finer
constexpr int kFewestPoints = 6;
constexpr double kStillLength = 5e-5;  // m, a smaller step ends the iteration
constexpr double kStillAngle = 5e-4;   // rad

/// Weighted normal equations of twists in P: residual = a . twist.
struct Equations {
  Matrix6d A = Matrix6d::Zero();
  Vector6d b = Vector6d::Zero();
  int points = 0;
  double sum_abs = 0, sum_squares = 0;

  void add(const SurfaceSums& sums, double share) {
    for (int row = 0, t = 0; row < 6; ++row) {
      for (int column = 0; column <= row; ++column) A(row, column) += share * sums.A[t++];
      b[row] += share * sums.b[row];
    }
    points += static_cast<int>(sums.points);
    sum_abs += sums.sum_abs;
    sum_squares += sums.sum_squares;
  }
  void add(const Vector6d& a, double residual, double weight) {
    A.selfadjointView<Eigen::Lower>().rankUpdate(a, weight);
    b += weight * residual * a;
  }
  Matrix6d information() const {
    Matrix6d full = A.selfadjointView<Eigen::Lower>();
    full.diagonal().head<3>().array() += 1 / (kPriorLength * kPriorLength);
    full.diagonal().tail<3>().array() += 1 / (kPriorAngle * kPriorAngle);
    return full;
  }
};

struct Weighting {
  float gate = 0;       // m
  double scale = 0;     // m, of one residual
  float agreement = 0;  // cosine
  double share = 1;     // of a point's weight: neighbours repeat each other's noise, the outline must not drown
};

void add_surface(const IcpPoints& points, const SurfaceModel& model, const Pose& X_CP, const Weighting& w,
                 Equations& out) {
  const Eigen::Isometry3f X_PC = X_CP.inverse().cast<float>();
  const Eigen::Vector3f eye_P = X_PC.translation();
  SurfaceQuery query;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) query.R_PC[3 * row + column] = X_PC.linear()(row, column);
    query.p_PC[row] = eye_P[row];
  }
  query.view = model.view_of((eye_P - model.center()).normalized());
  query.gate = w.gate * w.gate;
  query.sideways = 4 * model.spacing() * model.spacing() + 0.25f * query.gate;
  query.agreement = w.agreement;
  query.scale = static_cast<float>(w.scale);
  query.robust = static_cast<float>(kRobust);
  SurfaceSums sums;
  add_surface_points(points.view(), model.grid(), query, sums);
  out.add(sums, w.share);
}

/// One equation of the outline, kept over iterations: drawing the part is the dearest step.
struct OutlineRow {
  Vector6d a;
  double residual, weight;
};

std::vector<OutlineRow> outline_rows(const Scene& scene, const SurfaceModel& model, const Pose& X_CP,
                                     const IcpConfig& config, double search) {
  std::vector<OutlineRow> rows;
  const PartView view = draw_part(scene.camera, model, X_CP);
  if (view.pixels == 0) return rows;
  const auto z = static_cast<float>((X_CP * model.center().cast<double>()).z());
  // Less than the step from a thin part down to what it lies on.
  const float step = kShareOfThickness * model.box().sizes().minCoeff();
  const float tolerance = std::min(std::max(0.004f, 3 * scene.sigma(z)), std::max(step, 1.5f * scene.sigma(z)));
  const Eigen::Isometry3f X_PC = X_CP.inverse().cast<float>();
  const double scale = config.outline_sigma * scene.pixel(z) * search / config.outline_search;
  for (const OutlineOffset& o : outline_offsets(scene, view, static_cast<int>(search), tolerance)) {
    const double x = o.offset / (kRobust * scale);
    const Eigen::Vector3f p = X_PC * o.point_C, direction = X_PC.linear() * o.outward_C;
    Vector6d a;
    a << direction.cast<double>(), p.cross(direction).cast<double>();
    rows.push_back({a, o.offset, 1 / (scale * scale * (1 + x * x))});
  }
  return rows;
}

}  // namespace

void IcpConfig::visit(ConfigVisitor& v) {
  v.field("coarse_iterations", coarse_iterations, "iterations on the surface alone, gate shrinking");
  v.field("quick_iterations", quick_iterations, "iterations with few points that tell whether a pose is worth more");
  v.field("fine_iterations", fine_iterations, "iterations with the narrow gate and the silhouette");
  v.field("gate", gate, Unit::kNone, "first reach of the closest points, of the diameter");
  v.field("least_gate", least_gate, Unit::kLength, "last reach, beside three standard deviations of the sensor");
  v.field("accept", accept, Unit::kLength, "accepted mean deviation from the surface (paper 4.2: 1 mm)");
  v.field("accept_sigmas", accept_sigmas, Unit::kNone,
          "plus so many standard deviations of the sensor; 0: the paper's");
  v.field("points", points, "scene points used for one part, about");
  v.field("density", density, "times as many points in the fine stage, of together the same weight");
  v.field("silhouette", silhouette, "align the outline with the depth steps of the scene");
  v.field("outline_search", outline_search, Unit::kNone, "pixels searched to either side of the outline");
  v.field("outline_first", outline_first, Unit::kNone, "the same at first, narrowing from drawing to drawing");
  v.field("outline_sigma", outline_sigma, Unit::kNone, "standard deviation of one outline pixel, in pixels");
  v.field("correlated_px", correlated_px, Unit::kNone,
          "pixels that share one noise value; 0: as measured in the frame");
  v.field("bias_sigmas", bias_sigmas, Unit::kNone,
          "standard deviations that do not average out, where noise is shared");
}

void IcpConfig::validate() const {
  for (const int n : {coarse_iterations, quick_iterations, fine_iterations})
    if (n < 0 || n > 200)
      throw SpecError("icp.coarse_iterations, quick_iterations, fine_iterations: must lie between 0 and 200");
  if (!(gate > 0 && gate <= 0.5)) throw SpecError("icp.gate: must lie between 0 and 0.5");
  if (!(least_gate > 0 && least_gate < 0.1)) throw SpecError("icp.least_gate: must lie between 0 and 100 mm");
  if (!(accept > 0 && accept < 0.1)) throw SpecError("icp.accept: must lie between 0 and 100 mm");
  if (!(accept_sigmas >= 0 && accept_sigmas <= 20)) throw SpecError("icp.accept_sigmas: must lie between 0 and 20");
  if (points < 50) throw SpecError("icp.points: must be at least 50");
  if (!(outline_search >= 1 && outline_search <= 15)) throw SpecError("icp.outline_search: must lie between 1 and 15");
  if (!(outline_first >= 1 && outline_first <= 15)) throw SpecError("icp.outline_first: must lie between 1 and 15");
  if (density < 1 || density > 50) throw SpecError("icp.density: must lie between 1 and 50");
  if (!(outline_sigma > 0 && outline_sigma <= 20)) throw SpecError("icp.outline_sigma: must lie between 0 and 20");
  if (!(correlated_px == 0 || (correlated_px >= 1 && correlated_px <= 1e4)))
    throw SpecError("icp.correlated_px: must be 0 (measured) or lie between 1 and 1e4");
  if (!(bias_sigmas >= 0 && bias_sigmas <= 10)) throw SpecError("icp.bias_sigmas: must lie between 0 and 10");
}

double accepted_deviation(const Scene& scene, double z, const IcpConfig& config) {
  return config.accept + config.accept_sigmas * scene.noise.sigma(z);
}

namespace {

/// One refinement: the gate shrinks, the outline is drawn anew every second round.
class Refinement {
 public:
  Refinement(const Scene& scene, const SurfaceModel& model, const IcpConfig& config, IcpStage stage)
      : scene_(scene), model_(model), config_(config), fine_(stage != IcpStage::kCoarse) {
    if (stage != IcpStage::kFine) config_.density = 1;
    config_.points = fine_ ? config_.points * config_.density : config_.points / 2;
    if (stage == IcpStage::kQuick) config_.fine_iterations = config_.quick_iterations;
  }

  IcpResult run(const Pose& X_CP) {
    X_CP_ = X_CP;
    sigma_ = scene_.sigma(static_cast<float>((X_CP * model_.center().cast<double>()).z()));
    const float last = std::max(static_cast<float>(config_.least_gate), 3 * sigma_);
    gate_ = fine_ ? last : std::max(last, static_cast<float>(config_.gate) * 2 * model_.radius());
    points_ = std::make_unique<IcpPoints>(scene_, model_, X_CP_, gate_, config_.points);
    int left = fine_ ? config_.fine_iterations : config_.coarse_iterations;
    for (int round = 0; assemble(fine_ && config_.silhouette && round % 2 == 0 && left > 0) && left > 0; ++round) {
      const bool still = move();
      left = still && gate_ <= last ? 0 : left - 1;  // the last assembly only measures
      gate_ = std::max(last, 0.75f * gate_);
    }
    return result();
  }

 private:
  /// The equations at the current pose; false when too little of the scene is near.
  bool assemble(bool draw) {
    const double scale = std::max({kLeastScale, static_cast<double>(sigma_), gate_ / 6.0});
    const Weighting weighting{gate_, scale, fine_ ? kFineAgreement : kRoughAgreement,
                              fine_ ? 1.0 / config_.density : 1};
    equations_ = Equations();
    add_surface(*points_, model_, X_CP_, weighting, equations_);
    surface_ = equations_.A.selfadjointView<Eigen::Lower>();
    scale_ = scale;
    if (equations_.points < kFewestPoints) return false;
    if (draw) {
      outline_ = outline_rows(scene_, model_, X_CP_, config_, search_);
      search_ = std::max(config_.outline_search, search_ - kSearchStep);
    }
    for (const OutlineRow& row : outline_) equations_.add(row.a, row.residual, row.weight);
    return true;
  }

  /// One Gauss-Newton step; true when it was negligible.
  bool move() {
    const Vector6d twist = equations_.information().ldlt().solve(equations_.b);
    X_CP_ = orthonormalised(X_CP_ * exp_se3(twist));
    for (OutlineRow& row : outline_) row.residual -= row.a.dot(twist);
    return twist.head<3>().norm() < kStillLength && twist.tail<3>().norm() < kStillAngle;
  }

  IcpResult result() const {
    IcpResult out;
    out.X_CP = X_CP_;
    out.points = equations_.points;
    if (out.points > 0) {
      out.mean_deviation = equations_.sum_abs / out.points;
      out.rms = std::sqrt(equations_.sum_squares / out.points);
    }
    out.covariance = pose_covariance(information());
    return out;
  }

  /// What the pose hangs on, with the variances that are seen in the residuals.
  PoseInformation information() const {
    PoseInformation info;
    const double shared = config_.correlated_px > 0 ? config_.correlated_px : scene_.correlated_px;
    const double repeats = std::max(1.0, shared / (points_->step() * points_->step()));
    const double share = fine_ ? 1.0 / config_.density : 1;
    info.surface = surface_;
    if (equations_.points > 0)
      info.surface_variance = share * repeats * equations_.sum_squares / (equations_.points * scale_ * scale_);
    double squares = 0;
    for (const OutlineRow& row : outline_) {
      info.outline += row.weight * row.a * row.a.transpose();
      squares += row.weight * row.residual * row.residual;
    }
    // Foreground that grows by g pixels takes 2 g + 1 of the outline along.
    if (!outline_.empty())
      info.outline_variance = (1 + 2 * scene_.noise.fattening_px) *
                              std::max(kLeastOutlineVariance, squares / static_cast<double>(outline_.size()));
    const Eigen::Vector3d away_P = X_CP_.linear().transpose() * (X_CP_ * model_.center().cast<double>()).normalized();
    info.bias.head<3>() = config_.bias_sigmas * sigma_ * (1 - 1 / shared) * away_P;
    return info;
  }

  const Scene& scene_;
  const SurfaceModel& model_;
  IcpConfig config_;
  bool fine_;
  Pose X_CP_ = Pose::Identity();
  float sigma_ = 0, gate_ = 0;
  double search_ = std::max(config_.outline_search, config_.outline_first);
  double scale_ = 1;
  Matrix6d surface_ = Matrix6d::Zero();
  std::unique_ptr<IcpPoints> points_;
  Equations equations_;
  std::vector<OutlineRow> outline_;
};

}  // namespace

IcpResult refine_pose(const Scene& scene, const SurfaceModel& model, const Pose& X_CP, const IcpConfig& config,
                      IcpStage stage) {
  return Refinement(scene, model, config, stage).run(X_CP);
}

}  // namespace binpick

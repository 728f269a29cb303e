#include "trials/pose_verification.hpp"

#include "trials/sight.hpp"

namespace binpick {
namespace {

/// Where a person who sees everything would set the tool, and on which instance.
struct Taught {
  std::size_t instance = 0;
  Pose X_WG = Pose::Identity();
};

std::optional<Taught> teach(const TrialContext& context, const Observation& seen) {
  EstimateResult all;
  std::vector<std::size_t> instances;
  for (std::size_t i = 0; i < seen.truth.instances.size(); ++i) {
    const GroundTruth::Instance& instance = seen.truth.instances[i];
    if (instance.visible_fraction < 0.5) continue;
    PoseEstimate estimate;
    estimate.part = instance.part;
    estimate.X_CP = seen.truth.X_WC.inverse() * instance.X_WP;
    estimate.score = instance.visible_fraction;
    estimate.inlier_fraction = 1;
    all.estimates.push_back(estimate);
    instances.push_back(i);
  }
  if (all.estimates.empty()) return std::nullopt;
  all.status = EstimateStatus::kFound;
  const PlanResult plan = context.planner->plan(all, seen.view, seen.truth.X_WC, {});
  if (!plan.plan) return std::nullopt;
  return Taught{instances[plan.plan->estimate], plan.plan->X_WG};
}

}  // namespace

VerifiedPose verify_pose(const Scenario& s, TrialContext& context, Seed seed) {
  VerifiedPose out;
  out.seed = seed.key;
  const TrueCell built = true_cell(s, context, seed);
  CellWorld cell_world(built.cell, s.physics, context.parts);
  drop_heap(s, context, seed, cell_world);
  const Observation seen = observe(s, cell_world, context, seed, 0);
  const std::optional<Taught> taught = teach(context, seen);
  if (!taught) return out.failure = "no part can be taught", out;
  const Pose X_RW = s.cell.X_WR.inverse();
  out.X_RG_taught = X_RW * taught->X_WG;
  const EstimateResult found = estimate_view(s, context, seen.view, seen.truth, seed.child("estimator", 0));
  const PoseCheck check = context.checker->check(found, seen.X_WC_believed, seen.truth);
  const GroundTruth::Instance& instance = seen.truth.instances[taught->instance];
  for (const MatchedEstimate& match : check.estimates) {
    if (!match.right || match.instance != taught->instance) continue;
    const Pose X_WP = nearest_equivalent(seen.X_WC_believed * found.estimates[match.estimate].X_CP, instance.X_WP,
                                         context.parts[instance.part].symmetry);
    out.X_RG_found = X_RW * X_WP * instance.X_WP.inverse() * taught->X_WG;
    return out;
  }
  return out.failure = "not recognised", out;
}

}  // namespace binpick

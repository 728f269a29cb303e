// The paper's verification of a pose (5.2): the tool is taken to a part by hand and its pose read off, the arm moves
// away, recognises the part, and the pose that it would go to is read off again.
#pragma once

#include "evaluation/paper_tables.hpp"
#include "trials/scenario.hpp"
#include "trials/trial_context.hpp"

namespace binpick {

/// The seed's heap; the part is the one that a person would show first: the first pick planned on the true poses of
/// what is at least half visible. Recognised is what a right estimate (MSSD below 0.1 diameter) is matched to; of its
/// symmetric twins the nearest counts.
VerifiedPose verify_pose(const Scenario& scenario, TrialContext& context, Seed seed);

}  // namespace binpick

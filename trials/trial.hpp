// A trial: drop, then look, estimate, check, plan, pick, again and again. A pure function of (scenario, seed).
#pragma once

#include "evaluation/trial_record.hpp"
#include "trials/artifacts.hpp"
#include "trials/replay_recorder.hpp"
#include "trials/scenario.hpp"
#include "trials/trial_context.hpp"

namespace binpick {

/// Every exit is a record: what the world refuses is an outcome, our own bugs become an InternalError with their seed.
/// Pictures and replay are made on the way where they are asked for, and change no bit of the record.
TrialRecord run_trial(const Scenario& scenario, Seed seed, TrialContext& context, TrialPictures* pictures = nullptr,
                      ReplayRecorder* replay = nullptr);

}  // namespace binpick

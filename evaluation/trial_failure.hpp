// How a trial can end without being a measurement: the program failed, not the pick. Such a trial is no pick record and
// enters no rate; it is counted beside them, with its seed.
#pragma once

#include <string>
#include <vector>

namespace binpick {

enum class TrialFailure {
  kCrash,          ///< the worker died of a signal, or ended without an answer
  kTimeout,        ///< the watchdog ended it
  kOutOfMemory,    ///< it wanted more memory than a worker may have
  kInternalError,  ///< a broken invariant, told by the trial itself
};

std::string to_string(TrialFailure failure);
TrialFailure trial_failure_from(const std::string& text);  ///< throws SpecError
const std::vector<TrialFailure>& all_trial_failures();
/// One phrase for people.
std::string meaning(TrialFailure failure);

}  // namespace binpick

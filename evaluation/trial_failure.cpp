#include "evaluation/trial_failure.hpp"

#include <array>

#include "core/error.hpp"

namespace binpick {
namespace {

struct Name {
  TrialFailure failure;
  const char* text;
  const char* meaning;
};

constexpr std::array<Name, 4> kNames = {{
    {TrialFailure::kCrash, "Crash", "the worker died, twice in a row"},
    {TrialFailure::kTimeout, "Timeout", "the watchdog ended it, twice in a row"},
    {TrialFailure::kOutOfMemory, "OutOfMemory", "it wanted more memory than a worker may have, twice in a row"},
    {TrialFailure::kInternalError, "InternalError", "a bug of the testbed"},
}};

const Name& name_of(TrialFailure failure) {
  for (const Name& name : kNames)
    if (name.failure == failure) return name;
  return kNames.back();
}

}  // namespace

std::string to_string(TrialFailure failure) { return name_of(failure).text; }
std::string meaning(TrialFailure failure) { return name_of(failure).meaning; }

const std::vector<TrialFailure>& all_trial_failures() {
  static const std::vector<TrialFailure> all = {TrialFailure::kCrash, TrialFailure::kTimeout,
                                                TrialFailure::kOutOfMemory, TrialFailure::kInternalError};
  return all;
}

TrialFailure trial_failure_from(const std::string& text) {
  for (const Name& name : kNames)
    if (text == name.text) return name.failure;
  throw SpecError("'" + text + "' is no failure of a trial");
}

}  // namespace binpick

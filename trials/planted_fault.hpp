// Faults planted on purpose in chosen trials of a worker, so that tests can show what a campaign makes of them.
#pragma once

#include <cstdint>
#include <string>

namespace binpick {

/// `plan`: "KIND:SEED,KIND:SEED,.." of segfault, abort, hang, leak (all memory), drip (240 MB, and goes on), exit,
/// garbage; "once-KIND" spares the second attempt. Commits what is planned for this trial; throws SpecError when the
/// plan cannot be read.
void commit_planted_fault(const std::string& plan, std::uint64_t seed, int attempt);

}  // namespace binpick

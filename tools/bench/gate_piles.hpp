// Made-up piles for measuring the gate: what two versions do with the same pile, drawn from stated laws, or drawn again
// from the piles of two real runs.
#pragma once

#include "core/random.hpp"
#include "evaluation/pile_figures.hpp"

namespace binpick {

struct PileLaw {
  double base_rate = 0.95, new_rate = 0.95;  ///< of a pick, in the mean over piles
  double spread = 0.15;  ///< standard deviation of the rate from pile to pile (beta law): picks of one hang together
  /// Share of the piles whose rate the new version draws anew: heaps that went another way after the first picks. In
  /// two runs of thirty equal heaps of bearings with different cameras 11 and 12 had another number of successes or
  /// attempts.
  double redrawn = 0.4;
  double shared = 0.5;  ///< share of the picks whose luck is the same for both versions: the rest is drawn anew
  int picks = 10;       ///< attempts of a pile
  int errors = 12;      ///< poses with an error
};

struct PilePair {
  PileFigures base, fresh;
};

/// Both versions see a pile of the same difficulty, or of another one where it is redrawn. No bit is equal: the worst
/// case for a gate that tests bits first.
PilePair draw_pair(const PileLaw& law, std::uint64_t seed, Rng& rng);

/// Where picks hang together: the variance of a pile's rate over that of independent picks (design effect).
double design_effect(const PileLaw& law);

}  // namespace binpick

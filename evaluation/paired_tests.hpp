// Tests of paired results: the same seed, so the same pile, seen by a base and by a new version. The unit is the pile,
// never the pick: the picks of one pile stand and fall together. All tests ask one-sidedly whether the new version is
// worse. Random draws come from the named stream that is handed in.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "evaluation/statistics.hpp"

namespace binpick {

/// One yes-or-no verdict per pile, by base and new version.
struct PairedVerdicts {
  std::size_t both = 0;
  std::size_t lost = 0;  ///< base yes, new no
  std::size_t won = 0;   ///< base no, new yes
  std::size_t neither = 0;
  std::size_t total() const { return both + lost + won + neither; }
};

/// Exact McNemar test: P(at least `lost` of the piles that differ are losses) when either way is as likely. 1 when no
/// pile differs.
double mcnemar_worse(const PairedVerdicts& verdicts);

/// Tango's score interval (Statistics in Medicine 17, 1998) of the loss (lost - won) / total, in [-1, 1].
Interval tango_interval(const PairedVerdicts& verdicts, double confidence = 0.95);

struct SignFlipEffort {
  std::size_t exact_up_to = 16;     ///< piles that differ: every one of the 2^n sign patterns is visited
  std::size_t draws = 400000;       ///< random patterns at most
  std::size_t enough_beyond = 200;  ///< patterns at least as bad as what was seen, after which drawing ends
};

/// Sign-flip test: `losses` holds one number per pile that changes its sign when the pile's two results change places.
/// The chance that a sum at least as large comes about when the signs are coins. Exact for few piles; else by random
/// signs with the stopping rule of Besag and Clifford (Biometrika 78, 1991), which keeps the level.
double sign_flip_worse(std::span<const double> losses, Seed seed, const SignFlipEffort& effort = {});

/// Holm's step-down adjustment (1979): reject those <= alpha and the chance of any false rejection is <= alpha.
std::vector<double> holm(std::span<const double> p_values);

}  // namespace binpick

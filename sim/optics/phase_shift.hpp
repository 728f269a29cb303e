// Phase-shifted stripes: cosines over the columns of a projector, each shown in `steps` equally spaced shifts, at three
// frequencies (1, ratio and ratio^2 periods), so that each unwraps the next. Position on the pattern is x, the tangent
// of the column's angle in D, between -half and half; the coarsest cosine covers a tenth more, so that it never wraps.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace binpick {

struct PhaseShift {
  static constexpr int kFrequencies = 3;
  static constexpr double kMargin = 1.1;

  int steps = 4;       ///< shifts of each frequency, at least 3
  int ratio = 10;      ///< of one frequency to the next
  double half = 0.42;  ///< tangent of half the horizontal field of view

  double periods(int frequency) const { return std::pow(ratio, frequency); }
  struct Shift {
    double cosine, sine;
  };
  /// One for each step, equally spaced over a turn.
  std::vector<Shift> shifts() const;
  /// Phase at x, in rad, not wrapped: 0 .. 2 pi periods.
  double phase(int frequency, double x) const {
    return 2 * std::numbers::pi * periods(frequency) * (0.5 + 0.5 * x / (kMargin * half));
  }
  /// x from the three wrapped phases, coarsest first: each picks the period of the next.
  double position(const std::array<double, kFrequencies>& wrapped) const;
};

/// What `steps` samples I_n = B + A cos(phase + shift_n) say.
struct PhaseSums {
  double sine = 0, cosine = 0;

  void add(double sample, const PhaseShift::Shift& shift) {
    sine -= sample * shift.sine;
    cosine += sample * shift.cosine;
  }
  double phase() const { return std::atan2(sine, cosine); }
  double amplitude(int steps) const { return 2 * std::hypot(sine, cosine) / steps; }  ///< A
};

}  // namespace binpick

#include "sim/optics/phase_shift.hpp"

namespace binpick {

std::vector<PhaseShift::Shift> PhaseShift::shifts() const {
  std::vector<Shift> all;
  for (int step = 0; step < steps; ++step) {
    const double angle = 2 * std::numbers::pi * step / steps;
    all.push_back({std::cos(angle), std::sin(angle)});
  }
  return all;
}

double PhaseShift::position(const std::array<double, kFrequencies>& wrapped) const {
  constexpr double turn = 2 * std::numbers::pi;
  double absolute = wrapped[0] < 0 ? wrapped[0] + turn : wrapped[0];
  for (int f = 1; f < kFrequencies; ++f) {
    const double fine = wrapped[static_cast<std::size_t>(f)];
    absolute = fine + turn * std::round((ratio * absolute - fine) / turn);
  }
  return (absolute / (turn * periods(kFrequencies - 1)) - 0.5) * 2 * kMargin * half;
}

}  // namespace binpick

// Suction cups by name: `flat_10`, `bellows_20` ... What a tool's cup starts from (`model:`), each value with its
// source.
//
// Sources, with d the lip's diameter, linear between 6 and 40 mm where two values are given (reference
// physical_models):
//   vacuum              60 kPa: the level at which Schmalz's catalogues state holding forces (B1)
//   friction            0.5: Schmalz, metal and glass, dry (B1)
//   effective area      flat 1 (F = dp pi d^2 / 4, B1), bellows 0.8 (0.7-0.9: they seal on a smaller radius, B1)
//   stroke              flat 1-3 mm, bellows of 1.5 folds 4-8 mm (B3)
//   lip_stiffness       flat 3 N/mm, bellows 1 N/mm: the ends of B3's range; pressing the cup in takes as much
//   lip_compliance      flat 0.3 mm, bellows 0.5 mm (B3, largest residual gap)
//   max_tilt            flat 10 deg, bellows 15 deg (B3)
//   time_constant       30-100 ms (B3): the volume to empty grows with the cup
//   leak_gap            8 l/min (Schmalz, cups up to 60 mm, B1) through a slit along the rim at the speed of 60 kPa:
//                       Q / (pi d c sqrt(2 dp / rho)), c = 0.6, rho = 1.2 kg/m^3; 22 um for d = 10 mm
// Several of these are marked in the reference as recalled, not looked up: measure your own cup and override them.
#pragma once

#include <string>
#include <vector>

#include "core/cup.hpp"

namespace binpick {

struct CupModel {
  std::string name, help;
  CupSpec spec;  ///< X_GU stays at the identity
};

const std::vector<CupModel>& cup_models();
std::vector<std::string> cup_model_names();
const CupModel& cup_model(const std::string& name);  ///< throws SpecError with the nearest name

}  // namespace binpick

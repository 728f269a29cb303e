#include "core/cup_models.hpp"

#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/yaml.hpp"

namespace binpick {
namespace {

constexpr int kDiameters[] = {6, 8, 10, 15, 20, 25, 30, 40};  // mm
constexpr double kPumpFlow = 8e-3 / 60;                       // m^3/s
constexpr double kDischarge = 0.6, kAirDensity = 1.2;         // -, kg/m^3

/// `small` at 6 mm, `large` at 40 mm.
double between(double small, double large, double diameter) {
  return small + (large - small) * (diameter - 0.006) / 0.034;
}

CupModel made(bool bellows, int millimetres) {
  const double d = 1e-3 * millimetres;
  CupModel model;
  model.name = (bellows ? "bellows_" : "flat_") + std::to_string(millimetres);
  model.help = (bellows ? "bellows cup of 1.5 folds, " : "flat cup, ") + std::to_string(millimetres) + " mm";
  CupSpec& cup = model.spec;
  cup.radius = d / 2;
  cup.vacuum = 60e3;
  cup.friction = 0.5;
  cup.effective_area_ratio = bellows ? 0.8 : 1.0;
  cup.stroke = bellows ? between(0.004, 0.008, d) : between(0.001, 0.003, d);
  cup.lip_stiffness = bellows ? 1000 : 3000;
  cup.stiffness = cup.lip_stiffness;
  cup.preload = 0;
  cup.lip_compliance = bellows ? 0.0005 : 0.0003;
  cup.max_tilt = (bellows ? 15 : 10) * std::numbers::pi / 180;
  cup.time_constant = between(0.030, 0.100, d);
  cup.leak_gap = kPumpFlow / (std::numbers::pi * d * kDischarge * std::sqrt(2 * cup.vacuum / kAirDensity));
  return model;
}

}  // namespace

const std::vector<CupModel>& cup_models() {
  static const std::vector<CupModel> models = [] {
    std::vector<CupModel> all;
    for (const bool bellows : {false, true})
      for (const int diameter : kDiameters) all.push_back(made(bellows, diameter));
    return all;
  }();
  return models;
}

std::vector<std::string> cup_model_names() {
  std::vector<std::string> names;
  for (const CupModel& model : cup_models()) names.push_back(model.name);
  return names;
}

const CupModel& cup_model(const std::string& name) {
  for (const CupModel& model : cup_models())
    if (model.name == name) return model;
  const std::string near = nearest_name(name, cup_model_names());
  throw SpecError("cup.model: unknown cup '" + name + "'" + (near.empty() ? "" : ", did you mean '" + near + "'?"));
}

}  // namespace binpick

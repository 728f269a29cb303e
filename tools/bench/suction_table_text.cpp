#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tools/bench/suction_table.hpp"

namespace binpick {
namespace {

template <class... Values>
std::string line(const char* format, Values... values) {
  char text[256];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

std::string number_or(const char* otherwise, const char* format, double value) {
  return std::isnan(value) ? otherwise : line(format, value);
}

}  // namespace

std::string text_of(const SuctionTable& table, const SuctionTableConfig& config) {
  std::string text = "Share held of " + std::to_string(config.draws) +
                     " grasps (statics of the same grasps); at the lift of m/s^2:\n\n";
  std::string head = "| cup mm | cups | vacuum kPa | sealed |", rule = "|---|---|---|---|";
  for (const double a : config.accelerations) head += line(" %g |", a), rule += "---|";
  const double moment_at = config.accelerations[config.accelerations.size() / 2];
  text += head + line(" moment at %g, mN m | same verdict |\n", moment_at) + rule + "---|---|\n";
  const std::size_t columns = config.accelerations.size();
  for (std::size_t i = 0; i + columns <= table.cells.size(); i += columns) {
    const SuctionCell& first = table.cells[i];
    const double n = first.draws;
    text += line("| %g | %d | %g | %.2f (%.2f) |", 1e3 * first.diameter, first.cups, 1e-3 * first.vacuum,
                 first.sealed / n, first.sealed_theory / n);
    int same = 0;
    std::string moment;
    for (std::size_t k = i; k < i + columns; ++k) {
      const SuctionCell& c = table.cells[k];
      text += line(" %.2f (%.2f) |", c.held / n, c.held_theory / n);
      same += c.same;
      if (c.acceleration == moment_at) {
        moment =
            " " + number_or("-", "%.1f", 1e3 * c.moment) + " (" + number_or("-", "%.1f", 1e3 * c.moment_theory) + ") |";
      }
    }
    text += moment + line(" %.3f |\n", same / (n * static_cast<double>(columns)));
  }
  text += "\nAcceleration at which a centred grasp comes off, ramped:\n\n";
  text += "| cup mm | cups | vacuum kPa | measured m/s^2 | statics m/s^2 |\n|---|---|---|---|---|\n";
  for (const SuctionLimit& l : table.limits)
    text += line("| %g | %d | %g | %s | %s |\n", 1e3 * l.diameter, l.cups, 1e-3 * l.vacuum,
                 number_or("not at rest", "%.2f", l.measured).c_str(),
                 number_or("not at rest", "%.2f", l.theory < 0 ? std::nan("") : l.theory).c_str());
  return text;
}

std::string json_of(const SuctionTable& table, const SuctionTableConfig& config) {
  nlohmann::ordered_json json;
  json["seed"] = config.seed;
  json["draws"] = config.draws;
  json["lateral_sigma"] = config.lateral_sigma;
  json["tilt_sigma"] = config.tilt_sigma;
  json["cells"] = nlohmann::ordered_json::array();
  for (const SuctionCell& c : table.cells)
    json["cells"].push_back({{"diameter", c.diameter},
                             {"cups", c.cups},
                             {"vacuum", c.vacuum},
                             {"acceleration", c.acceleration},
                             {"sealed", c.sealed},
                             {"held", c.held},
                             {"sealed_theory", c.sealed_theory},
                             {"held_theory", c.held_theory},
                             {"same", c.same},
                             {"moment", c.moment},
                             {"moment_theory", c.moment_theory}});
  json["limits"] = nlohmann::ordered_json::array();
  for (const SuctionLimit& l : table.limits)
    json["limits"].push_back({{"diameter", l.diameter},
                              {"cups", l.cups},
                              {"vacuum", l.vacuum},
                              {"measured", l.measured},
                              {"theory", l.theory}});
  return json.dump(1) + "\n";
}

}  // namespace binpick

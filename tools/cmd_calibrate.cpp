// binpick calibrate SCENE: the camera on the flange calibrated in cells that are not as drawn; how far off it comes
// out, and which source of error is to blame.

#include <cmath>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <sstream>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/yaml.hpp"
#include "evaluation/statistics.hpp"
#include "tools/commands.hpp"
#include "tools/validate/calibration_plots.hpp"
#include "trials/calibration/calibration_trial.hpp"
#include "trials/calibration/plate_images.hpp"
#include "trials/scenario.hpp"

namespace binpick {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

struct Options {
  std::string scene, seeds = "5000:5200", json, errors, plots;
  int poses = 15;
  bool images = false;
};

struct Row {
  CalibrationMethod method = CalibrationMethod::kChain;
  std::string source;
  CalibrationSpread measured;
  std::optional<PredictedError> predicted;  ///< nothing: of images, which cannot be had without their noise
};

std::vector<Row> rows_of(const CalibrationSetup& setup, const CalibrationErrors& errors,
                         std::pair<std::uint64_t, std::uint64_t> seeds) {
  std::vector<Row> rows;
  const auto add = [&](CalibrationMethod method, const std::string& source, const CalibrationErrors& some) {
    rows.push_back({method, source,
                    calibration_spread(setup, some, method, seeds.first, static_cast<int>(seeds.second - seeds.first)),
                    predicted_error(setup, some, method)});
  };
  for (const CalibrationMethod method : kCalibrationMethods) {
    if (setup.images) {
      for (const auto& [source, some] : {std::pair{std::string("images alone"), no_errors()}, {"all", errors}})
        rows.push_back(
            {method,
             source,
             calibration_spread(setup, some, method, seeds.first, static_cast<int>(seeds.second - seeds.first)),
             {}});
      continue;
    }
    for (const ErrorSource source : kErrorSources) {
      add(method, to_string(source), only(errors, source));
    }
    add(method, "all", errors);
  }
  return rows;
}

std::string text_of(const std::vector<Row>& rows, std::uint64_t draws) {
  std::ostringstream out;
  out << "Camera on the flange, estimated against true, " << draws
      << " calibrations a row: root mean square (to first order)\n\n"
      << "| method | source of error | shift, mm | turn, deg | tip at a part, mm | its turn, deg | tip p95, mm |\n"
      << "|---|---|---|---|---|---|---|\n"
      << std::fixed << std::setprecision(3);
  const auto beside = [&](double value) {
    std::ostringstream text;
    text << std::fixed << std::setprecision(3) << " (" << value << ")";
    return text.str();
  };
  for (const Row& row : rows) {
    const auto predicted = [&](double PredictedError::*figure, double unit) {
      return row.predicted ? beside(unit * (*row.predicted).*figure) : "";
    };
    out << "| " << to_string(row.method) << " | " << row.source << " | " << 1e3 * row.measured.shift
        << predicted(&PredictedError::shift, 1e3) << " | " << row.measured.turn / kDegree
        << predicted(&PredictedError::turn, 1 / kDegree) << " | " << 1e3 * row.measured.tip
        << predicted(&PredictedError::tip, 1e3) << " | " << row.measured.tip_turn / kDegree << " | "
        << 1e3 * quantile(row.measured.tips, 0.95) << " |\n";
  }
  return out.str();
}

std::string json_of(const std::vector<Row>& rows) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  const auto number = [](const Row& row, double PredictedError::*figure) {
    return row.predicted ? nlohmann::ordered_json((*row.predicted).*figure) : nlohmann::ordered_json(nullptr);
  };
  for (const Row& row : rows)
    list.push_back({{"method", to_string(row.method)},
                    {"source", row.source},
                    {"shift_rms", row.measured.shift},
                    {"shift_predicted", number(row, &PredictedError::shift)},
                    {"shift_p95", quantile(row.measured.shifts, 0.95)},
                    {"turn_rms", row.measured.turn},
                    {"turn_predicted", number(row, &PredictedError::turn)},
                    {"tip_rms", row.measured.tip},
                    {"tip_predicted", number(row, &PredictedError::tip)},
                    {"tip_p95", quantile(row.measured.tips, 0.95)},
                    {"tip_turn_rms", row.measured.tip_turn}});
  return list.dump(1) + "\n";
}

int run(const Options& options) {
  const auto seeds = parse_seeds(options.seeds);
  if (seeds.second - seeds.first > 100000) throw SpecError("--seeds: at most 100000");
  if (!options.plots.empty()) make_folder(options.plots);
  if (!options.json.empty()) write_file(options.json, "[]\n");  // a place that cannot be written is known at once
  CalibrationErrors errors;
  if (!options.errors.empty())
    read_yaml_file(options.errors, [&](ConfigVisitor& v) {
      errors.visit(v);
      errors.validate();
    });
  const Scenario scenario = read_scenario(options.scene, {"ideal"});
  CalibrationSetup setup = calibration_setup(scenario.cell, {options.poses});
  if (options.images) setup.images = std::make_shared<const PlateImages>(setup.plate);
  const std::vector<Row> rows = rows_of(setup, errors, seeds);
  if (!options.json.empty()) write_file(options.json, json_of(rows));
  if (!options.plots.empty() && !plot_calibration(scenario.cell, errors, seeds.first,
                                                  static_cast<int>(seeds.second - seeds.first), options.plots))
    std::cerr << "note: gnuplot is not installed; the scripts in " << options.plots << " draw the curves\n";
  std::cout << text_of(rows, seeds.second - seeds.first) << std::flush;
  if (!std::cout) throw StorageError("standard output: cannot write");
  return 0;
}

}  // namespace

Action add_calibrate(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("calibrate", "camera to flange by the paper's chain and by hand-eye, and its error");
  command->add_option("scene", options->scene, "scene file (YAML) with a camera on the flange")->required();
  command->add_option("--seeds", options->seeds, "A:B, a calibration each; default 5000:5200");
  command->add_option("--poses", options->poses, "looks of the hand-eye calibration")->check(CLI::Range(3, 100));
  command->add_flag("--images", options->images,
                    "grey images are rendered and their markers found, in place of projected corners with noise");
  command->add_option("--errors", options->errors, "YAML with standard deviations in place of the defaults");
  command->add_option("--json", options->json, "file for the figures, SI");
  command->add_option("--plots", options->plots, "folder for curves over corner noise, looks and range, and by source");
  return [options] { return run(*options); };
}

}  // namespace binpick

// binpick paper: the seed paper's Tables 1 to 4 beside ours, with its settings and with our defaults, one page of
// Markdown with pictures.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <numbers>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/progress.hpp"
#include "evaluation/statistics.hpp"
#include "tools/bench/cpu_clock.hpp"
#include "tools/commands.hpp"
#include "tools/validate/plot.hpp"
#include "trials/pose_verification.hpp"
#include "trials/trial.hpp"

namespace binpick {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string seeds = "5000:5005", scenes = "scenes", json, out;
};

/// One scene file, and what of it is shown: `rounds` of picking, or poses only.
struct Setting {
  std::string name, file, calibration;
  bool rounds = true;
};

std::vector<Setting> settings_of(const std::string& folder) {
  return {{"paper's settings, its chain", folder + "/paper_bearing.yaml", "", true},
          {"our defaults", folder + "/bearing_bin.yaml", "", true},
          {"our defaults, the paper's chain", folder + "/bearing_bin.yaml", "chain", false}};
}

/// What one setting gives.
struct Outcome {
  PaperVerification verification;
  PaperRounds rounds;
};

Outcome measured(const Setting& setting, std::pair<std::uint64_t, std::uint64_t> seeds, const std::string& pictures) {
  Scenario scenario = read_scenario(setting.file);
  if (!setting.calibration.empty()) scenario.calibration.method = setting.calibration;
  TrialContext context = make_trial_context(scenario);
  Outcome outcome{{setting.name, {}}, {setting.name, {}}};
  StderrProgress progress;
  const std::size_t total = seeds.second - seeds.first;
  for (std::uint64_t seed = seeds.first; seed < seeds.second; ++seed) {
    outcome.verification.poses.push_back(verify_pose(scenario, context, Seed{seed}));
    if (setting.rounds) {
      TrialPictures shown(pictures, 1);
      const bool first = seed == seeds.first && !pictures.empty();
      outcome.rounds.records.push_back(run_trial(scenario, Seed{seed}, context, first ? &shown : nullptr));
      if (const TrialRecord& last = outcome.rounds.records.back(); !last.error.empty())
        throw std::runtime_error(setting.file + ", seed " + std::to_string(seed) + ": " + last.error);
    }
    progress.update(seed - seeds.first + 1, total, setting.name);
  }
  progress.finish();
  return outcome;
}

/// A picture of the first round of each setting, kept as images/paper_<setting>_<name>.png; a line of Markdown each.
class Pictures {
 public:
  explicit Pictures(const std::string& out) : out_(out) {
    if (out.empty()) return;
    make_folder(out + "/images");
    scratch_ = out + "/.paper_pictures";
  }
  ~Pictures() {
    std::error_code ignored;
    if (!scratch_.empty()) fs::remove_all(scratch_, ignored);
  }
  Pictures(const Pictures&) = delete;
  Pictures& operator=(const Pictures&) = delete;

  /// Where the pictures of setting `number` go; empty: nowhere.
  std::string folder(std::size_t number) const {
    return scratch_.empty() ? "" : scratch_ + "/" + std::to_string(number);
  }
  void keep(std::size_t number, const std::string& name, const std::string& caption) {
    const std::string from = folder(number) + "/00_" + name + ".png";
    if (scratch_.empty() || !fs::exists(from)) return;  // a first pick that fails lifts nothing
    const std::string image = "images/paper_" + std::to_string(number) + "_" + name + ".png";
    write_file(out_ + "/" + image, read_file(from));
    lines_ += "![" + caption + "](" + image + ")\n*" + caption + "*\n\n";
  }
  const std::string& lines() const { return lines_; }

 private:
  std::string out_, scratch_, lines_;
};

void add_bars(CurveTable& table, const std::string& curve, double shift, std::span<const Eigen::Vector3d> errors,
              double factor, double first) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Eigen::Vector3d& error : errors) values.push_back(factor * error[axis]);
    if (values.empty()) continue;
    const Interval interval = student_interval(values);
    table.add(curve, {first + static_cast<double>(axis) + shift, mean(values), std::max(0.0, interval.low),
                      std::isfinite(interval.high) ? interval.high : NAN});
  }
}

/// Mean errors per axis with their intervals, the paper's first.
void plot_errors(const PaperComparison& ours, const std::string& folder) {
  CurveTable table("curve,axis,mean,low,high");
  std::string curves;
  double shift = -0.24;
  const auto add = [&](const std::string& name, const VerifiedErrors& errors) {
    add_bars(table, name, shift, errors.xyz, 1e3, 1);
    add_bars(table, name, shift, errors.rpy, 180 / std::numbers::pi, 4);
    shift += 0.16;
    curves += (curves.empty() ? "plot" : ",") + std::string(" file using (curve(\"") + name +
              "\", 2)):3:4:5 with yerrorbars title \"" + name + "\"";
  };
  add("paper", paper_errors());
  for (const PaperVerification& verification : ours.verifications) {
    std::string name = verification.name;  // a comma would end the column
    std::replace(name.begin(), name.end(), ',', ';');
    add(name, verified_errors(verification.poses));
  }
  write_plot(folder, "paper_errors", table,
             "set title \"Absolute errors of a pose: means and their 95 % intervals\"\n"
             "set ylabel \"mm, deg\"\nset xrange [0.5:6.5]\nset yrange [0:]\nset key top right\n"
             "set xtics (\"X, mm\" 1, \"Y, mm\" 2, \"Z, mm\" 3, \"roll, deg\" 4, \"pitch, deg\" 5, \"yaw, deg\" 6)\n" +
                 curves + "\n");
}

/// How much of a core this process had: the times of Table 4 are wall times.
class CoreShare {
 public:
  /// A sentence for the page when it was not nearly a whole one.
  std::string warning() const {
    const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    const double share = cpu_.seconds() / wall;
    if (share > 0.9) return "";
    return "**The machine was busy: this run had " + std::to_string(std::lround(100 * share)) +
           " % of a core, and some of the vision times of Table 4 are too long.**\n\n";
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  CpuClock cpu_;
};

std::string page_of(const PaperComparison& ours, const Options& options, const std::string& warning,
                    const std::string& pictures) {
  return "# The paper's tables beside ours\n\n"
         "Le Duc Hanh, Khuong Thanh Gia Hieu, \"3D matching by combining CAD model and computer vision for autonomous "
         "bin picking\": ten aluminium bearings in a box, a RealSense on the flange, a Nachi arm at half speed. This "
         "page "
         "is written by\n\n    binpick paper --seeds " +
         options.seeds +
         " --out DIR\n\nA seed is a heap of ten bearings, the same for every column (the first column of a table is "
         "the "
         "paper's, five rounds). \"Paper's settings\" are `scenes/paper_bearing.yaml`: its estimator (`paper_ppf`), "
         "its "
         "calibration (5.1), a second look from 300 mm above when the fit is poor (6); \"our defaults\" are "
         "`scenes/bearing_bin.yaml`, where the calibration is perfect unless it says the chain. Camera (D435), arm, "
         "speed "
         "and tool are the same in both: three cups where the paper has one, which would peel off the ring "
         "(docs/suction.md).\n\n"
         "Tables 1 and 2 repeat the paper's verification (5.2): the tool is set on a part by hand, the arm moves away, "
         "recognises the part, and the pose it would go to is compared with the one taught, in the robot's base. Our "
         "arm "
         "is exact there; what is off is recognition and calibration.\n\n" +
         warning + paper_tables(ours) + pictures;
}

int run(const Options& options) {
  const auto seeds = parse_seeds(options.seeds);
  if (seeds.second - seeds.first > 1000) throw SpecError("--seeds: at most 1000 rounds");
  if (!options.json.empty()) write_file(options.json, "{}\n");  // a place that cannot be written is known at once
  const CoreShare core;
  Pictures pictures(options.out);
  PaperComparison ours;
  std::size_t number = 0;
  for (const Setting& setting : settings_of(options.scenes)) {
    ++number;
    Outcome outcome = measured(setting, seeds, setting.rounds ? pictures.folder(number) : "");
    ours.verifications.push_back(std::move(outcome.verification));
    if (!setting.rounds) continue;
    ours.rounds.push_back(std::move(outcome.rounds));
    pictures.keep(number, "estimates",
                  setting.name + ": estimates of the first look, seed " + std::to_string(seeds.first));
    pictures.keep(number, "lifted", setting.name + ": the first bearing on the tool");
  }
  std::string shown = pictures.lines();
  if (!options.out.empty()) {
    plot_errors(ours, options.out + "/images");
    if (draw_plots(options.out + "/images", {"paper_errors"}))
      shown = "![Tables 1 and 2 as a plot](images/paper_errors.png)\n\n" + shown;
    else
      std::cerr << "note: gnuplot is not installed; " << options.out << "/images/paper_errors.gp draws the plot\n";
  }
  const std::string page = page_of(ours, options, core.warning(), shown.empty() ? "" : "\n## Pictures\n\n" + shown);
  if (!options.json.empty()) write_file(options.json, paper_json(ours));
  if (!options.out.empty()) write_file(options.out + "/paper.md", page);
  std::cout << page << std::flush;
  if (!std::cout) throw StorageError("standard output: cannot write");
  return 0;
}

}  // namespace

Action add_paper(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("paper", "the paper's Tables 1 to 4 beside ours, one page of Markdown");
  command->add_option("--seeds", options->seeds,
                      "A:B, a round of ten bearings each; default 5000:5005, as many as its");
  command->add_option("--scenes", options->scenes, "folder of bearing_bin.yaml and paper_bearing.yaml; default scenes");
  command->add_option("--json", options->json, "file for the figures, SI");
  command->add_option("--out", options->out, "folder for paper.md and images/");
  return [options] { return run(*options); };
}

}  // namespace binpick

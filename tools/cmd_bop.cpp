// binpick bop export RUN --out DIR | score DATASET RESULTS.csv | results RUN | truth DATASET: data sets, results and
// scores of the BOP challenges (docs/bop.md).

#include <iostream>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/random.hpp"
#include "evaluation/bop_score.hpp"
#include "tools/commands.hpp"
#include "trials/dataset_export.hpp"

namespace binpick {
namespace {

struct Options {
  std::string run, dataset, csv, out, json;
  BopReadOptions read;
  BopScoreOptions score;
  bool toolkit = false, no_vsd = false, twins = false;
  double shift = 0;
  std::uint64_t seed = 0;
  std::size_t most = 1000000;
};

/// Standard output, or a file.
void deliver(const std::string& text, const std::string& file) {
  if (!file.empty()) return write_file(file, text);
  std::cout << text << std::flush;
  if (!std::cout) throw StorageError("standard output: cannot write");
}

/// 7: a replay of this very build gave other bits than the record.
int report(const ReplayedRun& run) {
  if (!run.skipped.empty())
    std::cerr << "note: " << run.skipped.size() << " trials have no heap at rest in the bin, or failed" << std::endl;
  if (!run.same_build) std::cerr << "note: the records are of another build of the program" << std::endl;
  if (run.different.empty()) return 0;
  std::cerr << (run.same_build ? "error: " : "note: ") << "the first look of " << run.different.size()
            << " trials came out otherwise than in the records, first seed " << run.different.front() << std::endl;
  return run.same_build ? 7 : 0;
}

int run_export(const Options& options) {
  StderrProgress progress;
  const ReplayedRun run = export_dataset(options.run, options.out, options.most, progress);
  std::cout << options.out << ": " << run.seeds.size() << " scenes" << std::endl;
  return report(run);
}

int run_results(const Options& options) {
  StderrProgress progress;
  std::vector<BopEstimate> estimates;
  const ReplayedRun run = estimates_of_run(options.run, options.most, progress, estimates);
  deliver(bop_results_csv(estimates), options.out);
  return report(run);
}

int run_score(Options options) {
  if (!options.json.empty()) write_file(options.json, "{}\n");  // a place that cannot be written is known at once
  if (options.toolkit) options.score.search = SymmetrySearch::kToolkit;
  options.score.with_vsd = !options.no_vsd;
  const std::vector<BopEstimate> estimates = read_bop_results(options.csv);
  const BopDataset dataset = read_bop_dataset(options.dataset, options.read);
  StderrProgress progress;
  const BopScore score = score_bop(dataset, estimates, options.score, &progress);
  std::cout << bop_score_text(score) << std::flush;
  if (!options.json.empty()) write_file(options.json, bop_score_json(score));
  return 0;
}

/// A random member of the group; any turn about an axis, any rotation of a sphere.
Pose random_member(const Symmetry& symmetry, Rng& rng) {
  Pose S = symmetry.finite[rng.below(symmetry.finite.size())];
  Pose turn = Pose::Identity();
  const auto about = [&](const Eigen::Matrix3d& R, const Eigen::Vector3d& point) {
    turn.linear() = R;
    turn.translation() = point - R * point;
  };
  if (symmetry.center_P) {
    about(rng.rotation().toRotationMatrix(), *symmetry.center_P);
  } else if (symmetry.axis) {
    about(Eigen::AngleAxisd(rng.uniform(0, 2 * M_PI), symmetry.axis->direction_P).toRotationMatrix(),
          symmetry.axis->point_P);
  }
  return S * turn;
}

/// The truth as an estimator's answer: it must score 100 %.
int run_truth(const Options& options) {
  const BopDataset dataset = read_bop_dataset(options.dataset, options.read);
  std::vector<BopEstimate> estimates;
  Rng rng = Seed{options.seed}.child("bop truth").rng();
  for (const BopImage& image : dataset.images)
    for (const BopInstance& one : image.instances) {
      Pose X_CO = one.X_CO;
      if (options.twins) X_CO = X_CO * random_member(dataset.objects.at(one.object).part.symmetry, rng);
      X_CO.translation() += options.shift * rng.unit_vector();
      estimates.push_back({image.scene, image.image, one.object, one.visible_fraction, X_CO, -1});
    }
  deliver(bop_results_csv(estimates), options.out);
  return 0;
}

void add_read_options(CLI::App& command, Options& options) {
  command.add_option("dataset", options.dataset, "folder of the data set")->required();
  command.add_option("--split", options.read.split,
                     "folder of the scenes; default: the only one that begins with test");
  command.add_option("--sensor", options.read.sensor, "of data sets with several: scene_gt_SENSOR.json and so on");
}

}  // namespace

Action add_bop(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("bop", "data sets, results and scores in the format of the BOP challenges");
  command->require_subcommand(1);
  CLI::App* write = command->add_subcommand("export", "the first looks of a run as a data set");
  write->add_option("run", options->run, "run folder")->required();
  write->add_option("--out", options->out, "folder for it: new or empty")->required();
  CLI::App* results = command->add_subcommand("results", "the run's estimates in those looks as a results file");
  results->add_option("run", options->run, "run folder")->required();
  results->add_option("--out", options->out, "file; default: standard output");
  for (CLI::App* replayed : {write, results})
    replayed->add_option("--most", options->most, "trials at most, by seed")->check(CLI::Range(1, 1000000));
  CLI::App* score = command->add_subcommand("score", "a results file against a data set, anybody's both");
  add_read_options(*score, *options);
  score->add_option("results", options->csv, "results file (CSV)")->required();
  score->add_option("--json", options->json, "file for the figures");
  score->add_flag("--toolkit-symmetries", options->toolkit,
                  "continuous symmetries at the 315 turns of the BOP toolkit instead of their exact minimum");
  score->add_flag("--no-vsd", options->no_vsd, "leave VSD out: depth images are not read");
  score->add_option("--delta", options->score.vsd.delta, "m, visibility tolerance of VSD (ITODD: 0.005)")
      ->check(CLI::Range(1e-4, 1.0));
  score->add_option("--per-image", options->score.most_per_image, "estimates that detection looks at (XYZ-IBD: 200)")
      ->check(CLI::Range(1, 100000));
  CLI::App* truth = command->add_subcommand("truth", "the truth of a data set as a results file, disturbed or not");
  add_read_options(*truth, *options);
  truth->add_option("--out", options->out, "file; default: standard output");
  truth->add_option("--shift", options->shift, "m, each pose is moved by this much in a random direction")
      ->check(CLI::Range(0.0, 10.0));
  truth->add_flag("--twins", options->twins, "each pose is turned by a random symmetry of its object");
  truth->add_option("--seed", options->seed, "of both");
  return [=] {
    if (write->parsed()) return run_export(*options);
    if (results->parsed()) return run_results(*options);
    return score->parsed() ? run_score(*options) : run_truth(*options);
  };
}

}  // namespace binpick

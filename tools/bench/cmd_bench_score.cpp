// binpick bench score: fits the weights of the score to what `bench perception --features` has written.
#include <iostream>

#include "core/error.hpp"
#include "tools/bench/bench_commands.hpp"
#include "tools/bench/perception_score_fit.hpp"

namespace binpick {

Action add_bench_score(CLI::App& bench) {
  struct Options {
    std::vector<std::string> files;
    double ridge = 1, wrong_weight = 1;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = bench.add_subcommand("score", "weights of the calibrated score, from `perception --features`");
  command->add_option("files", options->files, "files of `bench perception --features`")->required();
  command->add_option("--ridge", options->ridge, "weight of the ridge penalty")->check(CLI::Range(0.0, 1e6));
  command->add_option("--wrong-weight", options->wrong_weight, "how often a wrong pose counts")
      ->check(CLI::Range(1e-3, 1e3));
  return [options] {
    std::vector<ScoreSample> samples;
    for (const std::string& file : options->files)
      for (const ScoreSample& s : read_features(file)) samples.push_back(s);
    std::cout << fit_report(samples, options->ridge, options->wrong_weight) << std::flush;
    if (!std::cout) throw StorageError("standard output: cannot write");
    return 0;
  };
}

}  // namespace binpick

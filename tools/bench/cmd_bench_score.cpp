// binpick bench score: fits the weights of the score to what `bench perception --features` has written.
#include <iostream>

#include "core/error.hpp"
#include "tools/bench/bench_commands.hpp"
#include "tools/bench/perception_score_fit.hpp"

namespace binpick {

Action add_bench_score(CLI::App& bench) {
  struct Options {
    std::vector<std::string> files;
    double ridge = 1;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = bench.add_subcommand("score", "weights of the calibrated score, from `perception --features`");
  command->add_option("files", options->files, "files of `bench perception --features`")->required();
  command->add_option("--ridge", options->ridge, "weight of the ridge penalty")->check(CLI::Range(0.0, 1e6));
  return [options] {
    std::vector<ScoreSample> samples;
    for (const std::string& file : options->files)
      for (const ScoreSample& s : read_features(file)) samples.push_back(s);
    std::cout << fit_report(samples, options->ridge) << std::flush;
    if (!std::cout) throw StorageError("standard output: cannot write");
    return 0;
  };
}

}  // namespace binpick

// binpick verify RUN --sample N: runs records again and compares every bit. Exit code 7: one differs.

#include <iostream>

#include "tools/commands.hpp"
#include "trials/verification.hpp"

namespace binpick {
namespace {

struct Options {
  std::string run;
  std::size_t sample = 20;
};

int run(const Options& options) {
  StderrProgress progress;
  const Verification result = verify_run(options.run, options.sample, progress);
  if (!result.same_build) std::cerr << "note: the records are of another build of the program" << std::endl;
  for (const BitDifference& difference : result.differences)
    std::cout << "seed " << difference.seed << " differs first in " << describe(difference) << ": binpick trial "
              << options.run << "/scenario.yaml --seed " << difference.seed << "\n";
  std::cout << result.seeds.size() - result.differences.size() << " of " << result.seeds.size()
            << " records came out again, bit for bit" << std::endl;
  return result.differences.empty() ? 0 : 7;
}

}  // namespace

Action add_verify(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("verify", "runs a sample of a run's records again and compares every bit");
  command->add_option("run", options->run, "run folder")->required();
  command->add_option("--sample", options->sample, "how many of its records")->check(CLI::Range(1, 1000000));
  return [options] { return run(*options); };
}

}  // namespace binpick

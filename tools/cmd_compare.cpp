// binpick compare BASE NEW: two run folders (or a baseline file and a run folder) on the seeds they share
// (docs/gate.md). Exit code: 0 no bit changed or nothing worse, 1 worse, 3 inconclusive, 5 crashes, 7 bits differ where
// --bits forbids it.

#include <iostream>

#include "core/file_io.hpp"
#include "evaluation/comparison.hpp"
#include "tools/commands.hpp"
#include "tools/verdict_files.hpp"

namespace binpick {
namespace {

struct Options {
  std::string base, fresh, margins;
  VerdictFiles files;
  bool bits = false;
};

int run(const Options& options) {
  const GateRules rules = read_gate_rules(options.margins);
  const Comparison comparison = compare(read_piles(options.base), read_piles(options.fresh), rules);
  std::cout << comparison_text(comparison) << std::flush;
  write_verdict(options.files, comparison);
  if (options.bits && !comparison.differences.empty()) return 7;
  return exit_code(comparison);
}

}  // namespace

Action add_compare(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("compare", "two runs seed by seed: bits first, then paired tests");
  command->add_option("base", options->base, "run folder or baseline file")->required();
  command->add_option("new", options->fresh, "run folder or baseline file")->required();
  command->add_option("--margins", options->margins, "YAML: alpha, confidence, and per metric its margin");
  command->add_flag("--bits", options->bits, "any changed bit is a failure (exit code 7)");
  add_verdict_options(*command, options->files);
  return [options] { return run(*options); };
}

}  // namespace binpick

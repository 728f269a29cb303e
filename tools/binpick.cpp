// binpick: one program, one file per subcommand. Standard output carries the result, standard error the talk.
// Exit codes: 0 done, 1 worse than the base, 2 bad usage or input, 3 inconclusive, 5 crash, 6 storage, 7 bits differ,
// 130 interrupted.

#include <signal.h>

#include <iostream>
#include <new>
#include <vector>

#include "core/check.hpp"
#include "core/error.hpp"
#include "tools/commands.hpp"
#include "trials/environment.hpp"

namespace {

int run(int argc, char** argv) {
  using namespace binpick;
  CLI::App app("binpick: simulated bin picking, from the heap to the tray, repeatable bit for bit");
  app.require_subcommand(1);
  app.set_version_flag("--version", "binpick 0.1.0");
  std::vector<std::pair<CLI::App*, Action>> commands;
  for (Action (*add)(CLI::App&) :
       {add_trial, add_campaign, add_report,    add_compare, add_gate,     add_verify, add_view,     add_query,
        add_merge, add_sweep,    add_calibrate, add_paper,   add_estimate, add_render, add_validate, add_bench,
        add_bop,   add_budget,   add_check,     add_part,    add_list,     add_worker}) {
    Action action = add(app);
    commands.emplace_back(app.get_subcommands({}).back(), std::move(action));
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  for (const auto& [command, action] : commands)
    if (command->parsed()) return action();
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  binpick::pin_environment(argv);
  ::signal(SIGXFSZ, SIG_IGN);  // a file-size limit shows as a failed write, like a full disk
  try {
    return run(argc, argv);
  } catch (const binpick::SpecError& error) {
    std::cerr << "error: " << error.what() << std::endl;
    return 2;
  } catch (const binpick::AssetError& error) {
    std::cerr << "error: " << error.what() << std::endl;
    return 2;
  } catch (const binpick::StorageError& error) {
    std::cerr << "error: " << error.what() << std::endl;
    return 6;
  } catch (const std::bad_alloc&) {
    std::cerr << "error: out of memory" << std::endl;
    return 5;
  } catch (const std::exception& error) {
    std::cerr << "internal error: " << error.what() << std::endl;
    return 5;
  }
}

// binpick worker SCENE: what `campaign` starts; seeds in on standard input, records out on standard output.

#include <iostream>

#include "tools/commands.hpp"
#include "trials/worker.hpp"

namespace binpick {

Action add_worker(CLI::App& app) {
  auto options = std::make_shared<WorkerOptions>();
  CLI::App* command = app.add_subcommand("worker", "used by campaign: seeds in, records out");
  command->group("");  // not for people
  command->add_option("scene", options->scene, "scene file (YAML)")->required();
  add_sensor_option(*command, options->overrides.sensor);
  command->add_option("--artifacts", options->artifacts, "folder for pictures");
  command->add_option("--pictured", options->pictured, "looks pictured per trial");
  return [options] {
    run_worker(*options, std::cin, std::cout);
    return 0;
  };
}

}  // namespace binpick

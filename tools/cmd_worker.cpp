// binpick worker SCENE: what `campaign` starts; seeds in on standard input, records out on standard output.

#include <unistd.h>

#include <iostream>
#include <new>

#include "tools/commands.hpp"
#include "trials/campaign_worker.hpp"
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
  command->add_option("--plant", options->plant, "faults planted on purpose");
  return [options] {
    std::set_new_handler([] { ::_exit(kOutOfMemoryExit); });  // the campaign asks why; there is no memory to say it
    run_worker(*options, std::cin, std::cout);
    return 0;
  };
}

}  // namespace binpick

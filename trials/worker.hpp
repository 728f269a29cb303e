// One worker process: seeds come in on standard input, one a line ("5003", or "5003 2": the second attempt); records go
// out on standard output, one a line. The first line out says that the scene is loaded:
// {"ready":true,"scenario_hash":..,"renderer":..}.
#pragma once

#include <iosfwd>
#include <string>

#include "trials/scenario.hpp"

namespace binpick {

struct WorkerOptions {
  std::string scene;
  ScenarioOverrides overrides;
  std::string artifacts;  ///< folder of pictures, empty: none
  int pictured = 0;       ///< looks of every trial that are pictured; failed picks always are when `artifacts` is set
  std::string plant;      ///< faults planted on purpose (planted_fault.hpp); empty: none
};

void run_worker(const WorkerOptions& options, std::istream& orders, std::ostream& records);

}  // namespace binpick

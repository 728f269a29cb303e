// What the errors of pairs of poses cost: processor time of one thread.
#pragma once

#include <string>
#include <vector>

namespace binpick {

struct MetricsRow {
  std::string name;
  std::size_t pairs = 0;
  double seconds = 0;  ///< CPU
  double limit = 0;    ///< s, what issue 10 asks for; 0: nothing
};

/// `pairs` estimates near their truths on models of 1,000 vertices, then VSD and CUS of `drawn` estimates in one image
/// of 848 x 480.
std::vector<MetricsRow> bench_metrics(std::size_t pairs, std::size_t drawn);

}  // namespace binpick

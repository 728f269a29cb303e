// A scene of a few parts, for tests of the bench.
#pragma once

#include <string>

namespace binpick {

inline std::string scene_text(int count, const std::string& part = "tee") {
  const std::string root = BINPICK_SOURCE_DIR;
  return "name: few_parts\npart: " + root + "/assets/parts/" + part + "/part.yaml\ncount: " + std::to_string(count) +
         "\ncell: " + root + "/assets/cells/mz07_one_cup.yaml\nestimator: {type: oracle}\n";
}

}  // namespace binpick

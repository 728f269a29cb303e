#include "trials/environment.hpp"

#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/core/version.hpp>
#include <thread>

#include "core/file_io.hpp"
#include "core/hash.hpp"

namespace binpick {
namespace {

struct Pin {
  const char* name;
  const char* value;
};

constexpr Pin kPins[] = {
    {"GLIBC_TUNABLES", "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2"},  // libm then has one variant of sin, cos, exp, pow, atan2
    {"GALLIUM_OVERRIDE_CPU_CAPS", "avx"},                     // the renderer's shader code: the same on every processor
    {"LP_NUM_THREADS", "1"},                                  // one core a worker
    {"OMP_NUM_THREADS", "1"},
};

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  return "unknown";
}

}  // namespace

std::string build_id() {
  static const std::string id = [] {
    const std::string program = read_file("/proc/self/exe");
    return hex(Hasher().bytes(program.data(), program.size()).value());
  }();
  return id;
}

std::string environment_json(const std::string& renderer) {
  nlohmann::ordered_json json;
  json["schema"] = 1;
  json["binpick"] = "0.1.0";
  json["build"] = build_id();
  json["compiler"] = __VERSION__;
  json["opencv"] = CV_VERSION;
  json["renderer"] = renderer;
  json["processor"] = processor();
  json["cores"] = std::thread::hardware_concurrency();
  for (const Pin& pin : kPins) json["pinned"][pin.name] = pin.value;
  return json.dump(2) + "\n";
}

void pin_environment(char** argv) {
  bool pinned = true;
  for (const Pin& pin : kPins) {
    const char* now = std::getenv(pin.name);
    if (now && std::strcmp(now, pin.value) == 0) continue;
    pinned = false;
    ::setenv(pin.name, pin.value, 1);
  }
  if (!pinned) ::execv("/proc/self/exe", argv);
}

}  // namespace binpick

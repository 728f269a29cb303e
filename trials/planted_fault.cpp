#include "trials/planted_fault.hpp"

#include <signal.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <iostream>
#include <memory>
#include <sstream>
#include <vector>

#include "core/error.hpp"

namespace binpick {
namespace {

constexpr std::size_t kBlock = 16'000'000;  // bytes

constexpr int kDrip = 15;  // blocks

void leak_block() {
  static std::vector<std::unique_ptr<char[]>> lost;
  lost.push_back(std::make_unique<char[]>(kBlock));
  std::memset(lost.back().get(), 1, kBlock);
}

void commit(const std::string& kind) {
  if (kind == "segfault") {
    ::raise(SIGSEGV);
  } else if (kind == "abort") {
    std::abort();
  } else if (kind == "hang") {
    for (;;) ::pause();
  } else if (kind == "leak") {
    for (;;) leak_block();
  } else if (kind == "drip") {
    for (int i = 0; i < kDrip; ++i) leak_block();
  } else if (kind == "exit") {
    ::_exit(0);
  } else if (kind == "garbage") {
    std::cout << "{\"no\": record" << std::endl;
  } else {
    throw SpecError("--plant: '" + kind + "' is no fault that can be planted");
  }
}

}  // namespace

void commit_planted_fault(const std::string& plan, std::uint64_t seed, int attempt) {
  std::istringstream items(plan);
  for (std::string item; std::getline(items, item, ',');) {
    const std::size_t colon = item.find(':');
    if (colon == std::string::npos || item.substr(colon + 1) != std::to_string(seed)) continue;
    std::string kind = item.substr(0, colon);
    const bool once = kind.rfind("once-", 0) == 0;
    if (once) kind = kind.substr(5);
    if (!once || attempt == 1) commit(kind);
  }
}

}  // namespace binpick

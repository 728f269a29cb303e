#include "core/progress.hpp"

#include <unistd.h>

#include <chrono>
#include <cstdio>

namespace binpick {
namespace {

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

std::string remaining(double elapsed, std::size_t done, std::size_t total) {
  if (done == 0) return "?";
  const int seconds = static_cast<int>(elapsed / static_cast<double>(done) * static_cast<double>(total - done) + 0.5);
  char text[32];
  std::snprintf(text, sizeof text, "%d:%02d", seconds / 60, seconds % 60);
  return text;
}

}  // namespace

StderrProgress::StderrProgress() : terminal_(::isatty(STDERR_FILENO) == 1), start_(now()) {}

void StderrProgress::update(std::size_t done, std::size_t total, const std::string& note) {
  if (total == 0) return;
  const std::size_t tenth = done * 10 / total;
  if (!terminal_ && tenth == last_tenth_) return;
  last_tenth_ = tenth;
  const std::string left = remaining(now() - start_, done, total);
  if (terminal_) {
    const std::size_t filled = done * 30 / total;
    const std::string bar = std::string(filled, '#') + std::string(30 - filled, '.');
    std::fprintf(stderr, "\r[%s] %zu/%zu  %s left  %s\033[K", bar.c_str(), done, total, left.c_str(), note.c_str());
  } else {
    std::fprintf(stderr, "%zu/%zu trials, %s left  %s\n", done, total, left.c_str(), note.c_str());
  }
  std::fflush(stderr);
}

void StderrProgress::finish() {
  if (terminal_) std::fprintf(stderr, "\n");
}

}  // namespace binpick

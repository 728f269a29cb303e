// Progress of long work: a bar with the remaining time on a terminal, one line per tenth otherwise. On stderr: standard
// output carries only results.
#pragma once

#include <cstddef>
#include <string>

namespace binpick {

class ProgressSink {
 public:
  virtual ~ProgressSink() = default;
  /// `note` is a short text beside the count, e.g. a running success rate.
  virtual void update(std::size_t done, std::size_t total, const std::string& note) = 0;
  virtual void finish() {}
};

/// A bar when stderr is a terminal, a line per tenth otherwise.
class StderrProgress : public ProgressSink {
 public:
  StderrProgress();
  void update(std::size_t done, std::size_t total, const std::string& note) override;
  void finish() override;

 private:
  bool terminal_;
  double start_;
  std::size_t last_tenth_ = 0;
};

}  // namespace binpick

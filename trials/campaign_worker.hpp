// Private to trials: one worker of a campaign, with what it is working on, and the guard that watches over it. However
// it ends, the end has a class: told (bad scene, full disk), or a failure of the trial that it held.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/trial_failure.hpp"
#include "trials/process.hpp"

namespace binpick {

inline constexpr int kOutOfMemoryExit = 12;  ///< of a worker whose memory limit was reached

struct WorkerLimits {
  double timeout = 900;        ///< s of wall time for one trial; ten times that for loading the scene
  double memory = 4096 * 1e6;  ///< bytes of data
  int trials = 500;            ///< after which a worker is replaced: what leaks slowly goes with it
};

struct TrialJob {
  std::uint64_t seed = 0;
  int attempt = 1;
  std::string first_failure;  ///< how the first attempt ended
};

class CampaignWorker {
 public:
  CampaignWorker(const std::vector<std::string>& arguments, const WorkerLimits& limits);

  int output() const { return process_.output(); }
  /// Takes what has arrived; false: it has ended.
  bool receive() { return process_.receive(); }
  std::optional<std::string> next_line() { return garbled_ ? std::nullopt : process_.next_line(); }

  bool ready() const { return ready_; }
  void set_ready() { ready_ = true; }
  const std::optional<TrialJob>& job() const { return job_; }
  /// What it was started for: the second attempt at a trial.
  std::optional<TrialJob> reserved;
  void give(const TrialJob& job);
  TrialJob take_job();  ///< it has answered
  /// Nothing more for it: it ends once it is idle.
  void retire() { process_.close_input(); }
  bool worn_out() const;  ///< by trials or by memory

  /// Ends it when its time or its memory is up.
  void watch();
  /// What it answers is no record.
  void reject();

  struct End {
    int code = 0;  ///< exit code, or 128 + signal
    TrialFailure failure = TrialFailure::kCrash;
    std::string text;
  };
  End wait();

 private:
  double held_for() const;

  WorkerLimits limits_;
  ChildProcess process_;
  bool ready_ = false, late_ = false, large_ = false, garbled_ = false;
  int trials_ = 0;
  std::optional<TrialJob> job_;
  std::chrono::steady_clock::time_point since_ = std::chrono::steady_clock::now();
};

}  // namespace binpick

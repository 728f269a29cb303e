#include "trials/campaign_worker.hpp"

#include <signal.h>

#include <cstring>

#include "core/quantity.hpp"

namespace binpick {
namespace {

constexpr double kWornOut = 0.5;    // of the memory limit, held between two trials
constexpr double kLoading = 10;     // times the time of a trial: what a first start may take, with nothing in the cache
constexpr double kNearLimit = 0.8;  // of it, at which a death is one of memory whatever it says of itself

}  // namespace

CampaignWorker::CampaignWorker(const std::vector<std::string>& arguments, const WorkerLimits& limits)
    : limits_(limits), process_(arguments, limits.memory) {}

void CampaignWorker::give(const TrialJob& job) {
  job_ = job;
  since_ = std::chrono::steady_clock::now();
  process_.send(std::to_string(job.seed) + " " + std::to_string(job.attempt) + "\n");
}

TrialJob CampaignWorker::take_job() {
  const TrialJob job = job_.value();
  job_.reset();
  ++trials_;
  return job;
}

bool CampaignWorker::worn_out() const {
  return trials_ >= limits_.trials || (trials_ > 0 && process_.resident_bytes() > kWornOut * limits_.memory);
}

double CampaignWorker::held_for() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - since_).count();
}

// Wall time decides here what is ended, never what a trial says: a trial that was ended is no measurement.
void CampaignWorker::watch() {
  if (!job_ && ready_) return;
  late_ = late_ || held_for() > limits_.timeout * (ready_ ? 1 : kLoading);
  large_ = large_ || process_.resident_bytes() > limits_.memory;
  if (late_ || large_) process_.kill();
}

void CampaignWorker::reject() {
  garbled_ = true;
  process_.kill();
}

CampaignWorker::End CampaignWorker::wait() {
  End end;
  end.code = process_.wait();
  const bool full = large_ || end.code == kOutOfMemoryExit ||
                    (end.code >= 128 && process_.peak_bytes() > kNearLimit * limits_.memory);
  if (late_) {
    end.failure = TrialFailure::kTimeout;
    end.text = "no answer within " + format_double(limits_.timeout) + " s";
  } else if (full) {
    end.failure = TrialFailure::kOutOfMemory;
    end.text = "more than " + format_double(limits_.memory / 1e6) + " MB of memory";
  } else if (garbled_) {
    end.text = "the worker answered what is no record";
  } else if (end.code >= 128) {
    end.text = "the worker died of signal " + std::to_string(end.code - 128) + " (" + ::strsignal(end.code - 128) + ")";
  } else {
    end.text = "the worker ended with exit code " + std::to_string(end.code) + " and no answer";
  }
  return end;
}

}  // namespace binpick

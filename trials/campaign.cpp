#include "trials/campaign.hpp"

#include <poll.h>
#include <signal.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <deque>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/log.hpp"
#include "trials/campaign_worker.hpp"
#include "trials/environment.hpp"
#include "trials/run_merge.hpp"
#include "trials/run_report.hpp"
#include "trials/run_store.hpp"
#include "trials/scenario.hpp"

namespace binpick {
namespace {

std::atomic<int> interrupts{0};
void on_interrupt(int) { ++interrupts; }

// SIGINT and SIGTERM finish what is in flight; a second one falls through to the default and ends the program.
class InterruptGuard {
 public:
  InterruptGuard() {
    interrupts = 0;
    struct sigaction action {};
    action.sa_handler = on_interrupt;
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    ::sigaction(SIGINT, &action, &before_int_);
    ::sigaction(SIGTERM, &action, &before_term_);
    ::signal(SIGPIPE, SIG_IGN);  // a dead worker shows as a failed write
  }
  ~InterruptGuard() {
    ::sigaction(SIGINT, &before_int_, nullptr);
    ::sigaction(SIGTERM, &before_term_, nullptr);
  }

 private:
  struct sigaction before_int_ {
  }, before_term_{};
};

constexpr int kStarts = 3;  // of workers that died before they were ready, in a row: then the campaign gives up

class Coordinator {
 public:
  Coordinator(const CampaignOptions& options, const std::string& program, ProgressSink& progress)
      : options_(options),
        program_(program),
        progress_(progress),
        scenario_(read_scenario(options.scene, options.overrides)),
        hash_(scenario_hash(scenario_)),
        store_(options.out, hash_, build_id()) {}

  CampaignResult run() {
    const std::set<std::uint64_t> done = store_.recorded();
    for (std::uint64_t seed = options_.first_seed; seed < options_.end_seed; ++seed)
      if (!done.count(seed) && in_shard(seed, options_.shard, options_.shards)) pending_.push_back({seed, 1, ""});
    if (options_.shuffle != 0) shuffle();
    total_ = pending_.size();
    const auto start = std::chrono::steady_clock::now();
    if (!pending_.empty()) work();
    if (result_.worker_exit != 0) return result_;
    progress_.finish();
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    result_.wall = wall.count();
    result_.summary = write_reports(options_.out, wall.count());
    result_.interrupted = interrupts > 0;
    return result_;
  }

 private:
  void shuffle() {
    const auto rank = [&](const TrialJob& job) { return Seed{options_.shuffle}.child("order", job.seed).key; };
    std::sort(pending_.begin(), pending_.end(),
              [&](const TrialJob& a, const TrialJob& b) { return rank(a) < rank(b); });
  }

  using Slot = std::unique_ptr<CampaignWorker>;

  Slot started() const {
    std::vector<std::string> arguments = {program_, "worker", options_.scene};
    const auto add = [&](const std::string& key, const std::string& value) {
      arguments.insert(arguments.end(), {key, value});
    };
    if (!options_.overrides.sensor.empty()) add("--sensor", options_.overrides.sensor);
    if (options_.pictured >= 0) {
      add("--artifacts", options_.out + "/artifacts");
      add("--pictured", std::to_string(options_.pictured));
    }
    if (!options_.plant.empty()) add("--plant", options_.plant);
    return std::make_unique<CampaignWorker>(arguments, options_.limits);
  }

  void work() {
    const InterruptGuard guard;
    slots_.resize(std::min<std::size_t>(static_cast<std::size_t>(options_.workers), pending_.size()));
    slots_[0] = started();  // the others follow when it has loaded the scene, so that a bad asset is told once
    while (result_.worker_exit == 0) {
      std::vector<pollfd> watched;
      std::vector<Slot*> owners;
      for (Slot& slot : slots_)
        if (slot) {
          slot->watch();
          watched.push_back({slot->output(), POLLIN, 0});
          owners.push_back(&slot);
        }
      if (watched.empty()) break;
      if (::poll(watched.data(), watched.size(), 200) < 0 && errno != EINTR) throw StorageError("poll failed");
      for (std::size_t i = 0; i < watched.size(); ++i)
        if (watched[i].revents != 0) serve(*owners[i]);
      if (folder_made_ && !all_started_) {
        for (std::size_t i = 1; i < slots_.size(); ++i) slots_[i] = started();
        all_started_ = true;
      }
    }
  }

  void serve(Slot& slot) {
    const bool open = slot->receive();
    while (const std::optional<std::string> line = slot->next_line()) {
      if (!slot->ready())
        take_ready(*slot, *line);
      else if (!take_record(*slot, *line))
        return slot->reject();
      feed(*slot);
    }
    if (!open) bury(slot);
  }

  void take_ready(CampaignWorker& worker, const std::string& line) {
    worker.set_ready();
    failed_starts_ = 0;
    if (folder_made_) return;
    folder_made_ = true;
    store_.begin();
    write_file(options_.out + "/scenario.yaml", expanded_yaml(scenario_, options_.out));
    write_file(options_.out + "/environment.json", environment_json(nlohmann::json::parse(line).value("renderer", "")));
  }

  /// False: that is no record of what was asked for.
  bool take_record(CampaignWorker& worker, const std::string& line) {
    if (!worker.job()) return false;
    TrialRecord record;
    try {
      record = trial_record_from_json(line, "worker");
    } catch (const SpecError&) {
      return false;
    }
    if (record.seed.key != worker.job()->seed || record.scenario_hash != hash_) return false;
    const TrialJob job = worker.take_job();
    record.attempts = job.attempt;
    record.first_failure = job.first_failure;
    keep(record);
    return true;
  }

  void keep(const TrialRecord& record) {
    store_.append(record);
    ++done_;
    result_.trial_wall += record.wall_total;
    for (const PickRecord& pick : record.picks) {
      ++attempted_;
      succeeded_ += pick.outcome == PickOutcome::kSucceeded ? 1 : 0;
    }
    progress_.update(done_, total_, std::to_string(succeeded_) + "/" + std::to_string(attempted_) + " picks");
  }

  void feed(CampaignWorker& worker) {
    if (worker.job()) return;
    if (worker.reserved && interrupts == 0) return worker.give(*std::exchange(worker.reserved, std::nullopt));
    if (pending_.empty() || interrupts > 0 || worker.worn_out()) return worker.retire();
    worker.give(pending_.front());
    pending_.pop_front();
  }

  // The worker ended: as told, because the scene or the disk is bad, or over a trial, which a fresh worker repeats
  // once.
  void bury(Slot& slot) {
    const CampaignWorker::End end = slot->wait();
    const bool was_ready = slot->ready();
    const std::optional<TrialJob> job = slot->job();
    std::optional<TrialJob> again = slot->reserved;
    slot.reset();
    if (end.code == 2 || end.code == 6) {  // it has said why
      result_.worker_exit = end.code;
      return;
    }
    if (!was_ready && ++failed_starts_ >= kStarts) {
      log_line(LogLevel::kError, options_.scene + ": no worker comes up: " + end.text);
      result_.worker_exit = 5;
      return;
    }
    if (job && job->attempt == 1) again = TrialJob{job->seed, 2, to_string(end.failure) + ": " + end.text};
    if (job && job->attempt > 1) give_up(*job, end);
    if (interrupts > 0 || (pending_.empty() && !again)) return;
    slot = started();
    slot->reserved = again;
  }

  void give_up(const TrialJob& job, const CampaignWorker::End& end) {
    TrialRecord record;
    record.scenario = scenario_.name;
    record.scenario_hash = hash_;
    record.seed = Seed{job.seed};
    record.failure = end.failure;
    record.error = end.text;
    record.build = build_id();
    record.attempts = job.attempt;
    record.first_failure = job.first_failure;
    keep(record);
  }

  CampaignOptions options_;
  std::string program_;
  ProgressSink& progress_;
  Scenario scenario_;
  std::string hash_;
  RunStore store_;
  std::vector<Slot> slots_;
  std::deque<TrialJob> pending_;
  std::size_t total_ = 0, done_ = 0, attempted_ = 0, succeeded_ = 0;
  int failed_starts_ = 0;
  bool folder_made_ = false, all_started_ = false;
  CampaignResult result_;
};

}  // namespace

CampaignSummary write_reports(const std::string& run_folder, double wall_seconds) {
  return write_reports(run_folder, wall_seconds, ReportOptions());
}

CampaignResult run_campaign(const CampaignOptions& options, const std::string& program, ProgressSink& progress) {
  return Coordinator(options, program, progress).run();
}

}  // namespace binpick

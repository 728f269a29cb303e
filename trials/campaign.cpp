#include "trials/campaign.hpp"

#include <poll.h>
#include <signal.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <deque>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "evaluation/report.hpp"
#include "trials/environment.hpp"
#include "trials/process.hpp"
#include "trials/scenario.hpp"

namespace binpick {
namespace {

std::atomic<int> interrupts{0};
void on_interrupt(int) { ++interrupts; }

// SIGINT finishes what is in flight; a second one falls through to the default and ends the program.
class InterruptGuard {
 public:
  InterruptGuard() {
    interrupts = 0;
    struct sigaction action {};
    action.sa_handler = on_interrupt;
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    ::sigaction(SIGINT, &action, &before_);
    ::signal(SIGPIPE, SIG_IGN);  // a dead worker shows as a failed write
  }
  ~InterruptGuard() { ::sigaction(SIGINT, &before_, nullptr); }

 private:
  struct sigaction before_ {};
};

struct Worker {
  std::unique_ptr<ChildProcess> process;
  std::optional<std::uint64_t> seed;  // in flight
  bool ready = false;
};

class Coordinator {
 public:
  Coordinator(const CampaignOptions& options, const std::string& program, ProgressSink& progress)
      : options_(options), program_(program), progress_(progress) {}

  CampaignResult run() {
    const Scenario scenario = read_scenario(options_.scene, options_.overrides);
    hash_ = scenario_hash(scenario);
    name_ = scenario.name;
    load_existing();
    total_ = pending_.size();
    const auto start = std::chrono::steady_clock::now();
    if (!pending_.empty()) work(scenario);
    if (result_.worker_exit != 0) return result_;
    progress_.finish();
    sort_records();
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    result_.summary = write_reports(options_.out, wall.count());
    result_.interrupted = interrupts > 0;
    return result_;
  }

 private:
  std::string records_path() const { return options_.out + "/records/records.jsonl"; }

  void load_existing() {
    std::set<std::uint64_t> done;
    if (std::filesystem::exists(options_.out + "/records"))
      for (const TrialRecord& record : read_records(options_.out)) {
        if (record.scenario_hash != hash_)
          throw SpecError(options_.out + ": holds records of another scenario (" + record.scenario_hash + ", not " +
                          hash_ + "): choose another --out");
        done.insert(record.seed.key);
      }
    for (std::uint64_t seed = options_.first_seed; seed < options_.end_seed; ++seed)
      if (!done.count(seed)) pending_.push_back(seed);
  }

  void start(Worker& worker) {
    std::vector<std::string> arguments = {program_, "worker", options_.scene};
    if (!options_.overrides.sensor.empty()) arguments.insert(arguments.end(), {"--sensor", options_.overrides.sensor});
    if (options_.pictured >= 0)
      arguments.insert(arguments.end(),
                       {"--artifacts", options_.out + "/artifacts", "--pictured", std::to_string(options_.pictured)});
    worker = Worker{std::make_unique<ChildProcess>(arguments), std::nullopt, false};
  }

  void work(const Scenario& scenario) {
    const InterruptGuard guard;
    std::vector<Worker> workers(std::min<std::size_t>(static_cast<std::size_t>(options_.workers), pending_.size()));
    start(workers[0]);  // the others follow when it has loaded the scene, so that a bad asset is told once
    while (result_.worker_exit == 0) {
      std::vector<pollfd> watched;
      std::vector<Worker*> owners;
      for (Worker& worker : workers)
        if (worker.process) {
          watched.push_back({worker.process->output(), POLLIN, 0});
          owners.push_back(&worker);
        }
      if (watched.empty()) break;
      if (::poll(watched.data(), watched.size(), 500) < 0 && errno != EINTR) throw StorageError("poll failed");
      for (std::size_t i = 0; i < watched.size(); ++i)
        if (watched[i].revents != 0) serve(*owners[i], scenario);
      if (folder_made_ && !all_started_) {
        for (std::size_t i = 1; i < workers.size(); ++i) start(workers[i]);
        all_started_ = true;
      }
    }
  }

  void serve(Worker& worker, const Scenario& scenario) {
    const bool open = worker.process->receive();
    while (const std::optional<std::string> line = worker.process->next_line()) {
      worker.ready ? take_record(worker, *line) : take_ready(worker, *line, scenario);
      feed(worker);
    }
    if (!open) bury(worker);
  }

  void take_ready(Worker& worker, const std::string& line, const Scenario& scenario) {
    worker.ready = true;
    if (folder_made_) return;
    folder_made_ = true;
    make_folder(options_.out + "/records");
    write_file(options_.out + "/scenario.yaml", expanded_yaml(scenario, options_.out));
    write_file(options_.out + "/environment.json", environment_json(nlohmann::json::parse(line).value("renderer", "")));
  }

  void take_record(Worker& worker, const std::string& line) {
    const TrialRecord record = trial_record_from_json(line, "worker");
    append_file(records_path(), line + "\n");
    worker.seed.reset();
    count(record);
  }

  void count(const TrialRecord& record) {
    ++done_;
    for (const PickRecord& pick : record.picks) {
      ++attempted_;
      succeeded_ += pick.outcome == PickOutcome::kSucceeded ? 1 : 0;
    }
    progress_.update(done_, total_, std::to_string(succeeded_) + "/" + std::to_string(attempted_) + " picks");
  }

  void feed(Worker& worker) {
    if (worker.seed) return;
    if (pending_.empty() || interrupts > 0) {
      worker.process->close_input();
      return;
    }
    worker.seed = pending_.front();
    pending_.pop_front();
    worker.process->send(std::to_string(*worker.seed) + "\n");
  }

  // The worker ended: as told, because the scene or the disk is bad, or by a crash, which costs one trial.
  void bury(Worker& worker) {
    const int code = worker.process->wait();
    const bool was_ready = worker.ready;
    const std::optional<std::uint64_t> seed = worker.seed;
    worker.process.reset();
    if (code == 2 || code == 6 || !was_ready) {
      result_.worker_exit = code == 0 ? 5 : code == 2 || code == 6 ? code : 5;
      return;
    }
    if (!seed) return;
    ++result_.crashed;
    TrialRecord record;
    record.scenario = name_;
    record.scenario_hash = hash_;
    record.seed = Seed{*seed};
    record.error = code >= 128 ? "the worker died of signal " + std::to_string(code - 128)
                               : "the worker ended with exit code " + std::to_string(code);
    record.picks.emplace_back().outcome = PickOutcome::kInternalError;
    record.picks.back().reason = record.error;
    append_file(records_path(), to_json_line(record) + "\n");
    count(record);
    if (!pending_.empty() && interrupts == 0) start(worker);
  }

  // Sorted by seed, so that the folder's bytes do not tell in which order workers finished (wall times aside).
  void sort_records() {
    if (!std::filesystem::exists(records_path())) return;
    std::string text;
    for (const TrialRecord& record : read_records(options_.out)) text += to_json_line(record) + "\n";
    write_file(records_path(), text);
  }

  CampaignOptions options_;
  std::string program_, hash_, name_;
  ProgressSink& progress_;
  std::deque<std::uint64_t> pending_;
  std::size_t total_ = 0, done_ = 0, attempted_ = 0, succeeded_ = 0;
  bool folder_made_ = false, all_started_ = false;
  CampaignResult result_;
};

std::vector<std::string> picture_paths(const std::string& run_folder) {
  std::vector<std::string> paths;
  const std::filesystem::path artifacts = std::filesystem::path(run_folder) / "artifacts";
  if (!std::filesystem::exists(artifacts)) return paths;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(artifacts))
    if (entry.path().extension() == ".png") paths.push_back(entry.path().lexically_relative(run_folder).string());
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace

CampaignSummary write_reports(const std::string& run_folder, double wall_seconds) {
  const std::vector<TrialRecord> records = read_records(run_folder);
  const CampaignSummary summary = summarise(records, wall_seconds);
  write_file(run_folder + "/summary.json", summary_json(summary) + "\n");
  write_file(run_folder + "/results.md", markdown_report(summary));
  write_file(run_folder + "/picks.csv", picks_csv(records));
  write_file(run_folder + "/report.html", html_report(summary, records, picture_paths(run_folder)));
  return summary;
}

CampaignResult run_campaign(const CampaignOptions& options, const std::string& program, ProgressSink& progress) {
  return Coordinator(options, program, progress).run();
}

}  // namespace binpick

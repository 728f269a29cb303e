#include "trials/run_report.hpp"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/hash.hpp"
#include "evaluation/report.hpp"
#include "evaluation/report_tables.hpp"
#include "trials/replay_files.hpp"
#include "trials/run_store.hpp"
#include "trials/trial.hpp"

namespace binpick {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> picture_paths(const std::string& run_folder) {
  std::vector<std::string> paths;
  const fs::path artifacts = fs::path(run_folder) / "artifacts";
  if (!fs::exists(artifacts)) return paths;
  for (const auto& entry : fs::recursive_directory_iterator(artifacts))
    if (entry.path().extension() == ".png") paths.push_back(entry.path().lexically_relative(run_folder).string());
  std::sort(paths.begin(), paths.end());
  return paths;
}

/// The first heap, and the estimates over it.
void add_opening(const std::string& run_folder, PageSources& sources) {
  const auto first = [&](const std::string& ending) -> const std::string* {
    const auto found = std::find_if(sources.picture_paths.begin(), sources.picture_paths.end(),
                                    [&](const std::string& path) { return path.ends_with(ending); });
    return found == sources.picture_paths.end() ? nullptr : &*found;
  };
  const std::string *heap = first("00_heap.png"), *estimates = first("00_estimates.png");
  if (!heap || !estimates) return;
  sources.opening = {{"the heap: " + *heap, read_file(run_folder + "/" + *heap)},
                     {"estimates over the camera's view: " + *estimates, read_file(run_folder + "/" + *estimates)}};
}

void add_environment(const std::string& run_folder, PageSources& sources) {
  const std::string path = run_folder + "/environment.json";
  if (!fs::exists(path)) return;
  const auto json = nlohmann::ordered_json::parse(read_file(path, 1 << 20), nullptr, false);
  if (!json.is_object()) return;
  for (const auto& [key, value] : json.items())
    sources.provenance.emplace_back(key, value.is_string() ? value.get<std::string>() : value.dump());
  sources.provenance.emplace_back("once more", "binpick verify . --sample 20");
}

int failed_picks(const TrialRecord& record) {
  return static_cast<int>(std::count_if(record.picks.begin(), record.picks.end(), [](const PickRecord& pick) {
    return pick.outcome != PickOutcome::kSucceeded && pick.outcome != PickOutcome::kBinEmpty;
  }));
}

/// Those with the most failed picks first, then by seed; trials that are no measurement left out.
std::vector<const TrialRecord*> worth_a_replay(const std::vector<TrialRecord>& records, std::size_t most) {
  std::vector<const TrialRecord*> order;
  for (const TrialRecord& record : records)
    if (!failure_of(record)) order.push_back(&record);
  std::stable_sort(order.begin(), order.end(),
                   [](const TrialRecord* a, const TrialRecord* b) { return failed_picks(*a) > failed_picks(*b); });
  if (order.size() > most) order.resize(most);
  return order;
}

/// The kept replay of a record; null: there is none, or it is of another trial.
nlohmann::ordered_json kept_replay(const std::string& run_folder, const TrialRecord& record) {
  const std::string path = replay_path(run_folder + "/artifacts", record.seed.key);
  if (!fs::exists(path)) return nullptr;
  auto json = nlohmann::ordered_json::parse(read_file(path, 1 << 26), nullptr, false);
  const bool good = json.is_object() && json.value("schema", 0) == kReplaySchema &&
                    json.value("record_hash", "") == hex(record_hash(record)) && json.contains("looks") &&
                    json["looks"].is_array();
  return good ? json : nlohmann::ordered_json(nullptr);
}

constexpr std::size_t kCloudPoint = 8;  // characters of base64

std::size_t cloud_size(const nlohmann::ordered_json& replay) {
  std::size_t size = 0;
  for (const auto& look : replay["looks"]) size += look.value("cloud", "").size();
  return size;
}

/// Every beginning of a cloud is an even choice of it: all are cut to the same number of points.
void cut_clouds(nlohmann::ordered_json& replay, std::size_t points) {
  for (auto& look : replay["looks"]) {
    const std::string cloud = look.value("cloud", "");
    look["cloud"] = cloud.substr(0, kCloudPoint * points);
  }
}

/// As many as fit, with as many points of each look as fit.
void fit_replays(std::vector<nlohmann::ordered_json> replays, std::size_t room, PageSources& sources) {
  constexpr std::size_t kFewest = 250;
  std::size_t bare = 0, looks = 0, kept = 0;
  for (const auto& replay : replays) {
    const std::size_t size = replay.dump().size() - cloud_size(replay), count = replay["looks"].size();
    if (bare + size + (looks + count) * kFewest * kCloudPoint > room) break;
    bare += size;
    looks += count;
    ++kept;
  }
  const std::size_t points = looks == 0 ? 0 : (room - bare) / looks / kCloudPoint;
  if (kept < replays.size())
    sources.replay_note =
        std::to_string(replays.size() - kept) +
        " more replays are left out to keep the page small: " + "binpick view RUN --seed N shows any of them.";
  for (std::size_t i = 0; i < kept; ++i) {
    cut_clouds(replays[i], points);
    const std::string seed = replays[i].value("seed", "0");
    sources.replays.push_back({std::strtoull(seed.c_str(), nullptr, 10), replays[i].dump()});
  }
}

TrialRecord record_of(const std::string& run_folder, std::uint64_t seed) {
  for (TrialRecord& record : read_records(run_folder))
    if (record.seed.key == seed) return std::move(record);
  throw SpecError(run_folder + ": there is no record of seed " + std::to_string(seed));
}

Replay replay_of(const std::string& run_folder, const TrialRecord& record, const Scenario& scenario,
                 TrialContext& context) {
  ReplayRecorder recorder;
  const TrialRecord again = run_trial(scenario, record.seed, context, nullptr, &recorder);
  if (record_hash(again) != record_hash(record))
    throw SpecError(run_folder + ": seed " + std::to_string(record.seed.key) +
                    " does not come out as recorded (another build of the program?): no replay of it");
  return recorder.finish(again);
}

void keep_replays(const std::string& run_folder, const std::vector<TrialRecord>& records, ProgressSink* progress) {
  Scenario scenario = read_scenario(run_folder + "/scenario.yaml");
  TrialContext context = make_trial_context(scenario);
  std::size_t done = 0;
  for (const TrialRecord& record : records) {
    keep_replay(replay_of(run_folder, record, scenario, context), run_folder + "/artifacts");
    if (progress) progress->update(++done, records.size(), "replays");
  }
  if (progress) progress->finish();
}

void add_replays(const std::string& run_folder, const std::vector<TrialRecord>& records, const ReportOptions& options,
                 ProgressSink* progress, PageSources& sources) {
  const std::vector<const TrialRecord*> chosen = worth_a_replay(records, options.replays);
  std::vector<TrialRecord> missing;
  for (const TrialRecord* record : chosen)
    if (options.run_again && kept_replay(run_folder, *record).is_null()) missing.push_back(*record);
  if (!missing.empty()) keep_replays(run_folder, missing, progress);
  std::vector<nlohmann::ordered_json> replays;
  for (const TrialRecord* record : chosen)
    if (auto replay = kept_replay(run_folder, *record); !replay.is_null()) replays.push_back(std::move(replay));
  const std::string cell_path = replay_cell_path(run_folder + "/artifacts");
  if (replays.empty() || !fs::exists(cell_path)) return;
  const auto cell = nlohmann::ordered_json::parse(read_file(cell_path, 1 << 26), nullptr, false);
  if (!cell.is_object() || cell.value("schema", 0) != kReplaySchema) return;
  sources.cell_json = cell.dump();
  constexpr std::size_t kAround = 2'500'000;  // scripts, pictures and tables
  fit_replays(std::move(replays), options.largest - std::min(options.largest, kAround + sources.cell_json.size()),
              sources);
}

void write_tables(const std::string& run_folder, const CampaignSummary& summary,
                  const std::vector<TrialRecord>& records) {
  const std::vector<ReportTable> tables = report_tables(summary, records);
  const std::string folder = run_folder + "/tables";
  make_folder(folder);
  std::string markdown;
  for (const ReportTable& table : tables) {
    write_file(folder + "/" + table.id + ".csv", table_csv(table));
    if (!table.rows.empty()) markdown += table_markdown(table);
  }
  write_file(folder + "/tables.md", markdown);
  write_file(folder + "/tables.json", tables_json(tables) + "\n");
}

}  // namespace

Replay replay_again(const std::string& run_folder, std::uint64_t seed) {
  Scenario scenario = read_scenario(run_folder + "/scenario.yaml");
  TrialContext context = make_trial_context(scenario);
  return replay_of(run_folder, record_of(run_folder, seed), scenario, context);
}

void write_replay_page(const std::string& run_folder, std::uint64_t seed, const std::string& path) {
  const TrialRecord record = record_of(run_folder, seed);
  if (kept_replay(run_folder, record).is_null()) keep_replays(run_folder, {record}, nullptr);
  PageSources sources;
  ReportOptions options;
  add_replays(run_folder, {record}, options, nullptr, sources);
  if (sources.replays.empty()) throw AssetError(run_folder + ": seed " + std::to_string(seed) + " has no replay");
  write_file(path, html_replay(record.scenario + ", seed " + std::to_string(seed), sources));
}

CampaignSummary write_reports(const std::string& run_folder, double wall_seconds, const ReportOptions& options,
                              ProgressSink* progress) {
  const std::vector<TrialRecord> records = read_records(run_folder);
  const CampaignSummary summary = summarise(records, wall_seconds);
  write_canonical(run_folder, records);
  write_file(run_folder + "/summary.json", summary_json(summary) + "\n");
  write_file(run_folder + "/results.md", markdown_report(summary));
  write_file(run_folder + "/picks.csv", picks_csv(records));
  write_tables(run_folder, summary, records);
  PageSources sources;
  sources.picture_paths = picture_paths(run_folder);
  add_opening(run_folder, sources);
  add_environment(run_folder, sources);
  add_replays(run_folder, records, options, progress, sources);
  write_file(run_folder + "/report.html", html_report(summary, records, sources));
  return summary;
}

}  // namespace binpick

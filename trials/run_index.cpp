#include "trials/run_index.hpp"

#include <sqlite3.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/hash.hpp"
#include "evaluation/trial_record.hpp"

namespace binpick {
namespace {

constexpr const char* kTables = R"(
create table about(records_hash text);
create table trials(seed integer primary key, failure text, error text, attempts integer, dropped integer,
  placed integer, escaped integer, settled integer, settle_time_s real, penetration_p99_m real, penetration_max_m real,
  woken_motion_m real, woken_share real, hash text, build text, wall_s real);
create table picks(seed integer, turn integer, outcome text, reason text, visible integer, found integer,
  found_2mm integer, counted integer, right integer, chosen integer, lifted_body integer, sim_time_s real,
  motion_time_s real, place_error_m real, swing_rad real, peak_force_n real, hold_use real, contact_force_n real,
  contact text, collision_depth_m real, second_look text, look_time_s real, neighbours_moved integer,
  estimate_ms real, plan_ms real, primary key(seed, turn));
create table estimates(seed integer, turn integer, estimate integer, instance integer, score real, fit_rms_m real,
  right integer, ignored integer, mssd_m real, add_s_m real, translation_m real, rotation_rad real,
  primary key(seed, turn, estimate));
)";

struct Closer {
  void operator()(sqlite3* database) const { sqlite3_close(database); }
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Database = std::unique_ptr<sqlite3, Closer>;
using Statement = std::unique_ptr<sqlite3_stmt, Closer>;

Database opened(const std::string& path, int flags) {
  sqlite3* raw = nullptr;
  const int code = sqlite3_open_v2(path.c_str(), &raw, flags, nullptr);
  Database database(raw);
  if (code != SQLITE_OK) throw StorageError(path + ": " + sqlite3_errstr(code));
  return database;
}

void run(sqlite3* database, const char* text) {
  if (sqlite3_exec(database, text, nullptr, nullptr, nullptr) != SQLITE_OK)
    throw StorageError(std::string("index.sqlite: ") + sqlite3_errmsg(database));
}

/// One row after another of one table.
class Inserter {
 public:
  Inserter(sqlite3* database, const std::string& table, int columns) : database_(database) {
    std::string text = "insert into " + table + " values(?";
    for (int k = 1; k < columns; ++k) text += ",?";
    sqlite3_stmt* raw = nullptr;
    sqlite3_prepare_v2(database, (text + ")").c_str(), -1, &raw, nullptr);
    statement_.reset(raw);
  }

  template <class... Values>
  void add(const Values&... values) {
    int column = 0;
    (bind(++column, values), ...);
    if (sqlite3_step(statement_.get()) != SQLITE_DONE)
      throw StorageError(std::string("index.sqlite: ") + sqlite3_errmsg(database_));
    sqlite3_reset(statement_.get());
  }

 private:
  void bind(int column, double value) {
    std::isnan(value) ? sqlite3_bind_null(statement_.get(), column)
                      : sqlite3_bind_double(statement_.get(), column, value);
  }
  void bind(int column, const std::string& value) {
    sqlite3_bind_text(statement_.get(), column, value.c_str(), static_cast<int>(value.size()), SQLITE_TRANSIENT);
  }
  void bind(int column, int value) { sqlite3_bind_int(statement_.get(), column, value); }
  void bind(int column, bool value) { sqlite3_bind_int(statement_.get(), column, value); }
  void bind(int column, std::uint64_t value) {
    sqlite3_bind_int64(statement_.get(), column, static_cast<sqlite3_int64>(value));
  }
  template <class T>
  void bind(int column, const std::optional<T>& value) {
    value ? bind(column, *value) : static_cast<void>(sqlite3_bind_null(statement_.get(), column));
  }

  sqlite3* database_;
  Statement statement_;
};

constexpr double kToMs = 1000;

void add_picks(const TrialRecord& record, Inserter& picks, Inserter& estimates) {
  int turn = 0;
  for (const PickRecord& p : record.picks) {
    picks.add(record.seed.key, turn, to_string(p.outcome), p.reason, p.check.visible, p.check.found, p.check.found_2mm,
              p.check.counted, p.check.right, p.chosen, p.lifted_body, p.sim_time, p.motion_time, p.place_error,
              p.swing, p.peak_force, p.hold_use, p.contact_force, p.contact, p.collision_depth, p.second_look,
              p.look_time, p.neighbours_moved, kToMs * p.wall.total, kToMs * p.plan_wall);
    for (const MatchedEstimate& e : p.check.estimates)
      estimates.add(record.seed.key, turn, e.estimate, e.instance, e.score, e.fit_rms, e.right, e.ignored, e.error.mssd,
                    e.error.add_s, e.error.translation, e.error.rotation);
    ++turn;
  }
}

void fill(sqlite3* database, const std::string& run_folder, const std::string& records_hash) {
  run(database, "pragma journal_mode = off; pragma synchronous = off; begin");
  run(database, kTables);
  Inserter about(database, "about", 1), trials(database, "trials", 16), picks(database, "picks", 25),
      estimates(database, "estimates", 12);
  about.add(records_hash);
  for (const TrialRecord& r : read_records(run_folder)) {
    const std::optional<TrialFailure> failure = failure_of(r);
    trials.add(r.seed.key, failure ? std::optional(to_string(*failure)) : std::nullopt, r.error, r.attempts, r.dropped,
               r.placed, r.escaped, r.settled, r.settle_time, r.penetration_p99, r.penetration_max, r.woken_motion,
               r.woken_share, hex(record_hash(r)), r.build, r.wall_total);
    add_picks(r, picks, estimates);
  }
  run(database, "commit");
}

/// Of every byte of every file of records.
std::string hash_of_records(const std::string& run_folder) {
  std::set<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(run_folder + "/records"))
    if (entry.path().extension() == ".jsonl") files.insert(entry.path());
  Hasher hasher;
  for (const std::filesystem::path& file : files) hasher.add(read_file(file.string()));
  return hex(hasher.value());
}

bool is_of(const std::string& index, const std::string& records_hash) {
  if (!std::filesystem::exists(index)) return false;
  try {
    const Database database = opened(index, SQLITE_OPEN_READONLY);
    sqlite3_stmt* raw = nullptr;
    sqlite3_prepare_v2(database.get(), "select records_hash from about", -1, &raw, nullptr);
    const Statement statement(raw);
    return raw != nullptr && sqlite3_step(raw) == SQLITE_ROW &&
           records_hash == reinterpret_cast<const char*>(sqlite3_column_text(raw, 0));
  } catch (const StorageError&) {
    return false;  // made anew
  }
}

/// The index, made anew where it is not of these records; in memory where the folder cannot be written to.
Database index_of(const std::string& run_folder) {
  if (!std::filesystem::is_directory(run_folder + "/records"))
    throw SpecError(run_folder + ": is not a run folder: no records/ in it");
  const std::string path = run_folder + "/index.sqlite", hash = hash_of_records(run_folder);
  if (is_of(path, hash)) return opened(path, SQLITE_OPEN_READONLY);
  const std::string part = path + ".part";
  std::error_code error;
  std::filesystem::remove(part, error);
  try {
    fill(opened(part, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE).get(), run_folder, hash);
    std::filesystem::rename(part, path, error);
    if (!error) return opened(path, SQLITE_OPEN_READONLY);
  } catch (const StorageError&) {
  }
  std::filesystem::remove(part, error);
  Database memory = opened(":memory:", SQLITE_OPEN_READWRITE);
  fill(memory.get(), run_folder, hash);
  return memory;
}

QueryCell cell(sqlite3_stmt* statement, int column) {
  const int type = sqlite3_column_type(statement, column);
  if (type == SQLITE_NULL) return {};
  const auto kind = type == SQLITE_TEXT || type == SQLITE_BLOB ? QueryCell::Kind::kText : QueryCell::Kind::kNumber;
  return {kind, reinterpret_cast<const char*>(sqlite3_column_text(statement, column))};
}

}  // namespace

QueryAnswer query_run(const std::string& run_folder, const std::string& statement) {
  const Database database = index_of(run_folder);
  sqlite3_stmt* raw = nullptr;
  const char* rest = nullptr;
  const int code = sqlite3_prepare_v2(database.get(), statement.c_str(), -1, &raw, &rest);
  const Statement prepared(raw);
  if (code != SQLITE_OK) throw SpecError("query: " + std::string(sqlite3_errmsg(database.get())));
  if (!raw) throw SpecError("query: there is no statement");
  if (!sqlite3_stmt_readonly(raw)) throw SpecError("query: only statements that read are allowed");
  if (std::string(rest).find_first_not_of(" \t\n;") != std::string::npos)
    throw SpecError("query: one statement at a time");
  QueryAnswer answer;
  const int columns = sqlite3_column_count(raw);
  for (int k = 0; k < columns; ++k) answer.columns.push_back(sqlite3_column_name(raw, k));
  int step = SQLITE_ROW;
  while ((step = sqlite3_step(raw)) == SQLITE_ROW) {
    auto& row = answer.rows.emplace_back();
    for (int k = 0; k < columns; ++k) row.push_back(cell(raw, k));
  }
  if (step != SQLITE_DONE) throw SpecError("query: " + std::string(sqlite3_errmsg(database.get())));
  return answer;
}

}  // namespace binpick

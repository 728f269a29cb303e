#include "trials/run_store.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/log.hpp"

namespace binpick {
namespace {

bool is_whole(const std::string& line) {
  try {
    trial_record_from_json(line, "");
    return true;
  } catch (const SpecError&) {
    return false;
  }
}

/// Bytes up to the end of the last line that was written to its end. Only the last one can be torn: every line is on
/// the disk before the next is begun.
std::size_t whole_bytes(const std::string& text) {
  const std::size_t end = text.rfind('\n');
  if (end == std::string::npos) return 0;
  if (end + 1 < text.size()) return end + 1;
  const std::size_t before = end == 0 ? std::string::npos : text.rfind('\n', end - 1);
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  return is_whole(text.substr(begin, end - begin)) ? text.size() : begin;
}

void cut_torn_tail(const std::string& path) {
  if (!std::filesystem::exists(path)) return;
  const std::string text = read_file(path);
  const std::size_t whole = whole_bytes(text);
  if (whole == text.size()) return;
  std::error_code error;
  std::filesystem::resize_file(path, whole, error);
  if (error) throw StorageError(path + ": cannot cut its torn last line: " + error.message());
  log_line(LogLevel::kWarning, path + ": the last line was torn and is cut; its trial runs again");
}

}  // namespace

RunStore::RunStore(std::string folder, std::string scenario_hash, std::string build)
    : folder_(std::move(folder)), scenario_hash_(std::move(scenario_hash)), build_(std::move(build)) {}

RunStore::~RunStore() {
  if (lock_ >= 0) ::close(lock_);
}

// The lock goes with the process, whatever ends it.
void RunStore::lock() {
  if (lock_ >= 0) return;
  const std::string path = folder_ + "/records/lock";
  lock_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (lock_ < 0) throw StorageError(path + ": cannot open: " + std::strerror(errno));
  if (::flock(lock_, LOCK_EX | LOCK_NB) == 0) return;
  ::close(lock_);
  lock_ = -1;
  throw SpecError(folder_ + ": another campaign is at work in this folder");
}

std::set<std::uint64_t> RunStore::recorded() {
  std::set<std::uint64_t> seeds;
  if (!std::filesystem::exists(folder_ + "/records")) return seeds;
  lock();
  cut_torn_tail(records_path());
  for (const TrialRecord& record : read_records(folder_)) {
    if (record.scenario_hash != scenario_hash_)
      throw SpecError(folder_ + ": holds records of another scenario (" + record.scenario_hash + ", not " +
                      scenario_hash_ + "): choose another --out");
    if (record.build != build_)
      throw SpecError(folder_ + ": holds records of another build of the program (" +
                      (record.build.empty() ? "an older one" : record.build) + ", not " + build_ +
                      "): choose another --out");
    seeds.insert(record.seed.key);
  }
  return seeds;
}

void RunStore::begin() {
  make_folder(folder_ + "/records");
  lock();
}

void RunStore::append(const TrialRecord& record) { append_file(records_path(), to_json_line(record) + "\n"); }

void write_canonical(const std::string& folder, std::span<const TrialRecord> records) {
  std::string text;
  for (const TrialRecord& record : records) text += canonical_line(record) + "\n";
  write_file(folder + "/canonical.jsonl", text);
}

}  // namespace binpick

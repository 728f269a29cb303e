// The records of a run folder, for the one process that adds to them. The truth is `records/records.jsonl`, which only
// ever grows: a line is on the disk before its trial counts as done, each line carries a sum of its bytes, and what a
// killed writer left of a line is cut when the folder is opened again. A trial is named by scenario (with its assets
// and settings), seed and build of the program: only records of the same three are completed, anything else is refused.
#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <string>

#include "evaluation/trial_record.hpp"

namespace binpick {

class RunStore {
 public:
  RunStore(std::string folder, std::string scenario_hash, std::string build);
  ~RunStore();
  RunStore(const RunStore&) = delete;
  RunStore& operator=(const RunStore&) = delete;

  /// The seeds that are recorded; empty where there is no such folder. Throws SpecError: records of another scenario or
  /// build, a damaged line, another process at work in the folder.
  std::set<std::uint64_t> recorded();
  /// Makes the folder where it is missing and keeps others out. Throws SpecError, StorageError.
  void begin();
  /// On the disk when it returns. Throws StorageError.
  void append(const TrialRecord& record);

 private:
  std::string records_path() const { return folder_ + "/records/records.jsonl"; }
  void lock();

  std::string folder_, scenario_hash_, build_;
  int lock_ = -1;
};

/// Writes `canonical.jsonl`: the hashed part of every record, by seed. Byte-equal for the same scenario, seeds and
/// build, however often the campaign was killed and on how many workers it ran.
void write_canonical(const std::string& folder, std::span<const TrialRecord> records);

}  // namespace binpick

// The records of a run folder one after another, for whoever need not hold them all.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "evaluation/trial_record.hpp"

namespace binpick {

/// A line as it stands in its file, without the line's end.
struct RecordLine {
  std::string file;
  std::uint64_t offset = 0;  ///< bytes before it
  std::string text;
};

/// In the order of the files and of their lines. Throws SpecError, AssetError: a damaged line, a seed recorded twice.
void for_each_record(const std::string& run_folder,
                     const std::function<void(TrialRecord&& record, const RecordLine& line)>& visit);

/// The bytes of a file from `offset` on. Throws AssetError: it does not hold so many.
std::string read_bytes(const std::string& file, std::uint64_t offset, std::size_t count);

}  // namespace binpick

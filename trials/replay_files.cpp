#include "trials/replay_files.hpp"

#include <filesystem>

#include "core/error.hpp"
#include "core/file_io.hpp"

namespace binpick {

std::string replay_path(const std::string& artifacts, std::uint64_t seed) {
  return artifacts + "/seed-" + std::to_string(seed) + "/replay.json";
}

std::string replay_cell_path(const std::string& artifacts) { return artifacts + "/cell.json"; }

void keep_replay(const Replay& replay, const std::string& artifacts) {
  const std::uint64_t seed = replay.record.seed.key;
  make_folder(artifacts + "/seed-" + std::to_string(seed));
  if (!std::filesystem::exists(replay_cell_path(artifacts))) {
    // Several workers may do so at once: each under a name of its own, the same bytes, and a rename puts them there.
    const std::string own = artifacts + "/seed-" + std::to_string(seed) + "/cell.json";
    write_file(own, replay_cell_json(replay.cell));
    std::error_code error;
    std::filesystem::rename(own, replay_cell_path(artifacts), error);
    if (error) throw StorageError(replay_cell_path(artifacts) + ": cannot rename into place: " + error.message());
  }
  write_file(replay_path(artifacts, seed), replay_json(replay));
}

}  // namespace binpick

// Replays in a run folder: artifacts/cell.json (the same for all its trials) and artifacts/seed-N/replay.json.
#pragma once

#include <cstdint>
#include <string>

#include "trials/replay.hpp"

namespace binpick {

/// Paths inside an artifacts folder.
std::string replay_path(const std::string& artifacts, std::uint64_t seed);
std::string replay_cell_path(const std::string& artifacts);

/// Writes both files. Throws StorageError.
void keep_replay(const Replay& replay, const std::string& artifacts);

}  // namespace binpick

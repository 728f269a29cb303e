// Files as a whole: read with a size limit, written to a temporary name first so that nothing half-written is ever
// seen.
#pragma once

#include <cstddef>
#include <string>

namespace binpick {

/// The file's bytes. Throws AssetError: missing, not a regular file, unreadable, larger than `limit`.
std::string read_file(const std::string& path, std::size_t limit = std::size_t{1} << 30);

/// Writes to a temporary file beside `path`, then renames. Throws StorageError with the system's reason.
void write_file(const std::string& path, const std::string& bytes);

/// Appends and flushes to the disk. Throws StorageError.
void append_file(const std::string& path, const std::string& bytes);

/// Creates a folder and its parents. Throws StorageError.
void make_folder(const std::string& path);

}  // namespace binpick

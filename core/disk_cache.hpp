// Results that are dear to compute, kept on disk under a name made of everything they depend on. Only ever a shortcut:
// whatever goes wrong (no folder, full or read-only disk, an entry that is torn, cut, damaged or of something else)
// ends in "not there", so that the result is computed anew; one debug line says the first time why.
//
// The folder: environment BINPICK_CACHE (a path, or `off`), else XDG_CACHE_HOME/binpick, else HOME/.cache/binpick, else
// none. Entries are never changed, only written whole under a temporary name and renamed, so any number of processes
// may share a folder. Nothing is ever removed: `rm -r` of the folder is safe at any time.
//
//   constexpr std::uint32_t kTableVersion = 1;  // raise whenever other code gives other bytes for the same inputs
//   ByteWriter inputs;  inputs.add(mesh.vertices).add(mesh.triangles).add(spacing);
//   const CacheKey key{"pair_table", kTableVersion, content_hash(inputs.bytes())};
//   if (const auto bytes = cache.load(key)) { .. read with ByteReader; a kept table is returned }
//   .. compute ..;  cache.store(key, out.bytes());
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/content_hash.hpp"

namespace binpick {

struct CacheKey {
  std::string kind;           ///< letters, digits and underscores: the name of a sub-folder
  std::uint32_t version = 0;  ///< of the kind: of the code that makes the data and of the bytes' layout
  ContentHash content;        ///< of all inputs: meshes and every setting that decides the result
};

class DiskCache {
 public:
  /// Empty: no cache.
  explicit DiskCache(std::string folder) : folder_(std::move(folder)) {}
  /// As the environment says now. Nothing is created before the first store.
  static DiskCache from_environment();

  bool in_use() const { return !folder_.empty(); }
  const std::string& folder() const { return folder_; }

  /// The bytes as they were stored, or nothing. Never throws for what is on the disk.
  std::optional<std::string> load(const CacheKey& key) const;
  /// Is it on disk now? False is no error.
  bool store(const CacheKey& key, std::string_view bytes) const;

  /// Where an entry lies, for tests and messages.
  std::string path_of(const CacheKey& key) const;

 private:
  std::string folder_;
};

/// Of what decides the last bits of a computation besides code and inputs: compiler, C library, Eigen and its vector
/// instructions, and the results of some calls of libm (which has several variants, see docs/determinism.md). Part of
/// every entry's name.
ContentHash numeric_platform();

}  // namespace binpick

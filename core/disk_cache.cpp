#include "core/disk_cache.hpp"

#include <fcntl.h>
#include <gnu/libc-version.h>
#include <unistd.h>

#include <Eigen/Core>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <new>

#include "core/byte_stream.hpp"
#include "core/check.hpp"
#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/log.hpp"

namespace binpick {
namespace {

constexpr std::uint64_t kMagic = 0x3165686361437042ull;  // "BpCache1"
constexpr std::size_t kMostBytes = std::size_t{1} << 29;

struct Header {
  std::uint64_t magic = kMagic;
  ContentHash name;  // what the entry is of: a file under another's name is refused
  std::uint64_t size = 0;
  ContentHash checksum;
};

void tell_once(const std::string& why) {
  static std::atomic<bool> told{false};
  if (!told.exchange(true)) log_line(LogLevel::kDebug, "cache on disk: " + why);
}

ContentHash name_of(const CacheKey& key) {
  ByteWriter all;
  all.add(std::string_view(key.kind)).add(key.version).add(key.content).add(numeric_platform());
  return content_hash(all.bytes());
}

const char* environment(const char* name) {
  const char* value = std::getenv(name);
  return value && *value ? value : nullptr;
}

/// A new file beside `path`. Two machines on one file server may have equal process numbers: then the next is tried.
int open_temporary(const std::string& path, std::string& temporary) {
  static std::atomic<unsigned> count{0};
  for (int attempt = 0; attempt < 100; ++attempt) {
    temporary = path + "." + std::to_string(::getpid()) + "-" + std::to_string(count++) + ".part";
    const int fd = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    if (fd >= 0 || errno != EEXIST) return fd;
  }
  return -1;
}

/// False with errno set. Not flushed to the disk: what a power failure tears, the checksum finds.
bool write_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return true;
}

std::string header_bytes(const ContentHash& name, std::string_view bytes) {
  ByteWriter out;
  out.add(Header{kMagic, name, bytes.size(), content_hash(bytes)});
  return out.bytes();
}

}  // namespace

DiskCache DiskCache::from_environment() {
  if (const char* named = environment("BINPICK_CACHE"))
    return DiskCache(std::strcmp(named, "off") == 0 ? std::string() : std::string(named));
  const char* shared = environment("XDG_CACHE_HOME");
  if (shared && *shared == '/') return DiskCache(std::string(shared) + "/binpick");  // XDG: others are to be ignored
  const char* home = environment("HOME");
  if (home && *home == '/') return DiskCache(std::string(home) + "/.cache/binpick");
  return DiskCache(std::string());
}

std::string DiskCache::path_of(const CacheKey& key) const {
  BP_CHECK(!key.kind.empty() && key.kind.find_first_of("/.") == std::string::npos);
  return folder_ + "/" + key.kind + "/" + name_of(key).hex();
}

std::optional<std::string> DiskCache::load(const CacheKey& key) const {
  if (!in_use()) return std::nullopt;
  const std::string path = path_of(key);
  if (::access(path.c_str(), R_OK) != 0) return std::nullopt;  // the usual case, not worth an exception
  try {
    std::string bytes = read_file(path, kMostBytes);
    Header header;
    ByteReader(bytes).get(header);
    if (bytes.size() >= sizeof header) {
      const std::string_view content = std::string_view(bytes).substr(sizeof header);
      if (header.magic == kMagic && header.name == name_of(key) && header.size == content.size() &&
          header.checksum == content_hash(content))
        return bytes.erase(0, sizeof header);
    }
    tell_once(path + ": is damaged");
  } catch (const AssetError& error) {
    tell_once(error.what());
  } catch (const std::bad_alloc&) {
    tell_once(path + ": is too large for this machine's memory");
  }
  return std::nullopt;
}

bool DiskCache::store(const CacheKey& key, std::string_view bytes) const {
  if (!in_use() || bytes.size() + sizeof(Header) > kMostBytes) return false;
  const std::string path = path_of(key), head = header_bytes(name_of(key), bytes);
  std::error_code error;
  std::filesystem::create_directories(std::filesystem::path(path).parent_path(), error);
  std::string temporary;
  const int fd = error ? -1 : open_temporary(path, temporary);
  if (fd < 0) {
    tell_once(path + ": cannot write: " + (error ? error.message() : std::strerror(errno)));
    return false;
  }
  const bool written = write_all(fd, head) && write_all(fd, bytes);
  const bool whole = ::close(fd) == 0 && written;
  if (whole && ::rename(temporary.c_str(), path.c_str()) == 0) return true;
  tell_once(path + ": cannot write: " + std::strerror(errno));
  ::unlink(temporary.c_str());
  return false;
}

ContentHash numeric_platform() {
  static const ContentHash platform = [] {
    ByteWriter all;
    all.add(std::string_view(__VERSION__)).add(std::string_view(::gnu_get_libc_version()));
    all.add(std::string_view(Eigen::SimdInstructionSetsInUse()));
    all.add(EIGEN_WORLD_VERSION).add(EIGEN_MAJOR_VERSION).add(EIGEN_MINOR_VERSION);
    for (int i = 1; i <= 64; ++i) {
      volatile double input = 0.7391 * i;  // not folded by the compiler, whose library is another
      const double x = input;
      all.add(std::sin(x)).add(std::cos(x)).add(std::exp(-x)).add(std::log(x)).add(std::pow(x, 0.3));
      all.add(std::atan2(x, 20.0)).add(std::acos(x / 50)).add(std::tan(x));
      const float f = static_cast<float>(x);
      all.add(std::sin(f)).add(std::cos(f)).add(std::exp(-f)).add(std::log(f)).add(std::pow(f, 0.3f));
      all.add(std::atan2(f, 20.0f)).add(std::acos(f / 50));
    }
    return content_hash(all.bytes());
  }();
  return platform;
}

}  // namespace binpick

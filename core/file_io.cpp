#include "core/file_io.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "core/error.hpp"

namespace binpick {
namespace {

[[noreturn]] void storage_failure(const std::string& path, const char* doing, int error) {
  throw StorageError(path + ": " + doing + ": " + std::strerror(error));
}

// Closes on every way out; close() itself can report a full disk, so writers call it themselves.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }
  int close() { return ::close(std::exchange(fd_, -1)); }

 private:
  int fd_;
};

void write_all(Descriptor& file, const std::string& path, const std::string& bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = ::write(file.get(), bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) storage_failure(path, "cannot write", errno);
    done += static_cast<std::size_t>(n);
  }
  if (::fsync(file.get()) != 0 && errno != EINVAL && errno != ENOTSUP) storage_failure(path, "cannot flush", errno);
  if (file.close() != 0) storage_failure(path, "cannot close", errno);
}

}  // namespace

std::string read_file(const std::string& path, std::size_t limit) {
  Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.get() < 0) throw AssetError(path + ": cannot open: " + std::strerror(errno));
  struct stat info {};
  if (::fstat(file.get(), &info) != 0) throw AssetError(path + ": cannot look at: " + std::strerror(errno));
  if (!S_ISREG(info.st_mode)) throw AssetError(path + ": is not a regular file");
  const auto size = static_cast<std::size_t>(info.st_size);
  if (size > limit)
    throw AssetError(path + ": " + std::to_string(size) + " bytes are more than the " + std::to_string(limit) +
                     " allowed");
  std::string bytes(size, '\0');
  std::size_t done = 0;
  while (done < size) {
    const ssize_t n = ::read(file.get(), bytes.data() + done, size - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw AssetError(path + ": cannot read: " + std::strerror(errno));
    if (n == 0) break;
    done += static_cast<std::size_t>(n);
  }
  bytes.resize(done);
  return bytes;
}

void write_file(const std::string& path, const std::string& bytes) {
  const std::string temporary = path + ".part";
  try {
    Descriptor file(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644));
    if (file.get() < 0) storage_failure(path, "cannot create", errno);
    write_all(file, path, bytes);
    if (::rename(temporary.c_str(), path.c_str()) != 0) storage_failure(path, "cannot rename into place", errno);
  } catch (const StorageError&) {
    ::unlink(temporary.c_str());
    throw;
  }
}

void append_file(const std::string& path, const std::string& bytes) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644));
  if (file.get() < 0) storage_failure(path, "cannot open", errno);
  write_all(file, path, bytes);
}

void make_folder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) throw StorageError(path + ": cannot create folder: " + error.message());
  if (!std::filesystem::is_directory(path, error)) throw StorageError(path + ": is not a folder");
}

}  // namespace binpick

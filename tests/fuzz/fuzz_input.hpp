// What the fuzz targets share: how an input may be refused, and a file for readers that take a path.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "core/error.hpp"

namespace binpick::fuzz {

/// Ends the run: the input is kept as a finding.
[[noreturn]] inline void finding(const std::string& what, const std::string& about) {
  std::fprintf(stderr, "finding: %s: %s\n", what.c_str(), about.c_str());
  std::abort();
}

/// A refusal is one readable line that begins with the name of what was read.
inline void check_refusal(const std::string& message, const std::string& name) {
  if (message.rfind(name, 0) != 0) finding("a message that does not begin with '" + name + "'", message);
  for (const char c : message)
    if (static_cast<unsigned char>(c) < 32) finding("a message with control characters or several lines", message);
}

/// Whether `read` accepts its input. SpecError and AssetError are the two ways to say no; any other exception ends the
/// run, as crashes, hangs, sanitizer reports and too much memory do.
template <class Read>
bool accepts(const std::string& name, const Read& read) {
  try {
    read();
    return true;
  } catch (const SpecError& error) {
    check_refusal(error.what(), name);
  } catch (const AssetError& error) {
    check_refusal(error.what(), name);
  }
  return false;
}

inline std::string text_of(const std::uint8_t* data, std::size_t size) {
  return size == 0 ? std::string() : std::string(reinterpret_cast<const char*>(data), size);
}

/// A file in a folder of this process's own.
class InputFile {
 public:
  explicit InputFile(const std::string& name) {
    namespace fs = std::filesystem;
    folder_ = (fs::temp_directory_path() / ("binpick_fuzz_" + std::to_string(getpid()))).string();
    fs::create_directories(folder_);
    path_ = folder_ + "/" + name;
  }
  ~InputFile() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::string& put(const std::uint8_t* data, std::size_t size) const {
    std::FILE* file = std::fopen(path_.c_str(), "wb");
    const bool written = file != nullptr && std::fwrite(data, 1, size, file) == size;
    if (file == nullptr || std::fclose(file) != 0 || !written) finding("cannot write", path_);
    return path_;
  }

 private:
  std::string folder_, path_;
};

}  // namespace binpick::fuzz

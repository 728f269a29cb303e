// Moving pictures as GIF files (giflib).
#pragma once

#include <string>

#include "core/image_io.hpp"

namespace binpick {

/// Written frame by frame, with a palette of its own for each; repeats for ever. All frames of one size.
class GifFile {
 public:
  /// `seconds` of every frame. Throws StorageError.
  GifFile(const std::string& path, int width, int height, double seconds);
  ~GifFile();
  GifFile(const GifFile&) = delete;
  GifFile& operator=(const GifFile&) = delete;

  void add(const Image<Rgb>& frame);  ///< throws StorageError
  void close();                       ///< throws StorageError; a file that was not closed is incomplete

 private:
  void fail(int error) const;
  std::string path_;
  int width_, height_, hundredths_;
  void* file_ = nullptr;
};

}  // namespace binpick

#include "trials/gif_file.hpp"

#include <gif_lib.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "core/check.hpp"
#include "core/error.hpp"

namespace binpick {
namespace {

GifFileType* gif(void* file) { return static_cast<GifFileType*>(file); }

}  // namespace

void GifFile::fail(int error) const {
  const char* why = GifErrorString(error);
  throw StorageError(path_ + ": cannot write: " + (why ? why : "unknown error"));
}

GifFile::GifFile(const std::string& path, int width, int height, double seconds)
    : path_(path), width_(width), height_(height), hundredths_(static_cast<int>(std::lround(100 * seconds))) {
  int error = 0;
  file_ = EGifOpenFileName(path.c_str(), false, &error);
  if (!file_) fail(error);
  EGifSetGifVersion(gif(file_), true);
  if (EGifPutScreenDesc(gif(file_), width, height, 8, 0, nullptr) != GIF_OK) fail(gif(file_)->Error);
  const unsigned char for_ever[] = {1, 0, 0};
  const bool good = EGifPutExtensionLeader(gif(file_), APPLICATION_EXT_FUNC_CODE) == GIF_OK &&
                    EGifPutExtensionBlock(gif(file_), 11, "NETSCAPE2.0") == GIF_OK &&
                    EGifPutExtensionBlock(gif(file_), 3, for_ever) == GIF_OK &&
                    EGifPutExtensionTrailer(gif(file_)) == GIF_OK;
  if (!good) fail(gif(file_)->Error);
}

GifFile::~GifFile() {
  int error = 0;
  if (file_) EGifCloseFile(gif(file_), &error);
}

void GifFile::add(const Image<Rgb>& frame) {
  BP_CHECK(frame.width() == width_ && frame.height() == height_, frame.width() << " x " << frame.height());
  std::vector<GifByteType> red, green, blue, indices(frame.size());
  for (std::size_t i = 0; i < frame.size(); ++i) {
    red.push_back(frame[i][0]);
    green.push_back(frame[i][1]);
    blue.push_back(frame[i][2]);
  }
  std::vector<GifColorType> colours(256);
  int count = 256;
  const auto width = static_cast<unsigned>(width_), height = static_cast<unsigned>(height_);
  if (GifQuantizeBuffer(width, height, &count, red.data(), green.data(), blue.data(), indices.data(), colours.data()) !=
      GIF_OK)
    throw StorageError(path_ + ": a frame has no palette");
  ColorMapObject* map = GifMakeMapObject(256, colours.data());
  const GraphicsControlBlock control{DISPOSE_DO_NOT, false, hundredths_, NO_TRANSPARENT_COLOR};
  GifByteType extension[4];
  EGifGCBToExtension(&control, extension);
  bool good = EGifPutExtension(gif(file_), GRAPHICS_EXT_FUNC_CODE, 4, extension) == GIF_OK &&
              EGifPutImageDesc(gif(file_), 0, 0, width_, height_, false, map) == GIF_OK;
  for (int v = 0; good && v < height_; ++v)
    good = EGifPutLine(gif(file_), &indices[static_cast<std::size_t>(v) * width], width_) == GIF_OK;
  GifFreeMapObject(map);
  if (!good) fail(gif(file_)->Error);
}

void GifFile::close() {
  int error = 0;
  void* file = file_;
  file_ = nullptr;
  if (EGifCloseFile(gif(file), &error) != GIF_OK) fail(error);
  using std::filesystem::perms;  // giflib makes files for their owner alone
  std::error_code ignored;
  std::filesystem::permissions(path_, perms::owner_read | perms::owner_write | perms::group_read | perms::others_read,
                               ignored);
}

}  // namespace binpick

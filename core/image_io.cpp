#include "core/image_io.hpp"

#include <png.h>
#include <tiffio.h>

#include <algorithm>
#include <bit>
#include <csetjmp>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <vector>

#include "core/check.hpp"
#include "core/error.hpp"
#include "core/file_io.hpp"

// Both libraries work on memory; file_io owns the disk, so a full disk is one StorageError for every kind of file and a
// half-written image is never seen. Errors of the libraries never reach stderr.

namespace binpick {
namespace {

constexpr std::uint32_t kMaxSide = 16384;
constexpr std::uint64_t kMaxPixels = std::uint64_t{1} << 26;
constexpr std::size_t kMaxFile = std::size_t{1} << 28;

bool usable_size(std::uint64_t width, std::uint64_t height) {
  return width > 0 && height > 0 && width <= kMaxSide && height <= kMaxSide && width * height <= kMaxPixels;
}

// ---- PNG
// --------------------------------------------------------------------------------------------------------------

struct PngText {
  char text[160] = "";
};

extern "C" {
static void binpick_png_error(png_structp png, png_const_charp message) {
  auto* text = static_cast<PngText*>(png_get_error_ptr(png));
  std::strncpy(text->text, message, sizeof(text->text) - 1);
  png_longjmp(png, 1);
}
static void binpick_png_warning(png_structp, png_const_charp) {}
static void binpick_png_write(png_structp png, png_bytep data, png_size_t size) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(data), size);
}
static void binpick_png_flush(png_structp) {}

struct PngSource {
  const std::string* bytes;
  std::size_t at;
};
static void binpick_png_read(png_structp png, png_bytep data, png_size_t size) {
  auto* source = static_cast<PngSource*>(png_get_io_ptr(png));
  if (source->bytes->size() - source->at < size) png_error(png, "the file ends too early");
  std::memcpy(data, source->bytes->data() + source->at, size);
  source->at += size;
}
}  // extern "C"

struct PngLayout {
  std::uint32_t width, height;
  int bits, colour;
  std::size_t row_bytes;
};

// Only plain data lives in the two functions that libpng may leave by longjmp. False on error, with `text` set.
bool encode_png(const PngLayout& layout, const std::uint8_t* pixels, std::string* out, PngText* text) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, text, binpick_png_error, binpick_png_warning);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  if (info == nullptr || setjmp(png_jmpbuf(png)) != 0) {
    png_destroy_write_struct(&png, &info);
    return false;
  }
  png_set_write_fn(png, out, binpick_png_write, binpick_png_flush);
  png_set_IHDR(png, info, layout.width, layout.height, layout.bits, layout.colour, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_compression_level(png, 6);
  png_write_info(png, info);
  if (layout.bits == 16) png_set_swap(png);
  for (std::uint32_t v = 0; v < layout.height; ++v) png_write_row(png, pixels + v * layout.row_bytes);
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return true;
}

void write_png_bytes(const std::string& path, const PngLayout& layout, const void* pixels) {
  std::string bytes;
  PngText text;
  if (!encode_png(layout, static_cast<const std::uint8_t*>(pixels), &bytes, &text))
    throw StorageError(path + ": cannot encode the PNG: " + text.text);
  write_file(path, bytes);
}

// Reads the header when `pixels` is null, otherwise the rows too.
bool decode_png(const std::string& bytes, PngLayout* layout, std::uint16_t* pixels, PngText* text) {
  PngSource source{&bytes, 0};
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, text, binpick_png_error, binpick_png_warning);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  if (info == nullptr || setjmp(png_jmpbuf(png)) != 0) {
    png_destroy_read_struct(&png, &info, nullptr);
    return false;
  }
  png_set_read_fn(png, &source, binpick_png_read);
  png_set_user_limits(png, kMaxSide, kMaxSide);
  png_read_info(png, info);
  layout->width = png_get_image_width(png, info);
  layout->height = png_get_image_height(png, info);
  layout->bits = png_get_bit_depth(png, info);
  layout->colour = png_get_color_type(png, info);
  if (pixels != nullptr) {
    if (png_get_interlace_type(png, info) != PNG_INTERLACE_NONE) png_error(png, "interlaced images are not read");
    png_set_swap(png);
    for (std::uint32_t v = 0; v < layout->height; ++v)
      png_read_row(png, reinterpret_cast<png_bytep>(pixels + std::size_t{v} * layout->width), nullptr);
    png_read_end(png, nullptr);
  }
  png_destroy_read_struct(&png, &info, nullptr);
  return true;
}

// ---- TIFF
// -------------------------------------------------------------------------------------------------------------

struct TiffMemory {
  std::string bytes;
  std::size_t at = 0;
  std::string error;
};

extern "C" {
static TiffMemory* tiff_memory(thandle_t handle) { return static_cast<TiffMemory*>(handle); }
static tmsize_t binpick_tiff_read(thandle_t handle, void* data, tmsize_t size) {
  TiffMemory* m = tiff_memory(handle);
  const std::size_t left = m->at < m->bytes.size() ? m->bytes.size() - m->at : 0;
  const std::size_t count = std::min(left, static_cast<std::size_t>(size));
  if (count > 0) std::memcpy(data, m->bytes.data() + m->at, count);
  m->at += count;
  return static_cast<tmsize_t>(count);
}
static tmsize_t binpick_tiff_write(thandle_t handle, void* data, tmsize_t size) {
  TiffMemory* m = tiff_memory(handle);
  const std::size_t end = m->at + static_cast<std::size_t>(size);
  if (m->bytes.size() < end) m->bytes.resize(end);
  std::memcpy(m->bytes.data() + m->at, data, static_cast<std::size_t>(size));
  m->at = end;
  return size;
}
static toff_t binpick_tiff_seek(thandle_t handle, toff_t offset, int whence) {
  TiffMemory* m = tiff_memory(handle);
  m->at = static_cast<std::size_t>(offset) + (whence == SEEK_CUR ? m->at : whence == SEEK_END ? m->bytes.size() : 0);
  return m->at;
}
static int binpick_tiff_close(thandle_t) { return 0; }
static toff_t binpick_tiff_size(thandle_t handle) { return tiff_memory(handle)->bytes.size(); }
static int binpick_tiff_error(TIFF*, void* user, const char*, const char* format, va_list arguments) {
  char line[200];
  std::vsnprintf(line, sizeof(line), format, arguments);
  auto* m = static_cast<TiffMemory*>(user);
  if (m->error.empty()) m->error = line;
  return 1;
}
static int binpick_tiff_warning(TIFF*, void*, const char*, const char*, va_list) { return 1; }
}  // extern "C"

TIFF* open_tiff(TiffMemory& memory, const char* mode) {
  TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
  TIFFOpenOptionsSetErrorHandlerExtR(options, binpick_tiff_error, &memory);
  TIFFOpenOptionsSetWarningHandlerExtR(options, binpick_tiff_warning, nullptr);
  TIFF* tiff = TIFFClientOpenExt("image", mode, &memory, binpick_tiff_read, binpick_tiff_write, binpick_tiff_seek,
                                 binpick_tiff_close, binpick_tiff_size, nullptr, nullptr, options);
  TIFFOpenOptionsFree(options);
  return tiff;
}

bool encode_tiff(TIFF* tiff, const Image<float>& image) {
  bool good = TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(image.width())) == 1;
  good = good && TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(image.height())) == 1;
  good =
      good && TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 32) == 1 && TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1) == 1;
  good = good && TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP) == 1;
  good = good && TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK) == 1;
  good = good && TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) == 1;
  good = good && TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE) == 1;
  good = good && TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, static_cast<std::uint32_t>(image.height())) == 1;
  std::vector<float> row(static_cast<std::size_t>(image.width()));  // libtiff may scribble over its input
  for (int v = 0; good && v < image.height(); ++v) {
    std::copy_n(&image(0, v), image.width(), row.begin());
    good = TIFFWriteScanline(tiff, row.data(), static_cast<std::uint32_t>(v), 0) == 1;
  }
  return good && TIFFFlush(tiff) == 1;
}

}  // namespace

void write_png(const std::string& path, const Image<Rgb>& image) {
  static_assert(sizeof(Rgb) == 3);
  BP_CHECK(!image.empty());
  const auto width = static_cast<std::uint32_t>(image.width());
  write_png_bytes(path,
                  {width, static_cast<std::uint32_t>(image.height()), 8, PNG_COLOR_TYPE_RGB, std::size_t{width} * 3},
                  image.data());
}

void write_png8(const std::string& path, const Image<std::uint8_t>& image) {
  BP_CHECK(!image.empty());
  const auto width = static_cast<std::uint32_t>(image.width());
  write_png_bytes(path, {width, static_cast<std::uint32_t>(image.height()), 8, PNG_COLOR_TYPE_GRAY, width},
                  image.data());
}

void write_png16(const std::string& path, const Image<std::uint16_t>& image) {
  static_assert(std::endian::native == std::endian::little, "png_set_swap assumes a little-endian host");
  BP_CHECK(!image.empty());
  const auto width = static_cast<std::uint32_t>(image.width());
  write_png_bytes(path,
                  {width, static_cast<std::uint32_t>(image.height()), 16, PNG_COLOR_TYPE_GRAY, std::size_t{width} * 2},
                  image.data());
}

Image<std::uint16_t> read_png16(const std::string& path) {
  const std::string bytes = read_file(path, kMaxFile);
  PngLayout layout{};
  PngText text;
  if (!decode_png(bytes, &layout, nullptr, &text)) throw AssetError(path + ": not a usable PNG: " + text.text);
  if (layout.bits != 16 || layout.colour != PNG_COLOR_TYPE_GRAY)
    throw AssetError(path + ": expected a PNG with one 16-bit grey channel");
  if (!usable_size(layout.width, layout.height)) throw AssetError(path + ": the PNG is larger than 64 megapixels");
  Image<std::uint16_t> image(static_cast<int>(layout.width), static_cast<int>(layout.height));
  if (!decode_png(bytes, &layout, image.data(), &text)) throw AssetError(path + ": damaged PNG: " + text.text);
  return image;
}

void write_tiff(const std::string& path, const Image<float>& image) {
  BP_CHECK(!image.empty());
  TiffMemory memory;
  TIFF* tiff = open_tiff(memory, "wl");
  const bool good = tiff != nullptr && encode_tiff(tiff, image);
  if (tiff != nullptr) TIFFClose(tiff);
  if (!good || !memory.error.empty()) throw StorageError(path + ": cannot encode the TIFF: " + memory.error);
  write_file(path, memory.bytes);
}

Image<float> read_tiff(const std::string& path) {
  TiffMemory memory;
  memory.bytes = read_file(path, kMaxFile);
  TIFF* tiff = open_tiff(memory, "rm");
  if (tiff == nullptr) throw AssetError(path + ": not a usable TIFF: " + memory.error);
  std::uint32_t width = 0, height = 0;
  std::uint16_t bits = 0, samples = 1, format = 0;
  TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &width);
  TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &height);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &bits);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &samples);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &format);
  std::string problem;
  Image<float> image;
  if (bits != 32 || samples != 1 || format != SAMPLEFORMAT_IEEEFP || TIFFIsTiled(tiff))
    problem = "expected one 32-bit float channel in strips";
  else if (!usable_size(width, height))
    problem = "the image is empty or larger than 64 megapixels";
  else if (TIFFScanlineSize(tiff) != static_cast<tmsize_t>(width * sizeof(float)))
    problem = "rows have an unexpected length";
  if (problem.empty()) image = Image<float>(static_cast<int>(width), static_cast<int>(height));
  for (std::uint32_t v = 0; problem.empty() && v < height; ++v)
    if (TIFFReadScanline(tiff, &image(0, static_cast<int>(v)), v, 0) != 1) problem = "damaged: " + memory.error;
  TIFFClose(tiff);
  if (!problem.empty()) throw AssetError(path + ": TIFF: " + problem);
  return image;
}

}  // namespace binpick

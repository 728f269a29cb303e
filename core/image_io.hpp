// Images on disk: PNG for people (8-bit RGB), PNG (16-bit) and TIFF (float) for depth. libpng and libtiff.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/image.hpp"

namespace binpick {

using Rgb = std::array<std::uint8_t, 3>;

void write_png(const std::string& path, const Image<Rgb>& image);             ///< throws StorageError
void write_png8(const std::string& path, const Image<std::uint8_t>& image);   ///< grey; throws StorageError
void write_png16(const std::string& path, const Image<std::uint16_t>& image); ///< throws StorageError
Image<std::uint16_t> read_png16(const std::string& path);                     ///< throws AssetError
void write_tiff(const std::string& path, const Image<float>& image);          ///< throws StorageError
Image<float> read_tiff(const std::string& path);                              ///< throws AssetError

}  // namespace binpick

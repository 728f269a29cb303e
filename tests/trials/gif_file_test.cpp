// GIF files, read back by giflib: size, frames, delay, repetition, colours.
#include "trials/gif_file.hpp"

#include <gif_lib.h>
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "tests/core/temp_folder.hpp"

namespace binpick {
namespace {

TEST(GifFile, IsReadBack) {
  const TempFolder folder;
  const std::string path = folder.at("film.gif");
  Image<Rgb> frame(24, 16, Rgb{200, 40, 8});
  frame(5, 7) = {8, 16, 240};
  GifFile gif(path, 24, 16, 0.1);
  gif.add(frame);
  gif.add(Image<Rgb>(24, 16, Rgb{0, 120, 0}));
  gif.close();
  int error = 0;
  GifFileType* file = DGifOpenFileName(path.c_str(), &error);
  ASSERT_NE(file, nullptr);
  ASSERT_EQ(DGifSlurp(file), GIF_OK) << GifErrorString(file->Error);
  EXPECT_EQ(file->SWidth, 24);
  EXPECT_EQ(file->SHeight, 16);
  ASSERT_EQ(file->ImageCount, 2);
  GraphicsControlBlock control;
  ASSERT_EQ(DGifSavedExtensionToGCB(file, 0, &control), GIF_OK);
  EXPECT_EQ(control.DelayTime, 10);
  const SavedImage& first = file->SavedImages[0];
  const auto colour = [&](int u, int v) {
    const GifColorType& c = first.ImageDesc.ColorMap->Colors[first.RasterBits[v * 24 + u]];
    return std::array<int, 3>{c.Red, c.Green, c.Blue};
  };
  const auto near = [](const std::array<int, 3>& a, const std::array<int, 3>& b) {
    int most = 0;  // a palette keeps five bits of each
    for (std::size_t i = 0; i < 3; ++i) most = std::max(most, std::abs(a[i] - b[i]));
    return most <= 8;
  };
  EXPECT_TRUE(near(colour(5, 7), {8, 16, 240}));
  EXPECT_TRUE(near(colour(6, 7), {200, 40, 8}));
  EXPECT_NE(read_file(path).find("NETSCAPE2.0"), std::string::npos);
  DGifCloseFile(file, &error);
}

TEST(GifFile, AFolderThatIsNotThereIsNamed) {
  try {
    GifFile("/nowhere/at/all.gif", 8, 8, 0.1);
    FAIL();
  } catch (const StorageError& error) {
    EXPECT_NE(std::string(error.what()).find("/nowhere/at/all.gif: cannot write"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace binpick

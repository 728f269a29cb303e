// Images on disk: what is written is read back bit for bit; damaged, foreign and unwritable files are one clear error.
#include "core/image_io.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

#include "core/error.hpp"
#include "core/file_io.hpp"

namespace binpick {
namespace {

class ImageIo : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              (std::string("image_io_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::filesystem::path folder_;
};

Image<std::uint16_t> ramp() {
  Image<std::uint16_t> image(37, 11);
  for (std::size_t i = 0; i < image.size(); ++i) image[i] = static_cast<std::uint16_t>(i * 161);
  return image;
}

TEST_F(ImageIo, Png16RoundTrip) {
  const Image<std::uint16_t> image = ramp();
  write_png16(path("a.png"), image);
  const Image<std::uint16_t> back = read_png16(path("a.png"));
  ASSERT_EQ(back.width(), 37);
  ASSERT_EQ(back.height(), 11);
  EXPECT_TRUE(std::equal(image.begin(), image.end(), back.begin()));
}

TEST_F(ImageIo, TiffRoundTripKeepsEveryBit) {
  Image<float> image(29, 13, 0.5f);
  image[0] = std::numeric_limits<float>::quiet_NaN();
  image[1] = std::numeric_limits<float>::infinity();
  image[2] = 1e-42f;
  image[3] = -0.0f;
  image[4] = 0.1f;
  write_tiff(path("a.tif"), image);
  const Image<float> back = read_tiff(path("a.tif"));
  ASSERT_EQ(back.width(), 29);
  ASSERT_EQ(back.height(), 13);
  EXPECT_EQ(std::memcmp(image.data(), back.data(), image.size() * sizeof(float)), 0);
}

TEST_F(ImageIo, RgbPngHasTheSignatureAndSize) {
  write_png(path("a.png"), Image<Rgb>(5, 3, Rgb{10, 20, 30}));
  const std::string bytes = read_file(path("a.png"));
  EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(bytes[19], 5);  // IHDR: width, height, big-endian
  EXPECT_EQ(bytes[23], 3);
  EXPECT_THROW(read_png16(path("a.png")), AssetError);  // not 16-bit grey
}

TEST_F(ImageIo, DamagedFilesAreAssetErrors) {
  write_png16(path("a.png"), ramp());
  write_tiff(path("a.tif"), Image<float>(50, 40, 1.0f));
  for (const char* name : {"a.png", "a.tif"}) {
    const std::string bytes = read_file(path(name));
    for (const std::size_t keep :
         {std::size_t{0}, std::size_t{1}, std::size_t{7}, bytes.size() / 3, bytes.size() / 2}) {
      write_file(path("cut"), bytes.substr(0, keep));
      if (std::string(name) == "a.png")
        EXPECT_THROW(read_png16(path("cut")), AssetError) << name << " " << keep;
      else
        EXPECT_THROW(read_tiff(path("cut")), AssetError) << name << " " << keep;
    }
  }
  EXPECT_THROW(read_png16(path("none.png")), AssetError);
  EXPECT_THROW(read_tiff(path("none.tif")), AssetError);
  EXPECT_THROW(read_tiff(path("a.png")), AssetError);
  EXPECT_THROW(read_png16(path("a.tif")), AssetError);
}

TEST_F(ImageIo, MessageNamesTheFile) {
  write_file(path("bad.png"), "hello");
  try {
    read_png16(path("bad.png"));
    FAIL() << "no error";
  } catch (const AssetError& e) {
    EXPECT_NE(std::string(e.what()).find("bad.png"), std::string::npos) << e.what();
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
  }
}

TEST_F(ImageIo, UnwritablePlaceIsAStorageError) {
  write_file(path("plain"), "x");
  const std::string below_a_file = path("plain") + "/a.png";
  EXPECT_THROW(write_png(below_a_file, Image<Rgb>(4, 4)), StorageError);
  EXPECT_THROW(write_png16(below_a_file, ramp()), StorageError);
  EXPECT_THROW(write_tiff(below_a_file, Image<float>(4, 4)), StorageError);
}

// A file that may not grow beyond 1000 bytes stands for a full disk: the error comes from write() just the same.
TEST_F(ImageIo, FullDiskIsAStorageErrorAndLeavesNoImage) {
  Image<float> image(64, 64);
  for (std::size_t i = 0; i < image.size(); ++i) image[i] = 1.0f / static_cast<float>(i + 1);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit small = before;
  small.rlim_cur = 1000;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  EXPECT_THROW(write_tiff(path("a.tif"), image), StorageError);
  EXPECT_THROW(write_png16(path("a.png"), Image<std::uint16_t>(800, 800)), StorageError);
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

}  // namespace
}  // namespace binpick

#include "core/file_io.hpp"
#include <sys/stat.h>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "core/error.hpp"
#include "core/hash.hpp"
#include "core/mesh_properties.hpp"
#include "core/parallel.hpp"
#include "core/primitive.hpp"

namespace binpick {
namespace {

namespace fs = std::filesystem;

class FileIo : public testing::Test {
 protected:
  FileIo() : folder_(fs::temp_directory_path() / ("binpick_file_io_" + std::to_string(::getpid()))) {
    make_folder(folder_.string());
  }
  ~FileIo() override { fs::remove_all(folder_); }
  std::string path(const char* name) const { return (folder_ / name).string(); }
  fs::path folder_;
};

TEST_F(FileIo, WritesAppendsAndReads) {
  write_file(path("a"), std::string("one\0two", 7));
  append_file(path("a"), "three");
  EXPECT_EQ(read_file(path("a")), std::string("one\0twothree", 12));
  EXPECT_FALSE(fs::exists(path("a.part")));
}

TEST_F(FileIo, RefusesWhatIsNotARegularFile) {
  EXPECT_THROW(read_file(path("missing")), AssetError);
  EXPECT_THROW(read_file(folder_.string()), AssetError);
  ASSERT_EQ(::mkfifo(path("fifo").c_str(), 0600), 0);
  EXPECT_THROW(read_file(path("fifo")), AssetError);  // and does not wait for a writer
  write_file(path("long"), "12345");
  EXPECT_THROW(read_file(path("long"), 4), AssetError);
}

TEST_F(FileIo, StorageFailuresNameTheFileAndLeaveNothingBehind) {
  try {
    write_file(path("no/such/folder/x"), "text");
    FAIL() << "wrote into a folder that is not there";
  } catch (const StorageError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("no/such/folder/x"));
  }
  EXPECT_THROW(append_file("/dev/full", std::string(100000, 'x')), StorageError);  // the device of a full disk
  write_file(path("file"), "text");
  EXPECT_THROW(make_folder(path("file") + "/below"), StorageError);
}

TEST(Hash, IsOfValuesAndOrder) {
  EXPECT_EQ(Hasher().add(0.0).value(), Hasher().add(-0.0).value());
  EXPECT_NE(Hasher().add(1.0).add(2.0).value(), Hasher().add(2.0).add(1.0).value());
  EXPECT_NE(Hasher().add("ab").add("c").value(), Hasher().add("a").add("bc").value());
  EXPECT_EQ(from_hex(hex(0x0123456789abcdefull)), 0x0123456789abcdefull);
  EXPECT_THROW(from_hex("xyz"), SpecError);
}

TEST(Parallel, ResultsByIndexOnAnyNumberOfThreads) {
  std::vector<std::size_t> one(1000), four(1000);
  parallel_for(1000, 1, [&](std::size_t i) { one[i] = i * i; });
  parallel_for(1000, 4, [&](std::size_t i) { four[i] = i * i; });
  EXPECT_EQ(one, four);
}

TEST(Parallel, TheFirstFailureIsTold) {
  for (const int threads : {1, 3}) try {
      parallel_for(100, threads, [](std::size_t i) {
        if (i == 7 || i == 60) throw std::runtime_error(std::to_string(i));
      });
      FAIL() << "no failure";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "7");
    }
}

TEST(Primitive, MeshesAreClosedOutwardAndOfTheRightVolume) {
  const double box = mass_properties(mesh_of(Primitive::box({0.1, 0.2, 0.3})), 1).volume;
  EXPECT_NEAR(box, 0.006, 1e-12);
  // A prism of n facets inside the circle: area n/2 sin(2 pi / n) r^2.
  const double cylinder = mass_properties(mesh_of(Primitive::cylinder(0.1, 0.5), 48), 1).volume;
  EXPECT_NEAR(cylinder, 0.5 * 24 * std::sin(2 * std::acos(-1.0) / 48) * 0.01, 1e-12);
  const TriangleMesh sphere = mesh_of(Primitive::sphere(0.1), 96);
  EXPECT_TRUE(is_closed(sphere));
  EXPECT_NEAR(mass_properties(sphere, 1).volume, 4.0 / 3 * std::acos(-1.0) * 1e-3, 0.005 * 4.2e-3);
}

}  // namespace
}  // namespace binpick

#include "core/disk_cache.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <limits>
#include <map>

#include "core/byte_stream.hpp"
#include "core/file_io.hpp"
#include "core/random.hpp"
#include "temp_folder.hpp"

namespace binpick {
namespace {

namespace fs = std::filesystem;

CacheKey key_of(std::string_view content, const char* kind = "thing", std::uint32_t version = 1) {
  return {kind, version, content_hash(content)};
}

std::size_t files_in(const std::string& folder) {
  std::size_t count = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) count += entry.is_regular_file();
  return count;
}

/// An environment variable for one test; null: unset.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    set(value);
  }
  ~Variable() { set(before_ ? before_->c_str() : nullptr); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  void set(const char* value) const { value ? ::setenv(name_, value, 1) : ::unsetenv(name_); }
  const char* name_;
  std::optional<std::string> before_;
};

// MurmurHash3_x64_128 with seed 0, as its author's program prints it (h1, then h2, as numbers).
TEST(ContentHash, IsThePublishedFunction) {
  EXPECT_EQ(content_hash("").hex(), std::string(32, '0'));
  EXPECT_EQ(content_hash("hello").hex(), "cbd8a7b341bd9b025b1e906a48ae1d19");
  EXPECT_EQ(content_hash("The quick brown fox jumps over the lazy dog").hex(), "e34bbc7bbc071b6c7a433ca9c49a9347");
}

TEST(ByteStream, GivesBackWhatItTook) {
  const std::vector<std::array<std::uint32_t, 3>> triangles = {{0, 1, 2}, {2, 1, 3}};
  const std::vector<Eigen::Vector3f> points = {{1, -0.0f, 3}, {4, 5, std::numeric_limits<float>::infinity()}};
  ByteWriter out;
  out.add(0.1).add(triangles).add(std::string_view("a name")).add(std::vector<double>{}).add(points);
  double number = 0;
  std::vector<std::array<std::uint32_t, 3>> triangles_back;
  std::vector<Eigen::Vector3f> points_back;
  std::vector<double> none = {1, 2};
  std::string name;
  ByteReader in(out.bytes());
  in.get(number).get(triangles_back).get(name).get(none).get(points_back);
  EXPECT_TRUE(in.done());
  EXPECT_EQ(number, 0.1);
  EXPECT_EQ(triangles_back, triangles);
  EXPECT_EQ(name, "a name");
  EXPECT_TRUE(none.empty());
  EXPECT_EQ(points_back, points);
  EXPECT_TRUE(std::signbit(points_back[0].y()));
}

TEST(ByteStream, EveryCutIsNoticedAndNothingIsReadBeyond) {
  ByteWriter out;
  out.add(std::vector<double>{1, 2, 3}).add(std::string_view("text")).add(std::uint32_t{7});
  for (std::size_t size = 0; size <= out.bytes().size() + 1; ++size) {
    const std::string bytes = (out.bytes() + "x").substr(0, size);  // the sanitizer watches this one's end
    std::vector<double> numbers;
    std::string text;
    ByteReader in(bytes);
    const auto seven = in.get(numbers).get(text).get<std::uint32_t>();
    EXPECT_EQ(in.done(), size == out.bytes().size());
    EXPECT_EQ(seven, in.ok() ? 7u : 0u);
  }
}

TEST(ByteStream, ALengthThatCannotBeAllocatesNothing) {
  for (const std::uint64_t length :
       {std::uint64_t{3}, std::uint64_t{1} << 40, std::uint64_t{1} << 61, ~std::uint64_t{0}}) {
    ByteWriter out;
    out.add(length).add(1.0).add(2.0);
    std::vector<double> numbers;
    ByteReader in(out.bytes());
    in.get(numbers);
    EXPECT_FALSE(in.ok()) << length;
    EXPECT_TRUE(numbers.empty());
    EXPECT_EQ(in.get<double>(), 0);
  }
}

TEST(ByteStream, AnyBytesAreReadToAnEnd) {
  Rng rng = Seed{11}.rng();
  for (int round = 0; round < 2000; ++round) {
    std::string bytes(static_cast<std::size_t>(rng.uniform() * 200), '\0');
    for (char& byte : bytes) byte = rng.uniform() < 0.7 ? '\0' : static_cast<char>(rng.uniform() * 256);
    ByteReader in(bytes);
    std::size_t taken = 0;
    for (int k = 0; k < 20; ++k) {
      std::vector<float> numbers;
      std::string text;
      in.get(numbers).get(text);
      taken += numbers.size() * sizeof(float) + text.size();
    }
    EXPECT_LE(taken, bytes.size());
  }
}

TEST(DiskCache, GivesBackWhatWasStored) {
  const TempFolder folder;
  const DiskCache cache(folder.at("new/folder"));
  EXPECT_FALSE(cache.load(key_of("a")));
  EXPECT_FALSE(fs::exists(cache.folder()));  // looking makes no folder
  EXPECT_TRUE(cache.store(key_of("a"), std::string("one\0two", 7)));
  EXPECT_TRUE(cache.store(key_of("b"), ""));
  EXPECT_EQ(cache.load(key_of("a")), std::string("one\0two", 7));
  EXPECT_EQ(cache.load(key_of("b")), "");
  EXPECT_TRUE(cache.store(key_of("a"), "again"));
  EXPECT_EQ(cache.load(key_of("a")), "again");
  EXPECT_EQ(files_in(cache.folder()), 2u);
}

TEST(DiskCache, AnotherKindVersionOrContentIsAnotherEntry) {
  const TempFolder folder;
  const DiskCache cache(folder.at("c"));
  ASSERT_TRUE(cache.store(key_of("a"), "data"));
  EXPECT_FALSE(cache.load(key_of("b")));
  EXPECT_FALSE(cache.load(key_of("a", "other")));
  EXPECT_FALSE(cache.load(key_of("a", "thing", 2)));
}

TEST(DiskCache, ADamagedEntryIsNotThereAndIsReplaced) {
  const TempFolder folder;
  const DiskCache cache(folder.at("c"));
  const CacheKey key = key_of("a");
  std::string payload;
  for (int i = 0; i < 100; ++i) payload += static_cast<char>(7 * i);
  ASSERT_TRUE(cache.store(key, payload));
  const std::string path = cache.path_of(key), whole = read_file(path);
  const auto put = [&](const std::string& bytes) { std::ofstream(path, std::ios::binary) << bytes; };
  for (std::size_t i = 0; i < whole.size(); i += i < 48 ? 1 : 7) {  // every byte of the header
    std::string flipped = whole;
    flipped[i] = static_cast<char>(flipped[i] ^ (1 << (i % 8)));
    put(flipped);
    EXPECT_FALSE(cache.load(key)) << "bit " << i % 8 << " of byte " << i;
    put(whole.substr(0, i));
    EXPECT_FALSE(cache.load(key)) << "cut to " << i;
    put(whole.substr(0, i) + std::string(whole.size() - i, '\0'));  // a torn page
    EXPECT_FALSE(cache.load(key)) << "zeros from " << i;
  }
  put(whole + "x");
  EXPECT_FALSE(cache.load(key));
  put(whole);
  EXPECT_EQ(cache.load(key), payload);
  put("");
  ASSERT_TRUE(cache.store(key, payload));
  EXPECT_EQ(cache.load(key), payload);
}

TEST(DiskCache, AnEntryUnderAnothersNameIsRefused) {
  const TempFolder folder;
  const DiskCache cache(folder.at("c"));
  ASSERT_TRUE(cache.store(key_of("a"), "of a"));
  fs::copy_file(cache.path_of(key_of("a")), cache.path_of(key_of("b")));
  EXPECT_FALSE(cache.load(key_of("b")));
}

TEST(DiskCache, ADiskThatWillNotIsNoError) {
  const TempFolder folder;
  const DiskCache none{""};
  EXPECT_FALSE(none.in_use());
  EXPECT_FALSE(none.store(key_of("a"), "data"));
  EXPECT_FALSE(none.load(key_of("a")));

  const DiskCache below_a_file(folder.put("file", "text"));
  EXPECT_FALSE(below_a_file.store(key_of("a"), "data"));
  EXPECT_FALSE(below_a_file.load(key_of("a")));

  EXPECT_FALSE(DiskCache("/proc/no/such").store(key_of("a"), "data"));  // read-only, for root as well

  const DiskCache cache(folder.at("c"));
  fs::create_directories(cache.path_of(key_of("a")));  // a folder where the entry belongs
  EXPECT_FALSE(cache.store(key_of("a"), "data"));
  EXPECT_FALSE(cache.load(key_of("a")));
  EXPECT_EQ(files_in(cache.folder()), 0u);  // and no temporary file is left
}

TEST(DiskCache, TheFolderIsWhatTheEnvironmentSays) {
  const Variable home("HOME", "/home/me"), xdg("XDG_CACHE_HOME", nullptr), own("BINPICK_CACHE", nullptr);
  EXPECT_EQ(DiskCache::from_environment().folder(), "/home/me/.cache/binpick");
  {
    const Variable shared("XDG_CACHE_HOME", "/var/cache");
    EXPECT_EQ(DiskCache::from_environment().folder(), "/var/cache/binpick");
    const Variable named("BINPICK_CACHE", "/data/binpick");
    EXPECT_EQ(DiskCache::from_environment().folder(), "/data/binpick");
    const Variable off("BINPICK_CACHE", "off");
    EXPECT_FALSE(DiskCache::from_environment().in_use());
  }
  const Variable relative("XDG_CACHE_HOME", "here"), homeless("HOME", nullptr), empty("BINPICK_CACHE", "");
  EXPECT_FALSE(DiskCache::from_environment().in_use());
}

// Writers and readers in processes of their own: every load is one of the whole entries or nothing.
TEST(DiskCache, ManyProcessesShareAFolder) {
  const TempFolder folder;
  const DiskCache cache(folder.at("c"));
  const auto payload = [](int who) {
    return std::string(5000 + 1000 * static_cast<std::size_t>(who), char('a' + who));
  };
  std::vector<pid_t> children;
  for (int who = 0; who < 4; ++who) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      int wrong = 0, read = 0;
      for (int round = 0; round < 50; ++round) {
        wrong += !cache.store(key_of("shared"), payload(who));
        const auto seen = cache.load(key_of("shared"));
        read += seen.has_value();
        wrong += seen && (seen->empty() || *seen != payload(seen->front() - 'a'));
      }
      ::_exit(wrong == 0 && read == 50 ? 0 : 1);
    }
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
  }
  EXPECT_EQ(files_in(cache.folder()), 1u);
}

}  // namespace
}  // namespace binpick

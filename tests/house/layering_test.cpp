// The house rules that a machine can see: who includes whom, which third party lives where, and what is banned.
// The table is that of docs/architecture.md section 1.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

const fs::path kRoot = BINPICK_SOURCE_DIR;

const std::map<std::string, Names> kMayInclude = {
    {"core", {"core"}},
    {"sim", {"core", "sim"}},
    {"perception", {"core", "perception"}},
    {"robot", {"core", "robot"}},
    {"evaluation", {"core", "evaluation"}},
    {"trials", {"core", "sim", "perception", "robot", "evaluation", "trials"}},
    {"tools", {"core", "sim", "perception", "robot", "evaluation", "trials", "tools"}},
};

// Prefix of a third-party include -> rooms that may use it.
const std::map<std::string, Names> kThirdParties = {
    {"yaml-cpp/", {"core"}},
    {"spdlog/", {"core"}},
    {"assimp/", {"core"}},
    {"png.h", {"core"}},
    {"tiff", {"core"}},
    {"Random123/", {"core"}},
    {"nlohmann/", {"core", "evaluation", "trials", "tools"}},
    {"bullet/", {"sim", "robot"}},
    {"bt", {"sim", "robot"}},
    {"GL/", {"sim"}},
    {"embree", {"sim"}},
    {"opencv2/", {"sim", "perception", "trials", "tools"}},
    {"pcl/", {"perception", "tools"}},
    {"libqhull", {"core", "perception"}},
    {"urdf", {"robot"}},
    {"boost/", {"evaluation"}},
    {"meshoptimizer", {"trials"}},
    {"gif_lib", {"trials"}},
    {"tinyxml2", {"evaluation"}},
    {"STEPControl_", {"core", "tools"}},  // Open CASCADE has no folder of its own
    {"BRep", {"core", "tools"}},
    {"TopoDS", {"core", "tools"}},
    {"gp_", {"core", "tools"}},
    {"kdl/", {"robot"}},
    {"ompl/", {"robot"}},
    {"CLI/", {"tools"}},
};

struct Line {
  fs::path file;
  int number;
  std::string text;
  std::string where() const { return fs::relative(file, kRoot).string() + ":" + std::to_string(number); }
};

std::vector<Line> lines_of(const std::string& room) {
  std::vector<Line> lines;
  for (const auto& entry : fs::recursive_directory_iterator(kRoot / room)) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".hpp" && extension != ".cpp") continue;
    std::ifstream stream(entry.path());
    int number = 0;
    for (std::string text; std::getline(stream, text);) lines.push_back({entry.path(), ++number, text});
  }
  return lines;
}

// The included name, or "" when the line includes nothing.
std::string included(const std::string& line, char open) {
  static const std::regex pattern(R"(^\s*#\s*include\s*(["<])([^">]+)[">])");
  std::smatch match;
  if (!std::regex_search(line, match, pattern) || match[1].str()[0] != open) return "";
  return match[2];
}

TEST(Layering, RoomsIncludeOnlyWhatTheTableAllows) {
  int seen = 0;
  for (const auto& [room, allowed] : kMayInclude)
    for (const Line& line : lines_of(room)) {
      const std::string name = included(line.text, '"');
      if (name.empty()) continue;
      ++seen;
      EXPECT_TRUE(allowed.count(name.substr(0, name.find('/')))) << line.where() << " includes " << name;
    }
  EXPECT_GT(seen, 100);
}

TEST(Layering, TruthNeverReachesPerceptionOrRobot) {
  for (const std::string room : {"perception", "robot"})
    for (const Line& line : lines_of(room))
      EXPECT_NE(included(line.text, '"'), "core/ground_truth.hpp") << line.where();
}

TEST(Layering, ThirdPartiesLiveInTheirRooms) {
  for (const auto& [room, unused] : kMayInclude)
    for (const Line& line : lines_of(room)) {
      const std::string name = included(line.text, '<');
      for (const auto& [prefix, rooms] : kThirdParties)
        EXPECT_TRUE(name.rfind(prefix, 0) != 0 || rooms.count(room)) << line.where() << " includes <" << name << ">";
    }
}

TEST(Layering, PublicHeadersShowOnlyEigenAndTheStandardLibrary) {
  // Headers that say "private to" in their first lines belong to one room's .cpp files.
  for (const std::string room : {"core", "sim", "perception", "robot", "evaluation", "trials"}) {
    std::map<fs::path, std::string> openings;
    for (const Line& line : lines_of(room))
      if (line.number <= 4) openings[line.file] += line.text + "\n";
    for (const Line& line : lines_of(room)) {
      if (line.file.extension() != ".hpp") continue;
      const std::string& opening = openings[line.file];
      if (opening.find("rivate to") != std::string::npos) continue;
      const std::string name = included(line.text, '<');
      // Headers of the standard library have neither folder nor ending.
      EXPECT_TRUE(name.find_first_of("/.") == std::string::npos || name.rfind("Eigen/", 0) == 0) << line.where();
    }
  }
}

TEST(House, BannedSourcesOfChance) {
  const std::regex banned(
      R"(#include <random>|\bstd::rand\b|\bsrand\(|std::random_device|std::shuffle|unordered_(map|set)<)");
  for (const auto& [room, unused] : kMayInclude)
    for (const Line& line : lines_of(room))
      EXPECT_FALSE(line.text.find("//") == std::string::npos && std::regex_search(line.text, banned))
          << line.where() << ": " << line.text;
}

TEST(House, FilesStayReadable) {
  for (const auto& [room, unused] : kMayInclude) {
    std::map<fs::path, int> lengths;
    for (const Line& line : lines_of(room)) lengths[line.file] = line.number;
    for (const auto& [file, length] : lengths) EXPECT_LE(length, 300) << fs::relative(file, kRoot);
  }
}

}  // namespace

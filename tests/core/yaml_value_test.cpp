// Values set over a YAML file: what they change, and what is said of those that cannot be meant.

#include "core/yaml_value.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "core/yaml.hpp"
#include "tests/core/temp_folder.hpp"

namespace binpick {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

struct Tool {
  double length = 0.2;
  std::string mesh;
  std::vector<double> offsets;
  void visit(ConfigVisitor& v) {
    v.field("length", length, Unit::kLength, "how long");
    v.path("mesh", mesh, "its shape");
    v.field("offsets", offsets, Unit::kLength, "where its cups are");
  }
};

struct Item {
  int count = 1;
  void visit(ConfigVisitor& v) { v.field("count", count, "how many"); }
};

// `tool:` is a file or a mapping, and a mapping may begin with one, as a scene's cell may.
struct Config {
  double height = 0.4;
  Pose pose = Pose::Identity();
  Tool tool;
  std::vector<Item> items;
  std::vector<std::string> program;
  void visit(ConfigVisitor& v) {
    v.field("height", height, Unit::kLength, "how high");
    v.field("pose", pose, "where");
    v.list("items", items, "items");
    v.command("program", program, "what is run");
    if (v.reading() && v.is_scalar("tool")) {
      std::string file;
      v.path("tool", file, "tool file");
      read_yaml_file(file, [&](ConfigVisitor& in) { tool.visit(in); });
      return;
    }
    v.section_with(
        "tool",
        [&](ConfigVisitor& in) {
          std::string base;
          if (in.has("base")) {
            in.path("base", base, "tool file to start from");
            read_yaml_file(base, [&](ConfigVisitor& file) { tool.visit(file); });
          }
          tool.visit(in);
        },
        "the tool");
  }
};

class YamlSettings : public testing::Test {
 protected:
  void SetUp() override { folder_.put("tool.yaml", "length: 300 mm\nmesh: tool.stl\noffsets: [10 mm, 20 mm]\n"); }

  /// `set` holds field: value lines, as a sweep does, in a folder of its own.
  Config read(const std::string& scene, const std::string& set) {
    const std::string file = folder_.put("scene.yaml", scene);
    std::vector<YamlSetting> settings;
    if (!set.empty())
      for (const auto& [field, value] : YamlValue::from_text(set, "sweep.yaml", "/sweeps").entries())
        settings.push_back({field.scalar(), value});
    Config config;
    read_yaml_file(file, settings, [&](ConfigVisitor& v) { config.visit(v); });
    return config;
  }

  std::string error_of(const std::string& scene, const std::string& set) {
    try {
      read(scene, set);
    } catch (const SpecError& error) {
      return error.what();
    }
    return "no error";
  }

  TempFolder folder_;
};

TEST_F(YamlSettings, ReplaceAddAndReachIntoLists) {
  const std::string scene = "height: 1\npose: {xyz: [1, 2, 3]}\nitems: [{count: 4}, {}]\nprogram: [run, ./a, ./b]\n";
  const Config c = read(scene, "height: 250 mm\npose.xyz[2]: 700 mm\nitems[1].count: 9\nprogram[1]: ./other\n");
  EXPECT_DOUBLE_EQ(c.height, 0.25);
  EXPECT_TRUE(c.pose.translation().isApprox(Eigen::Vector3d(1, 2, 0.7), 1e-15));
  EXPECT_EQ(c.items.at(0).count, 4);
  EXPECT_EQ(c.items.at(1).count, 9);
  EXPECT_EQ(c.program.at(1), "/sweeps/other");  // relative to the file that names it
  EXPECT_EQ(c.program.at(2), folder_.at("b"));
  EXPECT_EQ(read("height: 1\n", "tool.length: 5 mm\n").tool.length, 0.005);  // a section that the scene does not have
  EXPECT_EQ(read("items: []\n", "items: [{count: 2}, {count: 3}]\n").items.at(1).count, 3);
}

TEST_F(YamlSettings, TheFileThatStandsInTheWayIsOpened) {
  for (const std::string scene :
       {"tool: tool.yaml\n", "tool: {base: tool.yaml}\n", "tool: {base: tool.yaml, length: 1}\n"}) {
    const Config c = read(scene, "tool.length: 400 mm\ntool.offsets[1]: 25 mm\n");
    EXPECT_DOUBLE_EQ(c.tool.length, 0.4) << scene;
    EXPECT_EQ(c.tool.offsets, (std::vector<double>{0.01, 0.025})) << scene;
    EXPECT_EQ(c.tool.mesh, folder_.at("tool.stl")) << scene;  // the file's own values keep their folder
  }
  const Config c = read("tool: tool.yaml\n", "tool.mesh: new.stl\n");
  EXPECT_EQ(c.tool.mesh, "/sweeps/new.stl");
  EXPECT_DOUBLE_EQ(c.tool.length, 0.3);
}

TEST_F(YamlSettings, WithoutAnyTheFileIsReadAsItIs) {
  const Config c = read("height: 2\ntool: tool.yaml\n", "");
  EXPECT_EQ(c.height, 2);
  EXPECT_DOUBLE_EQ(c.tool.length, 0.3);
}

TEST_F(YamlSettings, AMessageNamesTheLineOfWhatIsWrong) {
  EXPECT_EQ(error_of("height: 1\n", "\nhight: 5 mm\n"), "sweep.yaml:2: hight: unknown key, did you mean height?");
  EXPECT_THAT(error_of("height: 1\n", "tool.lenght: 5 mm\n"), StartsWith("sweep.yaml:1: tool.lenght: unknown key"));
  EXPECT_THAT(error_of("height: 1\n", "height: 5 deg\n"), StartsWith("sweep.yaml:1: height: "));
  EXPECT_THAT(error_of("pose: {xyz: [1, 2, 3]}\n", "pose.xyz[1]: far\n"), StartsWith("sweep.yaml:1: pose.xyz: "));
  EXPECT_THAT(error_of("pose: {xyz: [1, 2, 3]}\n", "pose.xyz[3]: 1\n"), HasSubstr("has 3 items, counted from 0"));
  EXPECT_THAT(error_of("height: 1\n", "items[0].count: 1\n"),
              HasSubstr("sweep.yaml:1: items[0].count: there is no list"));
  EXPECT_THAT(error_of("height: 1\n", "height.of: 1\n"), HasSubstr("neither a mapping nor a file"));
  EXPECT_THAT(error_of("tool: tool.yaml\n", "tool.offsets.x: 1\n"), HasSubstr("tool.offsets is not a mapping"));
  for (const char* path : {"a..b", "a[", "a[x]", "a[1", "a[1]b", "a[-1]", "\"\"", "\"[1]\""})
    EXPECT_THAT(error_of("height: 1\n", std::string(path) + ": 1\n"), HasSubstr("is not the path of a field")) << path;
  EXPECT_THAT(error_of("hight: 1\n", "height: 1\n"), HasSubstr("scene.yaml:1: hight: unknown key"));
}

TEST(YamlValue, ShowsWhatAFileHolds) {
  const YamlValue root = YamlValue::from_text("a: [1 mm, {x: 2}]\nb: word\n", "f.yaml", "");
  ASSERT_TRUE(root.is_mapping());
  const auto entries = root.entries();
  ASSERT_EQ(entries.size(), 2u);
  EXPECT_EQ(entries[0].first.scalar(), "a");
  EXPECT_EQ(entries[0].second.text(), "[1 mm, {x: 2}]");
  EXPECT_EQ(entries[0].second.items().at(0).scalar(), "1 mm");
  EXPECT_EQ(entries[1].second.place(), "f.yaml:2");
  EXPECT_EQ(entries[1].second.with_text("other").scalar(), "other");
  EXPECT_EQ(entries[1].second.with_text("other").place(), "f.yaml:2");
  EXPECT_THROW(entries[0].second.scalar(), SpecError);
  EXPECT_THROW(entries[1].second.items(), SpecError);
  EXPECT_THROW(entries[1].second.entries(), SpecError);
  std::string b;
  root.visit([&](ConfigVisitor& v) { v.field("b", b, "b"); }, {"a"});
  EXPECT_EQ(b, "word");
  EXPECT_THROW(root.visit([&](ConfigVisitor& v) { v.field("b", b, "b"); }), SpecError);
}

}  // namespace
}  // namespace binpick

#include "core/yaml.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "core/quantity.hpp"

namespace binpick {
namespace {

using testing::AllOf;
using testing::HasSubstr;

struct Inner {
  double height = 0.4;
  void visit(ConfigVisitor& v) { v.field("height", height, Unit::kLength, "how high"); }
};

struct Config {
  int count = 3;
  bool on = false;
  double angle = 0;
  std::string name = "x", kind = "a", file;
  Eigen::Vector3d size = {1, 2, 3};
  Pose X_AB = Pose::Identity();
  Inner drop;
  std::vector<Inner> items;
  void visit(ConfigVisitor& v) {
    v.field("count", count, "how many");
    v.field("on", on, "switch");
    v.field("angle", angle, Unit::kAngle, "turn");
    v.field("name", name, "name");
    v.choice("kind", kind, {"alpha", "beta", "a"}, "kind");
    v.path("file", file, "file");
    v.field("size", size, Unit::kLength, "size");
    v.field("pose", X_AB, "pose");
    v.section("drop", drop, "drop");
    v.list("items", items, "items");
  }
};

Config read(const std::string& text) {
  Config config;
  read_yaml_text(text, "scene.yaml", "/base", [&](ConfigVisitor& v) { config.visit(v); });
  return config;
}

std::string error_of(const std::string& text) {
  try {
    read(text);
  } catch (const SpecError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Yaml, ReadsUnitsSectionsListsPathsAndPoses) {
  const Config c = read(
      "count: 7\non: true\nangle: 90 deg\nkind: beta\nfile: ../p/x.stl\nsize: [10 mm, 0.2, 3 cm]\n"
      "pose: {xyz: [1, 2, 3], rpy: [0, 0, 180 deg]}\ndrop: {height: 250 mm}\nitems:\n- height: 1\n- {}\n");
  EXPECT_EQ(c.count, 7);
  EXPECT_TRUE(c.on);
  EXPECT_NEAR(c.angle, 1.5707963267948966, 1e-15);
  EXPECT_EQ(c.kind, "beta");
  EXPECT_EQ(c.file, "/p/x.stl");
  EXPECT_TRUE(c.size.isApprox(Eigen::Vector3d(0.01, 0.2, 0.03), 1e-15));
  EXPECT_NEAR((c.X_AB * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(0, 2, 3)).norm(), 0, 1e-12);
  EXPECT_DOUBLE_EQ(c.drop.height, 0.25);
  ASSERT_EQ(c.items.size(), 2u);
  EXPECT_EQ(c.items[0].height, 1);
  EXPECT_EQ(c.items[1].height, 0.4);
}

TEST(Yaml, WhatIsWrittenReadsBackToTheSameText) {
  Config c = read("angle: 12.3 deg\nfile: a/b.stl\npose: {rpy: [10 deg, 20 deg, 30 deg]}\nitems: [{height: 0.1}]\n");
  const auto body = [&](ConfigVisitor& v) { c.visit(v); };
  const std::string text = write_yaml(body, "/base");
  EXPECT_THAT(text, HasSubstr("file: a/b.stl"));
  Config again = read(text);
  EXPECT_EQ(again.X_AB.matrix(), c.X_AB.matrix());
  EXPECT_EQ(write_yaml([&](ConfigVisitor& v) { again.visit(v); }, "/base"), text);
}

struct BadCase {
  const char* text;
  std::vector<const char*> said;
};

class BadYaml : public testing::TestWithParam<BadCase> {};

TEST_P(BadYaml, IsOneClearLine) {
  const std::string message = error_of(GetParam().text);
  EXPECT_THAT(message, HasSubstr("scene.yaml"));
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  for (const char* part : GetParam().said) EXPECT_THAT(message, HasSubstr(part));
}

INSTANTIATE_TEST_SUITE_P(
    Table, BadYaml,
    testing::Values(BadCase{"count: 1\ncuont: 2\n", {":2: cuont: unknown key", "did you mean count"}},
                    BadCase{"drop:\n  hieght: 1\n", {":2: drop.hieght: unknown key", "drop.height"}},
                    BadCase{"items:\n- heigt: 1\n", {":2: items[0].heigt", "height"}},
                    BadCase{"count: 1\ncount: 2\n", {":2: count: key appears twice"}},
                    BadCase{"count: three\n", {":1: count", "'three' is not a whole number"}},
                    BadCase{"count: 1.5\n", {"not a whole number"}},
                    BadCase{"count: 99999999999999999999\n", {"not a whole number"}},
                    BadCase{"angle: 5 mm\n", {":1: angle", "unit 'mm' does not fit", "deg"}},
                    BadCase{"angle: nan\n", {"finite"}}, BadCase{"angle: 1e999\n", {"finite"}},
                    BadCase{"angle: 0,5\n", {"angle"}}, BadCase{"on: yes\n", {"true or false"}},
                    BadCase{"kind: alhpa\n", {":1: kind", "did you mean alpha"}},
                    BadCase{"size: [1, 2]\n", {":1: size", "three numbers, has 2"}}, BadCase{"size: 4\n", {"list"}},
                    BadCase{"drop: 4\n", {"drop", "mapping"}}, BadCase{"items: {a: 1}\n", {"list"}},
                    BadCase{"items: [3]\n", {"mapping"}}, BadCase{"count: [1]\n", {"single value"}},
                    BadCase{"file: \"\"\n", {"file", "empty"}}, BadCase{"", {"empty"}},
                    BadCase{"- 1\n", {"key: value"}}, BadCase{"count: 1\n---\ncount: 2\n", {"more than one document"}},
                    BadCase{"a: &x [1]\nb: *x\n", {":1", "anchors"}}, BadCase{"count: [\n", {"scene.yaml"}},
                    BadCase{"\tcount: 1\n", {"scene.yaml:1"}},
                    // What fuzzing found (docs/fuzzing.md): quoted texts that broke the line, a parser without end.
                    BadCase{"count: 1\n\"cou\\nnt\": 2\n", {":2: cou?nt: unknown key", "count"}},
                    BadCase{"\"a\\nb\": 1\n\"a\\nb\": 2\n", {":2: a?b: key appears twice"}},
                    BadCase{"kind: \"al\\npha\"\n", {":1: kind: holds a control character"}},
                    BadCase{"file: \"a\\0b\"\n", {":1: file: holds a control character"}},
                    BadCase{"count: 1\n# gr\xfc\xdf\n", {":2: holds a byte that is no text in UTF-8"}},
                    BadCase{"count: 1\x04\n", {":1: holds a byte that is no text"}},
                    BadCase{",l\xff\x06# Flat\xff ", {":1: holds a byte that is no text"}},
                    BadCase{"pose: {xyz: [a, 0, 0]}\n", {"pose.xyz", "'a'"}}));

TEST(Yaml, NestedTooDeepIsRefused) { EXPECT_THAT(error_of("a: " + std::string(3000, '[')), HasSubstr("scene.yaml")); }

TEST(Yaml, MissingFileIsNamed) {
  try {
    read_config_file<Inner>("/nonexistent/scene.yaml");
    FAIL() << "a missing file was read";
  } catch (const SpecError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("/nonexistent/scene.yaml"), HasSubstr("No such file")));
  }
}

TEST(Quantity, UnitsAndShortestText) {
  EXPECT_EQ(parse_quantity("5 mm", Unit::kLength), 0.005);
  EXPECT_EQ(parse_quantity("  -2.5e1cm ", Unit::kLength), -0.25);
  EXPECT_EQ(parse_quantity("250ms", Unit::kTime), 0.25);
  EXPECT_EQ(parse_quantity("60 kPa", Unit::kPressure), 60e3);
  EXPECT_EQ(parse_quantity("+3", Unit::kNone), 3);
  EXPECT_THROW(parse_quantity("3 kg", Unit::kNone), SpecError);
  EXPECT_THROW(parse_quantity("", Unit::kLength), SpecError);
  EXPECT_EQ(format_double(0.1), "0.1");
  EXPECT_EQ(parse_quantity(format_double(1.0 / 3), Unit::kNone), 1.0 / 3);
}

TEST(NearestName, FindsNeighboursAndGivesUpOnStrangers) {
  EXPECT_EQ(nearest_name("cont", {"count", "height"}), "count");
  EXPECT_EQ(nearest_name("zzzzzz", {"count", "height"}), "");
  EXPECT_EQ(nearest_name("d435", {"kinect_v1", "d435_848", "d435_1280"}), "d435_848");    // the beginning of a name
  EXPECT_EQ(nearest_name("d345", {"kinect_v1", "d435_848", "d435_848_out_of_box"}), "");  // two letters of four differ
  EXPECT_EQ(nearest_name("k", {"kinect_v1"}), "");
}

}  // namespace
}  // namespace binpick

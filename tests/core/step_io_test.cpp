#include "core/step_io.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "core/error.hpp"
#include "core/mesh_io.hpp"
#include "core/mesh_properties.hpp"
#include "core/random.hpp"
#include "mesh_samples.hpp"
#include "temp_folder.hpp"

#ifdef BINPICK_WITH_STEP

namespace binpick {
namespace {

using samples::with;
using testing::HasSubstr;

void expect_size(const TriangleMesh& mesh, double scale) {
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_LT((bounding_box(mesh).sizes() - scale * Eigen::Vector3d(0.064, 0.06, 0.016)).norm(), 1e-9 * scale);
  const double volume = (64 * 20 + 20 * 40) * 16e-9 * scale * scale * scale;
  EXPECT_NEAR(mass_properties(mesh, 1).volume, volume, 1e-9 * volume);
}

TEST(StepIo, HonoursTheUnitOfTheFile) {
  const TempFolder folder;
  expect_size(read_mesh(folder.put("mm.step", samples::step())), 1);
  expect_size(read_mesh(folder.put("cm.step", samples::step_in("SI_UNIT(.CENTI.,.METRE.)"))), 10);
  expect_size(read_mesh(folder.put("inch.stp", samples::step_in("inch"))), 25.4);
  expect_size(read_step(folder.put("m.step", samples::step_in("SI_UNIT($,.METRE.)")), 1e-4), 1000);
  expect_size(read_mesh(folder.at("mm.step")), 1);           // nothing is left behind by the others
  EXPECT_THROW(read_mesh(folder.at("m.step")), AssetError);  // a part of 64 m
  EXPECT_THROW(read_mesh(folder.at("mm.step"), {"mm", 1e-4}), AssetError);
}

// The bearing's outer surface is at radius 50 mm, its faces at z = +-8 mm, its bore at 35 mm.
TEST(StepIo, FacetsStayWithinTheChordTolerance) {
  const std::string path = std::string(BINPICK_SOURCE_DIR) + "/assets/parts/bearing_6914/bearing_6914.step";
  std::size_t triangles = 0;
  for (const double chord : {4e-4, 2e-4, 1e-4, 5e-5}) {
    const TriangleMesh mesh = read_step(path, chord);
    const MeshQuery query(mesh);
    EXPECT_GT(mesh.triangles.size(), triangles) << chord;
    triangles = mesh.triangles.size();
    double worst = 0;
    for (int i = 0; i < 1000; ++i) {
      const double angle = 2 * std::numbers::pi * i / 1000;
      const Eigen::Vector3d outward(std::cos(angle), std::sin(angle), 0);
      const auto outside = query.ray(0.06 * outward, -outward, 1);
      const auto bore = query.ray({0, 0, 0}, outward, 1);
      ASSERT_TRUE(outside && bore);
      worst = std::max({worst, std::abs(outside->distance - 0.01), std::abs(bore->distance - 0.035)});
    }
    EXPECT_LE(worst, chord);
    EXPECT_GT(worst, chord / 20) << "finer than asked for by far";
  }
}

struct BadStep {
  const char* name;
  std::string bytes;
  const char* says;
};

TEST(StepIo, BadFilesAreRefusedInOneLine) {
  const std::string good = samples::step();
  const std::string frame = "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n";
  const std::size_t data = good.find("DATA;") + 6;
  const std::string tail = "ENDSEC;\nEND-ISO-10303-21;\n";
  const std::vector<BadStep> cases = {
      {"empty", "", "empty"},
      {"one byte", "I", "does not start with"},
      {"garbage", std::string(5000, '\xa5'), "does not start with"},
      {"cut in the header", good.substr(0, 100), "truncated"},
      {"cut in the data", good.substr(0, good.size() / 2), "truncated"},
      {"cut before its last line", good.substr(0, good.rfind("END-ISO")), "truncated"},
      {"no entities", frame, ""},
      {"half of the entities", good.substr(0, good.find("\n#", good.size() / 2)) + "\n" + tail, ""},
      {"text for data", good.substr(0, data) + std::string(300, 'x') + "\n" + tail, ""},
      {"zero bytes for data", good.substr(0, data) + std::string(300, '\0') + "\n" + tail, ""},
      {"a reference to nothing", with(good, "MANIFOLD_SOLID_BREP('',#", "MANIFOLD_SOLID_BREP('',#99999"), ""},
      {"a reference to itself", with(good, "#15 = MANIFOLD_SOLID_BREP('',#16)", "#15 = MANIFOLD_SOLID_BREP('',#15)"),
       ""},
      {"an overflowing coordinate", with(good, "CARTESIAN_POINT('',(-32.", "CARTESIAN_POINT('',(1.E999,-32."), ""},
  };
  const TempFolder folder;
  for (const BadStep& bad : cases) {
    SCOPED_TRACE(bad.name);
    ASSERT_NE(bad.bytes.rfind("sample does not hold", 0), 0u) << bad.bytes;
    const std::string path = folder.put("a.step", bad.bytes);
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    try {
      read_mesh(path);
      ADD_FAILURE() << "accepted";
    } catch (const AssetError& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.rfind(path, 0), 0u) << message;
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      EXPECT_THAT(message, HasSubstr(bad.says));
    }
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  }
}

}  // namespace
}  // namespace binpick

#endif

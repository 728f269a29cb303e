// binpick bench suction: physics lets go where statics says, on one row of the table.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/file_io.hpp"
#include "run_program.hpp"

namespace binpick {
namespace {

TEST(BenchSuction, TwoCupsHoldUntilTheLiftThatStaticsSays) {
  const TemporaryFolder folder;
  const ProgramRun run =
      run_program("bench suction --draws 4 --diameters 0.008 --cups 2 --vacuums 60000 --json " + folder.path("t.json"));
  ASSERT_EQ(run.code, 0) << run.err;
  const nlohmann::json table = nlohmann::json::parse(read_file(folder.path("t.json")));
  const auto& cells = table.at("cells");
  ASSERT_EQ(cells.size(), 5u);  // accelerations, rising
  for (std::size_t i = 0; i < cells.size(); ++i) {
    EXPECT_EQ(cells[i].at("sealed"), 4) << i;  // 8 mm cups, 1 mm off, on a land of 15 mm
    if (i > 0) {
      EXPECT_LE(cells[i].at("held"), cells[i - 1].at("held")) << i;
    }
  }
  // Full vacuum on both cups: 60 kPa x 2 x 50 mm^2 = 6.0 N, less moments; the bearing's weight is 1.7 N at rest,
  // 2.1 N at 2.5 and 8.6 N at 40 m/s^2.
  EXPECT_EQ(cells.front().at("held"), 4);
  EXPECT_EQ(cells.back().at("held"), 0);
  ASSERT_EQ(table.at("limits").size(), 1u);
  const auto& limit = table.at("limits")[0];
  EXPECT_NEAR(limit.at("measured").get<double>(), 6.03 / 0.173 - 9.81, 0.5);
  EXPECT_NEAR(limit.at("measured").get<double>(), limit.at("theory").get<double>(), 0.2);
}

TEST(BenchSuction, CupsThatNoOneMakesAreRefused) {
  EXPECT_EQ(run_program("bench suction --diameters 5").code, 2);
  EXPECT_EQ(run_program("bench suction --cups 0").code, 2);
}

}  // namespace
}  // namespace binpick

// Curves on disk: the table, the script, and what happens with and without gnuplot.
#include "tools/validate/plot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <cstdlib>
#include <filesystem>
#include <limits>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "tests/tools/run_program.hpp"

namespace binpick {
namespace {

namespace fs = std::filesystem;

CurveTable example() {
  CurveTable table("curve,x,y");
  table.add("one", {1, 0.25});
  table.add("one", {2, std::numeric_limits<double>::quiet_NaN()});
  return table;
}

const char* const kCommands = "plot file using (curve('one', 2)):3 with points\n";

TEST(Plot, TheTableHasAHeaderAndLeavesOutWhatIsNotANumber) {
  EXPECT_EQ(example().csv(), "curve,x,y\none,1,0.25\none,2,\n");
}

TEST(Plot, WithoutGnuplotDataAndScriptStay) {
  const TemporaryFolder folder;
  write_plot(folder.path(), "p", example(), kCommands);
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", "/nonexistent", 1);
  const bool drawn = draw_plots(folder.path(), {"p"});
  ::setenv("PATH", path.c_str(), 1);
  EXPECT_FALSE(drawn);
  EXPECT_EQ(read_file(folder.path("p.csv")), example().csv());
  EXPECT_THAT(read_file(folder.path("p.gp")), testing::HasSubstr("set output 'p.png'"));
  EXPECT_FALSE(fs::exists(folder.path("gnuplot.log")));
}

TEST(Plot, WithGnuplotThereIsAPicture) {
  const TemporaryFolder folder;
  for (const std::string name : {"p", "q"}) write_plot(folder.path(), name, example(), kCommands);
  ASSERT_TRUE(draw_plots(folder.path(), {"p", "q"})) << "gnuplot is missing: tools/setup installs it";
  for (const std::string name : {"p.png", "q.png"}) EXPECT_EQ(read_file(folder.path(name)).substr(1, 3), "PNG") << name;
  EXPECT_FALSE(fs::exists(folder.path("gnuplot.log")));
  write_plot(folder.path(), "bad", example(), "plot nothing that exists\n");
  EXPECT_THROW(draw_plots(folder.path(), {"bad"}), StorageError);
}

TEST(Plot, AFolderThatIsNotThereIsAStorageError) {
  EXPECT_THROW(write_plot("/nonexistent/folder", "p", example(), kCommands), StorageError);
}

}  // namespace
}  // namespace binpick

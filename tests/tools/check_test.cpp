// binpick check: what it says of a scene's arm, and the picture of its reach.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/file_io.hpp"
#include "tests/tools/run_program.hpp"

namespace binpick {
namespace {

using testing::HasSubstr;

class Check : public testing::Test {
 protected:
  std::string scene(const std::string& cell) const {
    const std::string root = BINPICK_SOURCE_DIR, file = folder_.path(cell + ".yaml");
    write_file(file, "part: " + root + "/assets/parts/bearing_6914/part.yaml\ncount: 1\ncell: " + root +
                         "/assets/cells/" + cell + ".yaml\nsensor: {type: ideal}\nestimator: {type: oracle}\n");
    return file;
  }
  TemporaryFolder folder_;
};

TEST_F(Check, SaysHowTheArmIsSolvedAndDrawsItsReach) {
  const ProgramRun ur = run_program("check " + scene("ur5e") + " --png " + folder_.path("reach.png"));
  ASSERT_EQ(ur.code, 0) << ur.err;
  EXPECT_THAT(ur.out, HasSubstr("numeric (axes of joints 3 and 4 are not perpendicular)"));
  EXPECT_THAT(ur.out, HasSubstr("over the bin 8 branches"));
  EXPECT_THAT(ur.out, HasSubstr("% within reach"));
  EXPECT_EQ(read_file(folder_.path("reach.png")).substr(1, 3), "PNG");
  const ProgramRun kuka = run_program("check " + scene("kr6_r900"));
  EXPECT_THAT(kuka.out, HasSubstr("inverse kinematics in closed form\n"));
}

TEST_F(Check, APictureIsOfOneScene) {
  const std::string part = std::string(BINPICK_SOURCE_DIR) + "/assets/parts/tee/part.yaml";
  EXPECT_EQ(run_program("check " + part + " --png " + folder_.path("a.png")).code, 2);
  const ProgramRun two = run_program("check " + part + " " + part + " --png " + folder_.path("a.png"));
  EXPECT_EQ(two.code, 2);
  EXPECT_THAT(two.err, HasSubstr("--png: takes one scene, not 2"));
}

}  // namespace
}  // namespace binpick

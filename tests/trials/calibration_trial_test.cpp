// The chain and hand-eye calibration in a cell as drawn are exact; single errors do what geometry says.
#include "trials/calibration/calibration_trial.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "trials/calibration/plate_images.hpp"
#include "trials/scenario.hpp"

namespace binpick {
namespace {

class CalibrationTrial : public testing::Test {
 protected:
  Scenario scenario = read_scenario(std::string(BINPICK_SOURCE_DIR) + "/scenes/bearing_bin.yaml", {"ideal"});
  CalibrationSetup setup = calibration_setup(scenario.cell, {15});
  CalibrationSetup projected() const {
    CalibrationSetup same = setup;
    same.images = nullptr;
    return same;
  }
};

TEST_F(CalibrationTrial, WithoutErrorsEveryMethodIsExact) {
  for (const CalibrationMethod method : kCalibrationMethods) {
    const CalibrationError e = calibration_error(setup, no_errors(), method, Seed{1});
    EXPECT_LT(e.shift, 1e-9) << to_string(method);
    EXPECT_LT(e.turn, 1e-9) << to_string(method);
    EXPECT_LT(e.tip, 1e-8) << to_string(method);
  }
}

// Corners found in rendered images in a cell as drawn: off by their noise, and by no more than a few times that of the
// stated 0.2 px.
TEST_F(CalibrationTrial, FindsTheCameraFromRenderedImages) {
  setup = calibration_setup(scenario.cell, {6});
  setup.images = std::make_shared<const PlateImages>(setup.plate);
  CalibrationErrors stated = no_errors();
  stated.corner = 0.2;
  for (const CalibrationMethod method : {CalibrationMethod::kChain, CalibrationMethod::kPark}) {
    const CalibrationError e = calibration_error(setup, no_errors(), method, Seed{1});
    const double expected = predicted_error(projected(), stated, method).shift;
    EXPECT_GT(e.shift, 0.01 * expected) << to_string(method) << ": images are never exact";
    EXPECT_LT(e.shift, 4 * expected) << to_string(method);
  }
  const auto shift = [&](std::uint64_t seed) {
    return calibration_error(setup, no_errors(), CalibrationMethod::kChain, Seed{seed}).shift;
  };
  EXPECT_NE(shift(2), shift(1)) << "noise of their own";
}

TEST_F(CalibrationTrial, AShiftedPlateShiftsTheChainsCameraByAsMuchAndHandEyeNotAtAll) {
  CalibrationErrors errors = no_errors();
  errors.plate_shift = 1e-3;
  const Normals ones = [] { return 1.0; };
  const CalibrationError chain = calibration_error(setup, errors, CalibrationMethod::kChain, ones);
  EXPECT_NEAR(chain.shift, std::sqrt(3.0) * 1e-3, 1e-8);
  EXPECT_LT(chain.turn, 1e-8);
  EXPECT_LT(calibration_error(setup, errors, CalibrationMethod::kPark, ones).shift, 1e-8);
}

TEST_F(CalibrationTrial, DepthBiasIsThePicksAlone) {
  CalibrationErrors errors = no_errors();
  errors.disparity_bias = 0.3;
  const CalibrationError e = calibration_error(setup, errors, CalibrationMethod::kChain, [] { return 1.0; });
  EXPECT_LT(e.shift, 1e-9);
  // dz = z^2 / (f b) per pixel of disparity of a D435 at 848 x 480: the part lies some 0.57 m below the camera.
  const double z =
      (scenario.cell.camera_pose(setup.q_look).inverse() * scenario.cell.tip_pose(setup.q_pick)).translation().z();
  EXPECT_NEAR(e.tip, 0.3 * z * z / (430.1 * 0.050), 0.02 * e.tip);
}

TEST_F(CalibrationTrial, JointsThatAreOffMoveTheTipByTheirLever) {
  CalibrationErrors errors = no_errors();
  errors.joint_offset = 1e-3;
  const BuiltArm built(*scenario.cell.arm, errors, [] { return 1.0; });
  const Vector6d q = setup.q_look, offset = Vector6d::Constant(1e-3);
  EXPECT_LT(distance_between(built.forward(q), scenario.cell.arm->forward(q + offset)), 1e-12);
  errors = no_errors();
  errors.link = 1e-3;
  int asked = 0;  // of the base alone: 6 numbers for the joints, then x of the first link
  const BuiltArm longer(*scenario.cell.arm, errors, [&asked] { return ++asked == 7 ? 1.0 : 0.0; });
  EXPECT_NEAR(distance_between(longer.forward(q), scenario.cell.arm->forward(q)), 1e-3, 1e-12);
}

TEST_F(CalibrationTrial, FirstOrderHoldsForCornerNoise) {
  const CalibrationErrors errors = only({}, ErrorSource::kCorners);
  const PredictedError predicted = predicted_error(setup, errors, CalibrationMethod::kChain);
  double squares = 0;
  constexpr int kDraws = 200;  // the root mean square is known to 5 % or better
  for (int k = 0; k < kDraws; ++k)
    squares += std::pow(calibration_error(setup, errors, CalibrationMethod::kChain, Seed{100u + k}).shift, 2) / kDraws;
  EXPECT_NEAR(std::sqrt(squares), predicted.shift, 0.2 * predicted.shift);
  EXPECT_EQ(calibration_error(setup, errors, CalibrationMethod::kPark, Seed{7}).shift,
            calibration_error(setup, errors, CalibrationMethod::kPark, Seed{7}).shift);
}

TEST_F(CalibrationTrial, ACameraThatIsNotOnTheFlangeIsRefused) {
  scenario.cell.camera.mount = "fixed";
  EXPECT_THROW(calibration_setup(scenario.cell, {15}), SpecError);
}

}  // namespace
}  // namespace binpick

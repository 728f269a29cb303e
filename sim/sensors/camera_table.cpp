// What a row rests on is said in its source. z_min of the stereo cameras is f B / 126 (a search of 126 disparities,
// librealsense issue 3039 [S]) unless published. z_max is the range of use of A3.3 (2 m for D4xx), 1 m for the D405
// (its noise is 10 mm there [D]), and for the others that of their data sheets [R]. s = 0.08 px is Intel's practical
// default [S]. Projectors (90 and 102 degrees, 29 mm from the left imager of a D435): SAPIEN [S]. Zivid and PhoXi stand
// at half their resolution, as they are often run, so that a frame costs no more than a stereo camera's.

#include "sim/sensors/camera_table.hpp"

#include <algorithm>
#include <numbers>

#include "core/check.hpp"

namespace binpick {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

PinholeCamera centred(int width, int height, double f) {
  return {width, height, f, f, 0.5 * (width - 1), 0.5 * (height - 1)};
}

}  // namespace

const std::vector<DepthCamera>& camera_table() {
  static const std::vector<DepthCamera> table = {
      {"d435_848", centred(848, 480, 430.1), 0.0501, 0.171, 2, 0.08, 0.029, 102 * kDegree,
       "SAPIEN configuration, simsense test [S]"},
      {"d435_1280", centred(1280, 720, 639.0), 0.050, 0.254, 2, 0.08, 0.029, 102 * kDegree,
       "measured intrinsics of a public repository [S]"},
      {"d415_1280", centred(1280, 720, 920), 0.055, 0.402, 2, 0.08, 0, 90 * kDegree,
       "SAPIEN configuration, librealsense issue 6104 [S]"},
      {"d405_848", centred(848, 480, 430), 0.018, 0.070, 1, 0.08, 0, 0, "f [R], published min-z table [S]"},
      {"d405_1280", centred(1280, 720, 648), 0.018, 0.100, 1, 0.08, 0, 0, "f [R], published min-z table [S]"},
      {"d455_848", centred(848, 480, 430), 0.095, 0.324, 2, 0.08, 0, 0, "[R]; z_min = f B / 126 [D]"},
      {"kinect_v1", centred(640, 480, 580), 0.075, 0.4, 4, 0, 0, 0, "noise curve of Nguyen 2012 [S]; f, B [R]"},
      {"azure_kinect", centred(640, 576, 504), 0, 0.25, 3.5, 0, 0, 0, "f [R]; noise law of BlenderProc [S]"},
      {"zivid_2", centred(972, 600, 1380), 0.110, 0.3, 1.5, 0, 0, 0,
       "half of 1944x1200, f 2760 [S]; B, sigma 0.055 mm at 0.7 m [R]"},
      {"phoxi_m", centred(1032, 772, 1150), 0.270, 0.458, 1.5, 0, 0, 0,
       "half of 2064x1544, f 2300, B, sigma 0.10 mm at 0.65 m [R]"},
  };
  return table;
}

const DepthCamera& depth_camera(std::string_view name) {
  const std::vector<DepthCamera>& table = camera_table();
  const auto row = std::find_if(table.begin(), table.end(), [&](const DepthCamera& c) { return c.name == name; });
  BP_CHECK(row != table.end());
  return *row;
}

}  // namespace binpick

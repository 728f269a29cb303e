// Dimensions of our own parts in millimetres (CAD's habit, and what the STEP files hold).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace binpick {

/// Deep-groove ball bearing 6914, sealed: bore 70, outside 100, width 16. Axis z, origin in the centre.
namespace bearing {
constexpr double kInnerRadius = 35;
constexpr double kOuterRadius = 50;
constexpr double kWidth = 16;
constexpr double kChamfer = 0.6;  ///< leaves a flat land of 35.6 .. 49.4 for cups of 10 on the pitch circle of 85
constexpr double kPitchRadius = 42.5;
constexpr int kBalls = 16;
constexpr double kBallRadius = 4.5;
constexpr double kGrooveRadius = 4.65;
constexpr double kInnerShoulder = 39.5;
constexpr double kOuterShoulder = 45.5;
constexpr double kSealThickness = 1;  ///< flush with the faces
constexpr double kCageThickness = 2.4;
constexpr double kCageWidth = 10;
constexpr double kPocket = 9.2;  ///< side of the square window of each ball
}  // namespace bearing

/// L-bracket: base plate on z = 0, upright along x = 0, origin at their outer corner. No symmetry.
namespace bracket {
constexpr double kLength = 90;  ///< x
constexpr double kWidth = 60;   ///< y
constexpr double kHeight = 60;  ///< z
constexpr double kPlate = 8;
constexpr double kBossX = 66;
constexpr double kBossY = 19;
constexpr double kBossRadius = 10;
constexpr double kBossHeight = 12;  ///< above the plate
struct Hole {
  double first, second, radius;
};
constexpr std::array<Hole, 2> kBaseHoles = {{{76, 46, 4.5}, {32, 46, 4.5}}};  ///< x, y
constexpr std::array<Hole, 1> kUprightHoles = {{{20, 38, 7}}};                ///< y, z
}  // namespace bracket

/// Flat T: bar along x, stem towards -y, extruded along z, origin in the middle of the bounding box. Symmetry: the half
/// turn about the stem (y) and nothing else.
namespace tee {
constexpr double kLength = 64;  ///< x
constexpr double kHeight = 60;  ///< y
constexpr double kThickness = 16;
constexpr double kBar = 20;   ///< y
constexpr double kStem = 20;  ///< x
}  // namespace tee

/// Hexagon bolt M24 x 80. Axis z, origin under the head in the plane that bears on the work, shank towards +z. The
/// thread is drawn as a plain cylinder of the major diameter. Symmetry: sixths of a turn about z.
namespace bolt {
constexpr double kThread = 24;  ///< diameter of the shank
constexpr double kLength = 80;  ///< under the head
constexpr double kAcrossFlats = 36;
constexpr double kHeadHeight = 15;
constexpr double kChamfer = 2;  ///< at the end of the thread
}  // namespace bolt

/// Spur gear, module 3, 24 teeth, plain bore. Axis z, origin in the centre, a tooth on x. Symmetry: 24 turns about z,
/// and upside down.
namespace gear {
constexpr double kModule = 3;
constexpr int kTeeth = 24;  ///< pitch circle 72, tip circle 78
constexpr double kPressureAngle = 20 * std::numbers::pi / 180;
constexpr double kDedendum = 1.25;  ///< modules from the pitch to the root circle
constexpr double kWidth = 20;
constexpr double kBoreRadius = 10;

/// Half the angle that a tooth fills at radius r: s / (2 r) at the pitch circle, less as the involute closes:
/// pi / (2 z) + inv(alpha) - inv(acos(rb / r)), inv(x) = tan x - x.
inline double half_tooth(double r) {
  const auto inv = [](double x) { return std::tan(x) - x; };
  const double base = 0.5 * kModule * kTeeth * std::cos(kPressureAngle);
  return std::numbers::pi / (2 * kTeeth) + inv(kPressureAngle) - inv(std::acos(std::min(1.0, base / r)));
}
}  // namespace gear

/// Plate 100 x 60 x 4 with two holes on its long axis and a slot across its middle. Origin in the centre, long side
/// along x. Symmetry: half turns about x, y and z.
namespace plate {
constexpr double kLength = 100;
constexpr double kWidth = 60;
constexpr double kThickness = 4;
constexpr double kHoleX = 34;
constexpr double kHoleRadius = 7;
constexpr double kSlotWidth = 10;   ///< x
constexpr double kSlotLength = 36;  ///< y, round ends included
}  // namespace plate

/// Stepped shaft, 35 for half of its length and 25 for the rest. Axis z, origin in the middle of the length, the thick
/// half towards -z. Symmetry: any turn about z; not upside down.
namespace shaft {
constexpr double kThick = 35;
constexpr double kThin = 25;
constexpr double kLength = 120;
constexpr double kThickLength = 60;
constexpr double kChamfer = 1;
}  // namespace shaft

}  // namespace binpick

// Dimensions of our own parts in millimetres (CAD's habit, and what the STEP files hold).
#pragma once

#include <array>

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

}  // namespace binpick

#include "tools/cad_shapes.hpp"

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRep_Builder.hxx>
#include <TopoDS_Compound.hxx>
#include <cmath>
#include <gp_Ax2.hxx>
#include <numbers>

#include "tools/cad_dimensions.hpp"
#include "tools/cad_solids.hpp"

namespace binpick {
namespace {

TopoDS_Shape rectangle_ring(double inner, double outer, double low, double high) {
  return turned(
      outline({at_radius(inner, low), at_radius(outer, low), at_radius(outer, high), at_radius(inner, high)}));
}

/// Inner or outer ring with its groove: from the corner radius `edge` over the chamfered side to the shoulder.
TopoDS_Shape race(double edge, double shoulder, double toward_balls) {
  using namespace bearing;
  const double half = kWidth / 2;
  const double inset = edge < shoulder ? edge + kChamfer : edge - kChamfer;
  const double reach = std::sqrt(kGrooveRadius * kGrooveRadius - std::pow(shoulder - kPitchRadius, 2));
  const gp_Pnt bottom = at_radius(kPitchRadius + toward_balls * kGrooveRadius, 0);
  return turned(outline({at_radius(shoulder, -reach), at_radius(shoulder, -half), at_radius(inset, -half),
                         at_radius(edge, -half + kChamfer), at_radius(edge, half - kChamfer), at_radius(inset, half),
                         at_radius(shoulder, half), at_radius(shoulder, reach)},
                        &bottom));
}

/// The frame of ball i: origin in its centre, x tangential, y along the bearing's axis, z outward.
gp_Ax2 ball_frame(int i) {
  const double angle = 2 * std::numbers::pi * i / bearing::kBalls;
  const gp_Dir outward(std::cos(angle), std::sin(angle), 0);
  const gp_Pnt center(bearing::kPitchRadius * outward.X(), bearing::kPitchRadius * outward.Y(), 0);
  return gp_Ax2(center, outward, gp_Dir(outward.Y(), -outward.X(), 0));
}

/// The room that ball i has in the cage: a square window through its wall.
TopoDS_Shape window(int i) {
  using namespace bearing;
  const gp_Ax2 frame = ball_frame(i);
  const gp_Vec shift = gp_Vec(frame.XDirection()) * (-kPocket / 2) + gp_Vec(frame.YDirection()) * (-kPocket / 2) +
                       gp_Vec(frame.Direction()) * -kCageThickness;
  const gp_Ax2 corner(frame.Location().Translated(shift), frame.Direction(), frame.XDirection());
  return BRepPrimAPI_MakeBox(corner, kPocket, kPocket, 2 * kCageThickness).Shape();
}

}  // namespace

void write_bearing_step(const std::string& path) {
  using namespace bearing;
  TopoDS_Compound all;
  BRep_Builder builder;
  builder.MakeCompound(all);
  builder.Add(all, race(kInnerRadius, kInnerShoulder, -1));
  builder.Add(all, race(kOuterRadius, kOuterShoulder, +1));
  const double half = kWidth / 2;
  builder.Add(all, rectangle_ring(kInnerShoulder, kOuterShoulder, half - kSealThickness, half));
  builder.Add(all, rectangle_ring(kInnerShoulder, kOuterShoulder, -half, -half + kSealThickness));
  TopoDS_Shape cage = rectangle_ring(kPitchRadius - kCageThickness / 2, kPitchRadius + kCageThickness / 2,
                                     -kCageWidth / 2, kCageWidth / 2);
  for (int i = 0; i < kBalls; ++i) {
    builder.Add(all, BRepPrimAPI_MakeSphere(ball_frame(i), kBallRadius).Shape());
    cage = BRepAlgoAPI_Cut(cage, window(i)).Shape();
  }
  builder.Add(all, cage);
  write_step(path, "bearing_6914", all);
}

void write_bracket_step(const std::string& path) {
  using namespace bracket;
  TopoDS_Shape body =
      BRepAlgoAPI_Fuse(box({0, 0, 0}, {kLength, kWidth, kPlate}), box({0, 0, 0}, {kPlate, kWidth, kHeight})).Shape();
  const gp_Dir up(0, 0, 1);
  body = BRepAlgoAPI_Fuse(body, cylinder({kBossX, kBossY, 0}, up, kBossRadius, kPlate + kBossHeight)).Shape();
  for (const Hole& hole : kBaseHoles) {
    body = BRepAlgoAPI_Cut(body, cylinder({hole.first, hole.second, -1}, up, hole.radius, kPlate + 2)).Shape();
  }
  const gp_Dir along(1, 0, 0);
  for (const Hole& hole : kUprightHoles) {
    body = BRepAlgoAPI_Cut(body, cylinder({-1, hole.first, hole.second}, along, hole.radius, kPlate + 2)).Shape();
  }
  write_step(path, "bracket_l", body);
}

void write_tee_step(const std::string& path) {
  using namespace tee;
  const double top = kHeight / 2;
  const double shoulder = top - kBar;
  const double x = kLength / 2;
  const double stem = kStem / 2;
  const double low = -kThickness / 2;
  const std::vector<gp_Pnt> corners = {{-x, top, low},     {-x, shoulder, low}, {-stem, shoulder, low},
                                       {-stem, -top, low}, {stem, -top, low},   {stem, shoulder, low},
                                       {x, shoulder, low}, {x, top, low}};
  write_step(path, "tee", raised(outline(corners), kThickness));
}

}  // namespace binpick

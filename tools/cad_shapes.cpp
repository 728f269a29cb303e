#include "tools/cad_shapes.hpp"

#include <APIHeaderSection_MakeHeader.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRep_Builder.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <STEPControl_Writer.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopoDS_Compound.hxx>
#include <cmath>
#include <gp_Ax1.hxx>
#include <gp_Ax2.hxx>
#include <numbers>
#include <vector>

#include "core/error.hpp"
#include "tools/cad_dimensions.hpp"

namespace binpick {
namespace {

/// One file, the same bytes each time: the time stamp and the names of the header are ours.
void write_step(const std::string& path, const std::string& name, const TopoDS_Shape& shape) {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));
  STEPControl_Writer writer;
  Interface_Static::SetCVal("write.step.unit", "MM");
  Interface_Static::SetCVal("write.step.product.name", name.c_str());
  if (writer.Transfer(shape, STEPControl_AsIs) != IFSelect_RetDone) throw StorageError(path + ": cannot make STEP");
  APIHeaderSection_MakeHeader header(writer.Model());
  header.SetName(new TCollection_HAsciiString(name.c_str()));
  header.SetTimeStamp(new TCollection_HAsciiString("2024-01-01T00:00:00"));
  if (writer.Write(path.c_str()) != IFSelect_RetDone) throw StorageError(path + ": cannot be written");
}

gp_Pnt at_radius(double r, double z) { return gp_Pnt(r, 0, z); }

/// A closed outline in the plane y = 0: straight lines between the points, and an arc from the last over `over` to the
/// first when `over` is given.
TopoDS_Face outline(const std::vector<gp_Pnt>& points, const gp_Pnt* over = nullptr) {
  BRepBuilderAPI_MakeWire wire;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) wire.Add(BRepBuilderAPI_MakeEdge(points[i], points[i + 1]));
  if (over == nullptr) {
    wire.Add(BRepBuilderAPI_MakeEdge(points.back(), points.front()));
  } else {
    wire.Add(BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(points.back(), *over, points.front()).Value()));
  }
  return BRepBuilderAPI_MakeFace(wire.Wire());
}

TopoDS_Shape turned(const TopoDS_Face& face) {
  return BRepPrimAPI_MakeRevol(face, gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1))).Shape();
}

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

TopoDS_Shape box(const gp_Pnt& low, const gp_Pnt& high) { return BRepPrimAPI_MakeBox(low, high).Shape(); }

TopoDS_Shape cylinder(const gp_Pnt& base, const gp_Dir& axis, double radius, double length) {
  return BRepPrimAPI_MakeCylinder(gp_Ax2(base, axis), radius, length).Shape();
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
  BRepBuilderAPI_MakeWire wire;
  const std::vector<gp_Pnt> corners = {{-x, top, low},     {-x, shoulder, low}, {-stem, shoulder, low},
                                       {-stem, -top, low}, {stem, -top, low},   {stem, shoulder, low},
                                       {x, shoulder, low}, {x, top, low}};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    wire.Add(BRepBuilderAPI_MakeEdge(corners[i], corners[(i + 1) % corners.size()]));
  }
  const TopoDS_Face face = BRepBuilderAPI_MakeFace(wire.Wire());
  write_step(path, "tee", BRepPrimAPI_MakePrism(face, gp_Vec(0, 0, kThickness)).Shape());
}

}  // namespace binpick

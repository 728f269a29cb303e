// Bolt, gear, plate and shaft: what lathes and mills make most.
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <GeomAPI_PointsToBSpline.hxx>
#include <Geom_BSplineCurve.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <cmath>
#include <numbers>

#include "tools/cad_dimensions.hpp"
#include "tools/cad_shapes.hpp"
#include "tools/cad_solids.hpp"

namespace binpick {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kFlankPoints = 5;  // the spline through them stays within 2 micrometres of the involute

gp_Pnt on_circle(double r, double angle, double z) { return {r * std::cos(angle), r * std::sin(angle), z}; }

/// One flank, from the base circle to the tip circle (side +1: at positive angles) or back.
TopoDS_Edge flank(double middle, double side, double base, double tip) {
  TColgp_Array1OfPnt points(1, kFlankPoints);
  for (int k = 0; k < kFlankPoints; ++k) {
    // Denser towards the base circle, where the involute bends most.
    const double share = static_cast<double>(k) / (kFlankPoints - 1);
    const double r = base + (tip - base) * share * share;
    points.SetValue(k + 1, on_circle(r, middle + side * gear::half_tooth(r), -gear::kWidth / 2));
  }
  const Handle(Geom_Curve) spline(GeomAPI_PointsToBSpline(points, 3, 8, GeomAbs_C2, 1e-4).Curve().get());
  return BRepBuilderAPI_MakeEdge(spline);
}

TopoDS_Face gear_outline() {
  using namespace gear;
  const double pitch = 0.5 * kModule * kTeeth, low = -kWidth / 2;
  const double base = pitch * std::cos(kPressureAngle), tip = pitch + kModule, root = pitch - kDedendum * kModule;
  BRepBuilderAPI_MakeWire wire;
  const auto line = [&](const gp_Pnt& a, const gp_Pnt& b) { wire.Add(BRepBuilderAPI_MakeEdge(a, b)); };
  const auto arc = [&](double r, double from, double to) {
    wire.Add(BRepBuilderAPI_MakeEdge(
        GC_MakeArcOfCircle(on_circle(r, from, low), on_circle(r, (from + to) / 2, low), on_circle(r, to, low))
            .Value()));
  };
  const double step = 2 * kPi / kTeeth, foot = half_tooth(base), land = half_tooth(tip);
  for (int i = 0; i < kTeeth; ++i) {
    const double middle = i * step;
    line(on_circle(root, middle - foot, low), on_circle(base, middle - foot, low));  // below the base circle: radial
    wire.Add(flank(middle, -1, base, tip));
    arc(tip, middle - land, middle + land);
    wire.Add(flank(middle, +1, base, tip));
    line(on_circle(base, middle + foot, low), on_circle(root, middle + foot, low));
    arc(root, middle + foot, middle + step - foot);
  }
  return BRepBuilderAPI_MakeFace(wire.Wire());
}

}  // namespace

void write_bolt_step(const std::string& path) {
  using namespace bolt;
  std::vector<gp_Pnt> corners;
  for (int k = 0; k < 6; ++k)
    corners.push_back(on_circle(kAcrossFlats / std::sqrt(3.0), (k + 0.5) * kPi / 3, -kHeadHeight));
  const double r = kThread / 2;
  const TopoDS_Shape shank =
      turned(outline({at_radius(0, -kHeadHeight / 2), at_radius(r, -kHeadHeight / 2), at_radius(r, kLength - kChamfer),
                      at_radius(r - kChamfer, kLength), at_radius(0, kLength)}));
  write_step(path, "bolt_m24x80", BRepAlgoAPI_Fuse(raised(outline(corners), kHeadHeight), shank).Shape());
}

void write_gear_step(const std::string& path) {
  using namespace gear;
  const TopoDS_Shape bore = cylinder({0, 0, -kWidth}, gp_Dir(0, 0, 1), kBoreRadius, 2 * kWidth);
  write_step(path, "gear_m3_z24", BRepAlgoAPI_Cut(raised(gear_outline(), kWidth), bore).Shape());
}

void write_plate_step(const std::string& path) {
  using namespace plate;
  const gp_Dir up(0, 0, 1);
  const double low = -kThickness, high = 2 * kThickness;
  TopoDS_Shape body = box({-kLength / 2, -kWidth / 2, -kThickness / 2}, {kLength / 2, kWidth / 2, kThickness / 2});
  for (const double side : {1.0, -1.0})
    body = BRepAlgoAPI_Cut(body, cylinder({side * kHoleX, 0, low}, up, kHoleRadius, high)).Shape();
  const double end = kSlotLength / 2 - kSlotWidth / 2;  // centre of the round end
  TopoDS_Shape slot = box({-kSlotWidth / 2, -end, low}, {kSlotWidth / 2, end, low + high});
  for (const double side : {1.0, -1.0})
    slot = BRepAlgoAPI_Fuse(slot, cylinder({0, side * end, low}, up, kSlotWidth / 2, high)).Shape();
  write_step(path, "plate_100x60", BRepAlgoAPI_Cut(body, slot).Shape());
}

void write_shaft_step(const std::string& path) {
  using namespace shaft;
  const double half = kLength / 2, thick = kThick / 2, thin = kThin / 2, step = -half + kThickLength;
  write_step(path, "shaft_25_35x120",
             turned(outline({at_radius(0, -half), at_radius(thick - kChamfer, -half),
                             at_radius(thick, -half + kChamfer), at_radius(thick, step), at_radius(thin, step),
                             at_radius(thin, half - kChamfer), at_radius(thin - kChamfer, half), at_radius(0, half)})));
}

}  // namespace binpick

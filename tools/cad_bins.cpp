#include "tools/cad_bins.hpp"

#include <BRepAlgoAPI_Common.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepPrimAPI_MakeWedge.hxx>
#include <BRep_Tool.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <cmath>
#include <gp_Ax2.hxx>
#include <numbers>

#include "tools/cad_solids.hpp"

namespace binpick {
namespace {

constexpr double kLength = 400, kWidth = 300, kHeight = 200;  // inside, at the floor and to the rim
constexpr double kWall = 4, kCorner = 25;
constexpr double kDraft = 3 * std::numbers::pi / 180;
constexpr double kFlange = 14, kFlangeHeight = 5;  // of the rim, outwards
constexpr double kRibAt = 90, kRibWidth = 10, kRibDepth = 8, kRibTop = 160;

/// A frustum about z: half lengths at its lower and upper end.
TopoDS_Shape frustum(double half_x, double half_y, double low, double high) {
  const double lean = std::tan(kDraft) * (high - low), height = high - low;
  // A wedge widens along its own y: laid so that this is z, and its z is -y.
  const gp_Ax2 frame(gp_Pnt(-half_x, half_y, low), gp_Dir(0, -1, 0), gp_Dir(1, 0, 0));
  return BRepPrimAPI_MakeWedge(frame, 2 * half_x, height, 2 * half_y, -lean, -lean, 2 * half_x + lean,
                               2 * half_y + lean)
      .Shape();
}

/// The upright edges rounded.
TopoDS_Shape rounded(const TopoDS_Shape& shape) {
  BRepFilletAPI_MakeFillet fillet(shape);
  for (TopExp_Explorer edges(shape, TopAbs_EDGE); edges.More(); edges.Next()) {
    const TopoDS_Edge edge = TopoDS::Edge(edges.Current());
    if (edge.Orientation() != TopAbs_FORWARD) continue;  // each edge is met from two faces
    const double z0 = BRep_Tool::Pnt(TopExp::FirstVertex(edge)).Z(), z1 = BRep_Tool::Pnt(TopExp::LastVertex(edge)).Z();
    if (std::abs(z1 - z0) > 1) fillet.Add(kCorner, edge);
  }
  return fillet.Shape();
}

}  // namespace

void write_tote_step(const std::string& path) {
  const double down = kWall * std::tan(kDraft);  // the outside starts below the floor, so narrower
  const double out_x = kLength / 2 + kWall / std::cos(kDraft) - down;
  const double out_y = kWidth / 2 + kWall / std::cos(kDraft) - down;
  const TopoDS_Shape outside = rounded(frustum(out_x, out_y, -kWall, kHeight));
  const double rim_x = kLength / 2 + std::tan(kDraft) * kHeight + kFlange;
  const double rim_y = kWidth / 2 + std::tan(kDraft) * kHeight + kFlange;
  const TopoDS_Shape flange = box({-rim_x, -rim_y, kHeight - kFlangeHeight}, {rim_x, rim_y, kHeight});
  const TopoDS_Shape inside = rounded(frustum(kLength / 2, kWidth / 2, 0, kHeight));
  TopoDS_Shape tote = BRepAlgoAPI_Cut(BRepAlgoAPI_Fuse(outside, flange).Shape(), inside).Shape();
  for (const double x : {-kRibAt, kRibAt})
    for (const double side : {-1.0, 1.0}) {
      const double near = side * (kWidth / 2 - kRibDepth), far = side * (kWidth / 2 + 20);
      const TopoDS_Shape rib =
          box({x - kRibWidth / 2, std::min(near, far), -kWall / 2}, {x + kRibWidth / 2, std::max(near, far), kRibTop});
      tote = BRepAlgoAPI_Fuse(tote, BRepAlgoAPI_Common(rib, outside).Shape()).Shape();
    }
  write_step(path, "tote_400x300", tote);
}

}  // namespace binpick

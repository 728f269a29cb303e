// What the drawings of our own parts are put together from: Open CASCADE solids in millimetres. Only cad_*.cpp knows
// it.
#pragma once

#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <gp_Dir.hxx>
#include <gp_Pnt.hxx>
#include <string>
#include <vector>

namespace binpick {

/// One file, the same bytes each time: the time stamp and the names of the header are ours.
void write_step(const std::string& path, const std::string& name, const TopoDS_Shape& shape);

/// A closed outline in one plane: straight lines between the points, and an arc from the last over `over` to the first
/// when `over` is given.
TopoDS_Face outline(const std::vector<gp_Pnt>& points, const gp_Pnt* over = nullptr);

/// A point of the half plane y = 0 that `turned` turns about z.
inline gp_Pnt at_radius(double r, double z) { return gp_Pnt(r, 0, z); }
TopoDS_Shape turned(const TopoDS_Face& face);

/// A face swept along z.
TopoDS_Shape raised(const TopoDS_Face& face, double height);
TopoDS_Shape box(const gp_Pnt& low, const gp_Pnt& high);
TopoDS_Shape cylinder(const gp_Pnt& base, const gp_Dir& axis, double radius, double length);

}  // namespace binpick

#include "tools/cad_solids.hpp"

#include <APIHeaderSection_MakeHeader.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <STEPControl_Writer.hxx>
#include <TCollection_HAsciiString.hxx>
#include <gp_Ax1.hxx>
#include <gp_Ax2.hxx>

#include "core/error.hpp"

namespace binpick {

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

TopoDS_Face outline(const std::vector<gp_Pnt>& points, const gp_Pnt* over) {
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

TopoDS_Shape raised(const TopoDS_Face& face, double height) {
  return BRepPrimAPI_MakePrism(face, gp_Vec(0, 0, height)).Shape();
}

TopoDS_Shape box(const gp_Pnt& low, const gp_Pnt& high) { return BRepPrimAPI_MakeBox(low, high).Shape(); }

TopoDS_Shape cylinder(const gp_Pnt& base, const gp_Dir& axis, double radius, double length) {
  return BRepPrimAPI_MakeCylinder(gp_Ax2(base, axis), radius, length).Shape();
}

}  // namespace binpick

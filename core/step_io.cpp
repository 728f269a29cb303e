#include "core/step_io.hpp"

#include "core/error.hpp"
#include "core/file_io.hpp"

#ifdef BINPICK_WITH_STEP

#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <IFSelect_WorkSession.hxx>
#include <Interface_CheckIterator.hxx>
#include <Interface_InterfaceModel.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <Poly_Triangulation.hxx>
#include <STEPControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <XSControl_WorkSession.hxx>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <sstream>
#include <string_view>

#include "core/check.hpp"
#include "core/isolated.hpp"
#include "core/mesh_properties.hpp"
#include "core/mesh_repair.hpp"

namespace binpick {
namespace {

constexpr double kMetresPerMillimetre = 0.001;
constexpr double kFacetAngle = 0.35;    // rad, between the normals at the ends of a facet: small holes stay round
constexpr double kWeldFraction = 1e-6;  // of the bounding box
constexpr unsigned kCpuSeconds = 120;   // a bearing takes 0.1 s; a damaged file may take for ever
constexpr char kGood = '+';             // first byte of the child's answer
constexpr char kBad = '-';
constexpr std::size_t kLargestFile =
    1 << 28;  // bytes; a part's model is far below, and the reader needs 20 times as much

/// A truncated file ends without its closing keyword; so does one that is no STEP file at all.
void check_frame(const std::string& bytes, const std::string& path) {
  if (bytes.empty()) throw AssetError(path + ": is empty");
  const std::size_t begin = bytes.find_first_not_of(" \t\r\n");
  if (begin == std::string::npos || bytes.compare(begin, 13, "ISO-10303-21;") != 0) {
    throw AssetError(path + ": does not start with 'ISO-10303-21;', so it is no STEP file");
  }
  const std::size_t tail = bytes.size() > 400 ? bytes.size() - 400 : 0;
  if (bytes.find("END-ISO-10303-21;", tail) == std::string::npos) {
    throw AssetError(path + ": does not end with 'END-ISO-10303-21;', so it is truncated");
  }
}

/// Entities that describe shape and length must be without fault. Others (tolerances, presentation, and the kinds that
/// this version of the library does not know) may be faulty in files of good programs and say nothing about the shape.
void check_shape_entities(const STEPControl_Reader& reader, const std::string& path) {
  const Handle(Interface_InterfaceModel) model = reader.WS()->Model();
  Interface_CheckIterator faults = reader.WS()->ModelCheckList(false);
  for (faults.Start(); faults.More(); faults.Next()) {
    if (!faults.Value()->HasFailed()) continue;
    const Standard_Integer number = faults.Number();
    const bool about_the_file = number < 1 || number > model->NbEntities();
    const std::string type = about_the_file ? "" : model->Value(number)->DynamicType()->Name();
    if (about_the_file || type.rfind("StepGeom_", 0) == 0 || type.rfind("StepShape_", 0) == 0 ||
        type.find("Unit") != std::string::npos) {
      throw AssetError(path + ": is damaged: some of its entities cannot be read");
    }
  }
}

/// The shape in millimetres, whatever the file's unit. The reader takes its target unit from a global of the library
/// that anybody in the process may have changed, so it is stated here, each time.
TopoDS_Shape read_shape(const std::string& bytes, const std::string& path) {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));  // libraries never print
  STEPControl_Reader reader;
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  std::istringstream stream(bytes);
  if (reader.ReadStream(path.c_str(), stream) != IFSelect_RetDone) {
    throw AssetError(path + ": is not a readable STEP file");
  }
  check_shape_entities(reader, path);
  reader.TransferRoots();
  const TopoDS_Shape shape = reader.OneShape();
  if (shape.IsNull()) throw AssetError(path + ": holds no shape");
  return shape;
}

void add_face(TriangleMesh& mesh, const TopoDS_Face& face, const Poly_Triangulation& facets,
              const TopLoc_Location& at) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const gp_Trsf& placement = at.Transformation();
  for (Standard_Integer i = 1; i <= facets.NbNodes(); ++i) {
    const gp_Pnt p = facets.Node(i).Transformed(placement);
    mesh.vertices.emplace_back(Eigen::Vector3d(p.X(), p.Y(), p.Z()) * kMetresPerMillimetre);
  }
  // A reversed face shows its back, and so does a mirrored placement.
  const bool turn = (face.Orientation() == TopAbs_REVERSED) != placement.IsNegative();
  for (Standard_Integer i = 1; i <= facets.NbTriangles(); ++i) {
    Standard_Integer corner[3];
    facets.Triangle(i).Get(corner[0], corner[1], corner[2]);
    if (turn) std::swap(corner[1], corner[2]);
    const auto index = [&](int k) { return first + static_cast<std::uint32_t>(corner[k] - 1); };
    mesh.triangles.push_back({index(0), index(1), index(2)});
  }
}

TriangleMesh facets_of(const TopoDS_Shape& shape, double chord_tolerance, const std::string& path) {
  const BRepMesh_IncrementalMesh mesher(shape, chord_tolerance / kMetresPerMillimetre, Standard_False, kFacetAngle);
  TriangleMesh mesh;
  std::size_t faces = 0;
  std::size_t failed = 0;
  for (TopExp_Explorer explorer(shape, TopAbs_FACE); explorer.More(); explorer.Next()) {
    const TopoDS_Face& face = TopoDS::Face(explorer.Current());
    TopLoc_Location location;
    const Handle(Poly_Triangulation)& facets = BRep_Tool::Triangulation(face, location);
    ++faces;
    if (facets.IsNull()) {
      ++failed;
    } else {
      add_face(mesh, face, *facets, location);
    }
  }
  if (faces == 0) throw AssetError(path + ": holds no faces");
  for (const Eigen::Vector3d& v : mesh.vertices) {
    if (!v.allFinite()) throw AssetError(path + ": a point of its surface is not finite");
  }
  if (!mesh.empty()) repair_mesh(mesh, kWeldFraction * bounding_box(mesh).sizes().norm());
  if (mesh.empty() || (failed > 0 && !is_closed(mesh))) {
    throw AssetError(path + ": " + std::to_string(failed) + " of its " + std::to_string(faces) +
                     " faces cannot be turned into triangles");
  }
  return mesh;
}

/// The mesh on its way between the two processes.
std::string encoded(const TriangleMesh& mesh) {
  const std::uint64_t counts[2] = {mesh.vertices.size(), mesh.triangles.size()};
  std::string bytes(reinterpret_cast<const char*>(counts), sizeof counts);
  for (const Eigen::Vector3d& v : mesh.vertices)
    bytes.append(reinterpret_cast<const char*>(v.data()), 3 * sizeof(double));
  for (const auto& t : mesh.triangles) bytes.append(reinterpret_cast<const char*>(t.data()), sizeof t);
  return bytes;
}

TriangleMesh decoded(std::string_view bytes) {
  const auto take = [&](void* to, std::size_t size) {
    BP_CHECK(bytes.size() >= size);
    std::memcpy(to, bytes.data(), size);
    bytes.remove_prefix(size);
  };
  std::uint64_t counts[2];
  take(counts, sizeof counts);
  TriangleMesh mesh;
  mesh.vertices.resize(counts[0]);
  mesh.triangles.resize(counts[1]);
  for (Eigen::Vector3d& v : mesh.vertices) take(v.data(), 3 * sizeof(double));
  for (auto& t : mesh.triangles) take(t.data(), sizeof t);
  return mesh;
}

}  // namespace

TriangleMesh read_step(const std::string& path, double chord_tolerance) {
  BP_CHECK(chord_tolerance > 0 && std::isfinite(chord_tolerance), "chord_tolerance " << chord_tolerance);
  const std::string bytes = read_file(path, kLargestFile);
  check_frame(bytes, path);
  // In a process of its own: a damaged file can crash the library, and its settings are globals.
  const std::optional<std::string> answer = run_isolated(
      [&]() -> std::string {
        try {
          return std::string(1, kGood) + encoded(facets_of(read_shape(bytes, path), chord_tolerance, path));
        } catch (const AssetError& error) {
          return std::string(1, kBad) + error.what();
        } catch (const Standard_Failure& failure) {
          return std::string(1, kBad) + path + ": the STEP reader gave up (" + failure.DynamicType()->Name() + ")";
        }
      },
      kCpuSeconds);
  if (!answer || answer->empty()) {
    throw AssetError(path + ": the STEP reader crashed on it, or took more than " + std::to_string(kCpuSeconds) + " s");
  }
  if (answer->front() != kGood) throw AssetError(answer->substr(1));
  return decoded(std::string_view(*answer).substr(1));
}

}  // namespace binpick

#else

namespace binpick {

TriangleMesh read_step(const std::string& path, double) {
  throw AssetError(path + ": this build reads no STEP files (BINPICK_WITH_STEP is off)");
}

}  // namespace binpick

#endif

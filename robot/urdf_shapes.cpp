#include "robot/urdf_shapes.hpp"

#include <urdf_model/link.h>

#include <filesystem>

#include "core/error.hpp"
#include "core/link_mesh.hpp"
#include "core/one_line.hpp"
#include "robot/urdf_pose.hpp"

namespace binpick {
namespace {

namespace fs = std::filesystem;

class ShapeReader {
 public:
  ShapeReader(const urdf::Link& link, const ArmSource& source, std::vector<std::string>& mesh_files)
      : link_(link), source_(source), mesh_files_(mesh_files) {}

  std::vector<Primitive> read(const Pose& X_OL) {
    for (const auto& collision : link_.collision_array)
      if (collision && collision->geometry) add(*collision->geometry, collision->origin, X_OL);
    // Many files draw a link and say nothing of its collisions: what is drawn is also in the way.
    if (link_.collision_array.empty())
      for (const auto& visual : link_.visual_array)
        if (visual && visual->geometry) add(*visual->geometry, visual->origin, X_OL);
    return std::move(shapes_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw AssetError(one_line(source_.urdf + ": link '" + link_.name + "' " + what));
  }

  void add(const urdf::Geometry& geometry, const urdf::Pose& origin, const Pose& X_OL) {
    const Pose X_LS = pose_of(origin);
    if (!is_rigid(X_LS, 1e-6)) fail("has a shape with an origin that is not a finite pose");
    const Pose X = X_OL * X_LS;
    switch (geometry.type) {
      case urdf::Geometry::BOX: {
        const auto& dim = dynamic_cast<const urdf::Box&>(geometry).dim;
        return add_solid(Primitive::box({dim.x, dim.y, dim.z}, X), 3);
      }
      case urdf::Geometry::CYLINDER: {
        const auto& cylinder = dynamic_cast<const urdf::Cylinder&>(geometry);
        return add_solid(Primitive::cylinder(cylinder.radius, cylinder.length, X), 2);
      }
      case urdf::Geometry::SPHERE:
        return add_solid(Primitive::sphere(dynamic_cast<const urdf::Sphere&>(geometry).radius, X), 1);
      case urdf::Geometry::MESH:
        return add_mesh(dynamic_cast<const urdf::Mesh&>(geometry), X);
    }
  }

  void add_solid(const Primitive& shape, int sizes) {
    if (!shape.size.head(sizes).allFinite() || !(shape.size.head(sizes).minCoeff() > 0))
      fail("has a shape whose size is not positive");
    shapes_.push_back(shape);
  }

  /// Meshes are metres; files drawn in mm come with a scale of 0.001.
  void add_mesh(const urdf::Mesh& mesh, const Pose& X) {
    constexpr double kLargest = 5;  // m
    const std::string file = file_of(mesh.filename);
    TriangleMesh mesh_S = read_link_mesh(file);
    Eigen::AlignedBox3d box;
    for (Eigen::Vector3d& vertex : mesh_S.vertices) {
      vertex = vertex.cwiseProduct(Eigen::Vector3d(mesh.scale.x, mesh.scale.y, mesh.scale.z));
      box.extend(vertex);
    }
    if (!(box.sizes().maxCoeff() <= kLargest))
      fail("has a mesh '" + mesh.filename + "' of " + std::to_string(box.sizes().maxCoeff()) +
           " m: URDF meshes are metres; a file in mm needs scale=\"0.001 0.001 0.001\"");
    mesh_files_.push_back(file);
    for (const Primitive& shape : boxes_around(mesh_S, X)) shapes_.push_back(shape);
  }

  /// package://name/rest: first in a folder `name` above the URDF, then in the search list. Anything else: beside the
  /// URDF. Nothing outside these folders is opened.
  std::string file_of(const std::string& name) const {
    std::string rest = name;
    std::vector<fs::path> roots;
    const std::size_t scheme = name.find("://");
    if (name.rfind("package://", 0) == 0 || name.rfind("model://", 0) == 0) {
      const std::size_t begin = scheme + 3, slash = name.find('/', begin);
      roots = package_roots(name.substr(begin, slash - begin));
      rest = slash == std::string::npos ? "" : name.substr(slash + 1);
    } else {
      roots = {urdf_folder()};
      if (name.rfind("file://", 0) == 0) rest = name.substr(7);
    }
    std::string tried;
    for (const fs::path& root : roots) {
      const fs::path file = (root / rest).lexically_normal();
      const fs::path inside = file.lexically_relative(root);
      if (inside.empty() || *inside.begin() == "..")
        fail("names a mesh '" + name + "' that leaves the folder of the URDF or of its package");
      if (fs::is_regular_file(file)) return file.string();
      tried += (tried.empty() ? "; looked for " : ", ") + file.string();
    }
    if (roots.empty())
      fail("names a mesh '" + name + "', but no folder of that package lies above the URDF or in the search list" +
           " (arm_packages of the cell, " + std::to_string(source_.packages.size()) + " folders)");
    fail("names a mesh file '" + name + "' that does not exist" + tried);
  }

  fs::path urdf_folder() const { return fs::absolute(source_.urdf).lexically_normal().parent_path(); }

  std::vector<fs::path> package_roots(const std::string& package) const {
    std::vector<fs::path> roots;
    for (fs::path folder = urdf_folder(); folder.has_relative_path(); folder = folder.parent_path())
      if (folder.filename() == package) roots.push_back(folder);
    for (const std::string& listed : source_.packages) {
      fs::path folder = fs::absolute(listed).lexically_normal();
      if (!folder.has_filename()) folder = folder.parent_path();
      if (fs::is_directory(folder / package)) roots.push_back(folder / package);
      if (folder.filename() == package) roots.push_back(folder);
    }
    return roots;
  }

  const urdf::Link& link_;
  const ArmSource& source_;
  std::vector<std::string>& mesh_files_;
  std::vector<Primitive> shapes_;
};

}  // namespace

std::vector<Primitive> urdf_shapes(const urdf::Link& link, const Pose& X_OL, const ArmSource& source,
                                   std::vector<std::string>& mesh_files) {
  return ShapeReader(link, source, mesh_files).read(X_OL);
}

}  // namespace binpick

#include "robot/urdf_reader.hpp"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <utility>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/mesh_io.hpp"
#include "core/mesh_properties.hpp"

namespace binpick {
namespace {

namespace fs = std::filesystem;

Pose pose_of(const urdf::Pose& pose) {
  double x, y, z, w;
  pose.rotation.getQuaternion(x, y, z, w);
  Pose X = Pose::Identity();
  X.linear() = Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
  X.translation() = Eigen::Vector3d(pose.position.x, pose.position.y, pose.position.z);
  return X;
}

/// The URDF parser writes its complaints to the terminal; a library must not.
struct SilentConsole {
  SilentConsole() { console_bridge::noOutputHandler(); }
  ~SilentConsole() { console_bridge::restorePreviousOutputHandler(); }
};

class ChainReader {
 public:
  explicit ChainReader(const std::string& path) : path_(path) {}

  SerialChain read() {
    parse();
    const std::vector<urdf::LinkConstSharedPtr> links = links_to_tip();
    chain_.name = model_->getName();
    chain_.link_names[0] = links.front()->name;
    add_shapes(*links.front(), Pose::Identity());
    for (std::size_t i = 1; i < links.size(); ++i) step(*links[i]);
    if (moving_ != 6) fail("has " + std::to_string(moving_) + " revolute joints between root and tip, needs 6");
    chain_.X_6F = X_rigid_;
    return std::move(chain_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw AssetError(path_ + ": " + what); }

  void parse() {
    const std::string text = read_file(path_, std::size_t{4} << 20);
    const SilentConsole silent;
    try {
      model_ = urdf::parseURDF(text);
    } catch (const std::exception& error) {
      fail(std::string("not a readable URDF: ") + error.what());
    }
    if (!model_) fail("not a readable URDF (broken XML, or an element that is not valid)");
    if (!model_->getRoot()) fail("has no root link");
  }

  urdf::LinkConstSharedPtr tip() const {
    for (const char* name : {"flange", "tool0"})
      if (const auto link = model_->getLink(name)) return link;
    urdf::LinkConstSharedPtr leaf;
    for (const auto& [name, link] : model_->links_) {
      if (!link->child_links.empty()) continue;
      if (leaf)
        fail("has several end links ('" + leaf->name + "', '" + name + "') and none is named 'flange' or 'tool0'");
      leaf = link;
    }
    return leaf;
  }

  std::vector<urdf::LinkConstSharedPtr> links_to_tip() const {
    std::vector<urdf::LinkConstSharedPtr> links;
    for (urdf::LinkConstSharedPtr link = tip(); link; link = link->getParent()) links.insert(links.begin(), link);
    return links;
  }

  void step(const urdf::Link& link) {
    const urdf::Joint& joint = *link.parent_joint;
    const Pose X_before =
        X_rigid_ * checked(pose_of(joint.parent_to_joint_origin_transform), "joint '" + joint.name + "'");
    if (joint.type == urdf::Joint::FIXED) {
      X_rigid_ = X_before;
    } else {
      add_moving(joint, X_before);
      chain_.link_names[moving_] = link.name;
      X_rigid_ = Pose::Identity();
    }
    add_shapes(link, X_rigid_);
  }

  void add_moving(const urdf::Joint& joint, const Pose& X_before) {
    const std::string where = "joint '" + joint.name + "' ";
    if (joint.type != urdf::Joint::REVOLUTE && joint.type != urdf::Joint::CONTINUOUS)
      fail(where + "is not revolute: only arms with six revolute joints are known");
    if (joint.mimic) fail(where + "mimics another joint: only independent joints are known");
    if (moving_ == 6) fail("has more than 6 revolute joints between root and tip");
    const Eigen::Vector3d axis(joint.axis.x, joint.axis.y, joint.axis.z);
    if (!axis.allFinite() || axis.norm() < 1e-6) fail(where + "has no axis");
    chain_.X_before[moving_] = X_before;
    chain_.axes[moving_] = axis.normalized();
    chain_.limits[moving_] = limits_of(joint, where);
    ++moving_;
  }

  JointLimits limits_of(const urdf::Joint& joint, const std::string& where) const {
    if (!joint.limits) fail(where + "has no limit element");
    JointLimits limits{joint.limits->lower, joint.limits->upper, joint.limits->velocity};
    if (joint.type == urdf::Joint::CONTINUOUS) {
      limits.lower = -2 * std::numbers::pi;
      limits.upper = 2 * std::numbers::pi;
    }
    if (!std::isfinite(limits.lower) || !std::isfinite(limits.upper) || !(limits.lower < limits.upper))
      fail(where + "has limits whose lower end is not below the upper one");
    if (std::abs(limits.lower) > 20 || std::abs(limits.upper) > 20)
      fail(where + "has limits beyond three turns: URDF limits are radians");
    if (!std::isfinite(limits.speed) || !(limits.speed > 0)) fail(where + "has no positive speed limit");
    return limits;
  }

  Pose checked(const Pose& X, const std::string& where) const {
    if (!is_rigid(X, 1e-6)) fail(where + " has an origin that is not a finite pose");
    return X;
  }

  void add_shapes(const urdf::Link& link, const Pose& X_in_rigid) {
    for (const auto& collision : link.collision_array) {
      if (!collision || !collision->geometry) continue;
      const Pose X = X_in_rigid * checked(pose_of(collision->origin), "a shape of link '" + link.name + "'");
      chain_.shapes[moving_].push_back(shape_of(*collision->geometry, X, link.name));
    }
  }

  Primitive shape_of(const urdf::Geometry& geometry, const Pose& X, const std::string& link) const {
    Primitive shape;
    switch (geometry.type) {
      case urdf::Geometry::BOX: {
        const auto& dim = dynamic_cast<const urdf::Box&>(geometry).dim;
        shape = Primitive::box({dim.x, dim.y, dim.z}, X);
        break;
      }
      case urdf::Geometry::CYLINDER: {
        const auto& cylinder = dynamic_cast<const urdf::Cylinder&>(geometry);
        shape = Primitive::cylinder(cylinder.radius, cylinder.length, X);
        break;
      }
      case urdf::Geometry::SPHERE:
        shape = Primitive::sphere(dynamic_cast<const urdf::Sphere&>(geometry).radius, X);
        break;
      case urdf::Geometry::MESH:
        shape = bounding_shape(dynamic_cast<const urdf::Mesh&>(geometry), X, link);
        break;
    }
    const int used = shape.kind == Primitive::Kind::kBox ? 3 : shape.kind == Primitive::Kind::kCylinder ? 2 : 1;
    if (!shape.size.head(used).allFinite() || !(shape.size.head(used).minCoeff() > 0))
      fail("link '" + link + "' has a shape whose size is not positive");
    return shape;
  }

  /// A mesh counts as its bounding box: larger than the link, so nothing is overlooked.
  Primitive bounding_shape(const urdf::Mesh& mesh, const Pose& X, const std::string& link) const {
    const std::string file = resolved(mesh.filename, link);
    MeshReadOptions options;
    options.unit = "m";  // URDF meshes are metres
    const Eigen::AlignedBox3d box = bounding_box(read_mesh(file, options));
    const Eigen::Vector3d scale(mesh.scale.x, mesh.scale.y, mesh.scale.z);
    const Eigen::Vector3d center = box.center().cwiseProduct(scale);
    return Primitive::box(box.sizes().cwiseProduct(scale).cwiseAbs(), X * Eigen::Translation3d(center));
  }

  /// package://name/rest is looked for in a folder `name` above the URDF. Nothing outside that package is opened.
  std::string resolved(const std::string& name, const std::string& link) const {
    fs::path root = fs::absolute(path_).lexically_normal().parent_path();
    std::string rest = name;
    if (const std::string scheme = "package://"; name.rfind(scheme, 0) == 0) {
      const std::size_t slash = name.find('/', scheme.size());
      const std::string package = name.substr(scheme.size(), slash - scheme.size());
      while (root.has_relative_path() && root.filename() != package) root = root.parent_path();
      if (root.filename() != package)
        fail("link '" + link + "': no folder '" + package + "' above the URDF for mesh '" + name + "'");
      rest = slash == std::string::npos ? "" : name.substr(slash + 1);
    } else if (name.rfind("file://", 0) == 0) {
      rest = name.substr(7);
    }
    const fs::path file = (root / rest).lexically_normal();
    const fs::path inside = file.lexically_relative(root);
    if (inside.empty() || *inside.begin() == "..")
      fail("link '" + link + "': mesh '" + name + "' leaves the URDF's folder");
    if (!fs::is_regular_file(file)) fail("link '" + link + "': mesh file '" + name + "' does not exist");
    return file.string();
  }

  std::string path_;
  urdf::ModelInterfaceSharedPtr model_;
  SerialChain chain_;
  std::size_t moving_ = 0;
  Pose X_rigid_ = Pose::Identity();  ///< the current link's frame in the rigid link that carries it
};

}  // namespace

SerialChain read_urdf_chain(const std::string& path) { return ChainReader(path).read(); }

}  // namespace binpick

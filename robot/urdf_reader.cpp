#include "robot/urdf_reader.hpp"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/one_line.hpp"
#include "robot/urdf_pose.hpp"
#include "robot/urdf_shapes.hpp"

namespace binpick {
namespace {

/// The URDF parser writes its complaints to the terminal; a library must not. The last one goes into our message.
class CaughtConsole : public console_bridge::OutputHandler {
 public:
  CaughtConsole() { console_bridge::useOutputHandler(this); }
  ~CaughtConsole() override { console_bridge::restorePreviousOutputHandler(); }
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level < console_bridge::CONSOLE_BRIDGE_LOG_ERROR || text.empty()) return;
    // The innermost comes first and says most.
    if (first_.empty()) first_ = text.substr(0, text.find('\n'));
  }
  std::string complaint() const { return first_.empty() ? "" : ": " + first_; }

 private:
  std::string first_;
};

class ChainReader {
 public:
  explicit ChainReader(const ArmSource& source) : source_(source) {}

  SerialChain read() {
    parse();
    const std::vector<urdf::LinkConstSharedPtr> links = links_to_tip();
    for (const auto& link : links) on_path_.insert(link->name);
    chain_.name = model_->getName();
    chain_.flange_name = links.back()->name;
    chain_.link_names[0] = links.front()->name;
    add_shapes(*links.front(), Pose::Identity());
    for (std::size_t i = 1; i < links.size(); ++i) step(*links[i]);
    if (moving_ != 6) fail("has " + std::to_string(moving_) + " revolute joints between root and tip, needs 6");
    chain_.X_6F = X_rigid_;
    return std::move(chain_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw AssetError(one_line(source_.urdf + ": " + what)); }

  void parse() {
    const std::string text = read_file(source_.urdf, std::size_t{4} << 20);
    if (text.find("<xacro:") != std::string::npos) fail("is a xacro file: expand it first (xacro FILE > arm.urdf)");
    check_extent(text);
    const CaughtConsole console;
    try {
      model_ = urdf::parseURDF(text);
    } catch (const std::exception& error) {
      fail(std::string("not a readable URDF: ") + error.what());
    }
    if (!model_) fail("not a readable URDF (broken XML, or an element that is not valid)" + console.complaint());
    if (!model_->getRoot()) fail("has no root link");
    check_tree();
  }

  /// urdfdom asks for one root, not for a tree below it: the way up from a loop, or down into one, would not end.
  void check_tree() const {
    std::set<std::string> children;
    for (const auto& [name, joint] : model_->joints_)
      if (!children.insert(joint->child_link_name).second)
        fail("has two joints that carry link '" + joint->child_link_name + "'");
    for (const auto& [name, link] : model_->links_) {
      std::size_t above = 0;
      for (const urdf::Link* at = link.get(); at->parent_joint; at = at->getParent().get())
        if (++above > model_->links_.size()) fail("has joints that form a loop at link '" + name + "'");
    }
  }

  /// The XML parser behind urdfdom calls itself for every level and compares every attribute of an element with all
  /// others: a file of 4 MiB ends in a stack overflow or takes minutes.
  void check_extent(const std::string& text) const {
    constexpr int kMostTags = 20000, kMostAttributes = 1000;
    int tags = 0, attributes = 0;
    char last = 0;
    for (const char c : text) {
      if (c == '<' && ++tags > kMostTags) fail("has more than " + std::to_string(kMostTags) + " tags");
      if (c == '<') attributes = 0;
      attributes += c == '=' && last != '=';  // rows of them are drawn in comments
      if (attributes > kMostAttributes)
        fail("has an element of more than " + std::to_string(kMostAttributes) + " attributes");
      last = c;
    }
  }

  static int moving_joints_to(const urdf::Link& link) {
    int moving = 0;
    for (const urdf::Link* at = &link; at->parent_joint; at = at->getParent().get())
      moving += at->parent_joint->type != urdf::Joint::FIXED;
    return moving;
  }

  /// tool0 before flange: where both exist (ROS-Industrial) the first has its z out of the flange, the second its x.
  urdf::LinkConstSharedPtr tip() const {
    if (!source_.tip.empty()) {
      const auto link = model_->getLink(source_.tip);
      if (!link) fail("has no link '" + source_.tip + "' (the cell's arm_tip); its links: " + link_list());
      return link;
    }
    for (const char* name : {"tool0", "flange"})
      if (const auto link = model_->getLink(name)) return link;
    urdf::LinkConstSharedPtr leaf;
    for (const auto& [name, link] : model_->links_) {
      // Frames like `base` end short branches.
      if (!link->child_links.empty() || (leaf && moving_joints_to(*link) < moving_joints_to(*leaf))) continue;
      if (leaf && moving_joints_to(*link) == moving_joints_to(*leaf))
        fail("has several end links ('" + leaf->name + "', '" + name +
             "') and none is named 'tool0' or 'flange'; name one with arm_tip in the cell");
      leaf = link;
    }
    return leaf;
  }

  std::string link_list() const {
    std::string list;
    for (const auto& [name, link] : model_->links_) list += (list.empty() ? "" : ", ") + name;
    return list;
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
    if (moving_ == 6)
      fail("has more than 6 revolute joints between root and '" + chain_.flange_name +
           "'; name the flange's link with arm_tip in the cell");
    const Eigen::Vector3d axis(joint.axis.x, joint.axis.y, joint.axis.z);
    if (!axis.allFinite() || axis.norm() < 1e-6) fail(where + "has no axis");
    chain_.X_before[moving_] = X_before;
    chain_.axes[moving_] = axis.normalized();
    chain_.limits[moving_] = limits_of(joint, where);
    ++moving_;
  }

  JointLimits limits_of(const urdf::Joint& joint, const std::string& where) const {
    if (!joint.limits) fail(where + "has no limit element (a continuous joint needs one too: <limit velocity=../>)");
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

  /// Shapes of `link` and of all that hangs on it by fixed joints beside the path to the tip. What lies beyond the tip
  /// is a tool, which the cell describes.
  void add_shapes(const urdf::Link& link, const Pose& X_in_rigid) {
    for (const Primitive& shape : urdf_shapes(link, X_in_rigid, source_, chain_.mesh_files))
      chain_.shapes[moving_].push_back(shape);
    if (link.name == chain_.flange_name) return;
    for (const auto& child : link.child_links) {
      const urdf::Joint& joint = *child->parent_joint;
      if (joint.type != urdf::Joint::FIXED || on_path_.count(child->name)) continue;
      add_shapes(*child,
                 X_in_rigid * checked(pose_of(joint.parent_to_joint_origin_transform), "joint '" + joint.name + "'"));
    }
  }

  const ArmSource& source_;
  std::set<std::string> on_path_;  ///< names of the links from root to tip
  urdf::ModelInterfaceSharedPtr model_;
  SerialChain chain_;
  std::size_t moving_ = 0;
  Pose X_rigid_ = Pose::Identity();  ///< the current link's frame in the rigid link that carries it
};

}  // namespace

SerialChain read_urdf_chain(const ArmSource& source) { return ChainReader(source).read(); }

}  // namespace binpick

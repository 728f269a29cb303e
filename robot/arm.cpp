#include "robot/arm.hpp"

#include <algorithm>

#include "core/random.hpp"
#include "robot/numeric_ik.hpp"
#include "robot/opw_geometry.hpp"
#include "robot/urdf_reader.hpp"

namespace binpick {
namespace {

// Largest difference between the URDF's own forward kinematics and the closed form that is accepted. Our own arm agrees
// to rounding; foreign files round their right angles to four or five digits.
constexpr double kAgreement = 2e-4;

}  // namespace

Arm Arm::load(const ArmSource& source) {
  const SerialChain chain = read_urdf_chain(source);
  Arm arm;
  arm.name_ = chain.name;
  arm.flange_name_ = chain.flange_name;
  arm.mesh_files_ = chain.mesh_files;
  for (std::size_t i = 0; i < 7; ++i) {
    arm.link_names_.push_back(chain.link_names[i]);
    arm.link_shapes_.push_back(chain.shapes[i]);
  }
  for (std::size_t i = 0; i < 6; ++i) arm.joints_[i] = {chain.X_before[i], chain.axes[i]};
  arm.X_6F_ = chain.X_6F;
  arm.limits_ = chain.limits;
  arm.numeric_ = std::make_shared<const NumericIk>(chain);
  arm.find_closed_form(chain);
  return arm;
}

void Arm::find_closed_form(const SerialChain& chain) {
  opw_ = find_opw(chain, why_numeric_);
  if (!opw_) return;
  const Rng rng = Seed{}.child("robot/opw").rng();
  for (std::uint64_t trial = 0; trial < 20; ++trial) {
    Rng draw = rng.at(trial);
    Vector6d q;
    for (std::size_t i = 0; i < 6; ++i) q[static_cast<int>(i)] = draw.uniform(limits_[i].lower, limits_[i].upper);
    const Pose X_RF = opw_->X_RO * opw_forward(*opw_, to_opw(*opw_, q)) * opw_->X_EF;
    opw_error_ = std::max(opw_error_, (X_RF.matrix() - forward(q).matrix()).cwiseAbs().maxCoeff());
  }
  if (opw_error_ <= kAgreement) return;
  why_numeric_ = "the closed form misses the URDF's own kinematics by " + std::to_string(opw_error_ * 1000) + " mm";
  opw_.reset();
}

Pose Arm::forward(const Vector6d& q) const {
  Pose X = Pose::Identity();
  for (std::size_t i = 0; i < 6; ++i) X = X * joints_[i].X_before * Eigen::AngleAxisd(q[i], joints_[i].axis);
  return X * X_6F_;
}

std::vector<Pose> Arm::link_poses(const Vector6d& q) const {
  std::vector<Pose> poses = {Pose::Identity()};
  for (std::size_t i = 0; i < 6; ++i)
    poses.push_back(poses.back() * joints_[i].X_before * Eigen::AngleAxisd(q[i], joints_[i].axis));
  return poses;
}

bool Arm::within_limits(const Vector6d& q, double margin) const {
  for (std::size_t i = 0; i < 6; ++i)
    if (!(q[i] >= limits_[i].lower + margin && q[i] <= limits_[i].upper - margin)) return false;
  return true;
}

}  // namespace binpick

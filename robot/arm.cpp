#include "robot/arm.hpp"

#include "core/error.hpp"
#include "core/random.hpp"
#include "robot/opw_geometry.hpp"
#include "robot/urdf_reader.hpp"

namespace binpick {
namespace {

// Largest difference between the URDF's own forward kinematics and the closed form that is accepted. Our own arm agrees
// to rounding; foreign files round their right angles to four or five digits.
constexpr double kAgreement = 2e-4;

}  // namespace

Arm Arm::load(const std::string& urdf_path) {
  SerialChain chain = read_urdf_chain(urdf_path);
  Arm arm;
  arm.name_ = chain.name;
  for (std::size_t i = 0; i < 7; ++i) {
    arm.link_names_.push_back(chain.link_names[i]);
    arm.link_shapes_.push_back(chain.shapes[i]);
  }
  for (std::size_t i = 0; i < 6; ++i) arm.joints_[i] = {chain.X_before[i], chain.axes[i]};
  arm.X_6F_ = chain.X_6F;
  arm.limits_ = chain.limits;
  arm.opw_ = find_opw(chain, urdf_path);

  Rng rng = Seed{}.child("robot/opw").rng();
  for (int trial = 0; trial < 20; ++trial) {
    Vector6d q;
    for (std::size_t i = 0; i < 6; ++i) q[i] = rng.uniform(arm.limits_[i].lower, arm.limits_[i].upper);
    const Pose X_RF = arm.opw_.X_RO * opw_forward(arm.opw_, to_opw(arm.opw_, q)) * arm.opw_.X_EF;
    const double error = (X_RF.matrix() - arm.forward(q).matrix()).cwiseAbs().maxCoeff();
    if (error > kAgreement)
      throw AssetError(urdf_path + ": the closed-form kinematics miss the URDF's own by " +
                       std::to_string(error * 1000) + " mm");
  }
  return arm;
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

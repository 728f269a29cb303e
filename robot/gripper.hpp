// The interface of the grippers. Frame G: gripper tip (cup lip centre, or centre of the cups' plane), +z leaves the
// tool. The gripper judges the perceived surface when planning and the true surface when executing: the difference is
// exactly what perception error costs.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/config.hpp"
#include "core/cup.hpp"
#include "core/hold_limits.hpp"
#include "core/part.hpp"
#include "core/pose.hpp"
#include "core/primitive.hpp"

namespace binpick {

/// The surface met by a ray that starts at a probe point (shifted back along -z_G) and runs along +z_G.
struct SurfaceSample {
  bool hit = false;
  Eigen::Vector3d point_G = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_G = -Eigen::Vector3d::UnitZ();  ///< outward of the part, so about -z_G
  int body = -1;                                         ///< which body was hit; all of one cup must agree
};

struct Contact {
  bool sealed = false;  ///< enough cups for this gripper
  std::vector<bool> cup_sealed;
  std::vector<std::string> why;  ///< per cup: why not, "" when sealed
  std::vector<double>
      cup_vacuum;     ///< per cup: steady vacuum / that of a tight cup; below 0.8 it does not count as sealed
  HoldLimits limits;  ///< of the cups that sealed, about G
};

/// A grasp on a part: K on the surface, +z outward; at contact z_G = -z_K, X_WG = X_WP * X_PK * X_KG.
struct PickSite {
  Pose X_PK = Pose::Identity();
  bool free_spin = false;        ///< any turn about z_K is as good
  double quality = 1;            ///< 0..1: how well the surface seals and how near the mass centre is
  int cup = -1;                  ///< the one cup that takes hold, or -1: as many as the gripper needs
  Pose X_UG = Pose::Identity();  ///< tip in the frame of that cup; identity when the whole tool takes hold
};

/// At contact the tool (or the site's cup) points against the normal: X_WG = X_WP * X_PK * X_KU * X_UG, turned by
/// `spin` about z_K.
inline Pose tip_at_site(const Pose& X_WP, const PickSite& site, double spin = 0) {
  const Pose X_KU(Eigen::AngleAxisd(spin, Eigen::Vector3d::UnitZ()) *
                  Eigen::AngleAxisd(3.14159265358979323846, Eigen::Vector3d::UnitX()));
  return X_WP * site.X_PK * X_KU * site.X_UG;
}

class Gripper {
 public:
  virtual ~Gripper() = default;
  virtual void visit(ConfigVisitor& v) = 0;
  virtual void validate() const = 0;
  /// Where the surface is sampled: the same number for every cup, cup after cup.
  virtual std::vector<Eigen::Vector3d> probe_points_G() const = 0;
  virtual Contact judge(std::span<const SurfaceSample> samples_G) const = 0;
  virtual const std::vector<CupSpec>& cups() const = 0;
  /// Rigid body of the tool in G (stem, manifold), without the moving lips; G lies at negative z from the lips' end.
  virtual std::vector<Primitive> body_G() const = 0;
  /// Gripper tip in the flange frame.
  virtual Pose X_FG() const = 0;
};

struct GripperEntry {
  std::string name;
  std::string help;
  std::unique_ptr<Gripper> (*make)();
};
const std::vector<GripperEntry>& gripper_registry();
std::vector<std::string> gripper_names();
std::unique_ptr<Gripper> make_gripper(const std::string& name);  ///< throws SpecError with the nearest name

}  // namespace binpick

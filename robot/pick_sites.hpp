// Where a gripper fits on a part: computed once per part and gripper, from the CAD mesh alone. A site's frame K lies on
// the part's surface in the plane of the lips, +z outward; the gripper itself judges the mesh under its probe rays.
#pragma once

#include <string>
#include <vector>

#include "core/part.hpp"
#include "robot/gripper.hpp"

namespace binpick {

struct PickSiteConfig {
  double acceleration = 5;  ///< m/s^2, added to gravity for the load (physical_models B1)
  double safety = 1.5;      ///< load factor; 1.5 = smooth surface, the catalogues' minimum
  double press = 0.004;     ///< m, the tool's body must clear the part when pressed this far
  int max_sites = 60;
  bool keep_weak = false;  ///< also sites whose load exceeds the hold (they peel); quality 0
};

struct PickSites {
  std::vector<PickSite> sites;  ///< best first, spread over the part
  int tried = 0, leaking = 0, blocked = 0, weak = 0;
  std::string why_none;  ///< one line, when there are no sites
};

PickSites find_pick_sites(const Part& part, const Gripper& gripper, const PickSiteConfig& config = {});

/// What the gripper's probe rays meet on a mesh when the tip stands at X_PG; rays start `back` behind the probe points.
/// Hits further than `reach` beyond them do not count.
std::vector<SurfaceSample> probe_mesh(const MeshQuery& mesh_P, const Gripper& gripper, const Pose& X_PG, double back,
                                      double reach);

/// Turns by 2 pi / n about the tool's axis leave the cups where they are; 0 when any turn does (one cup on the axis).
int turn_order(const Gripper& gripper);

}  // namespace binpick

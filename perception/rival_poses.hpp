// A found pose against its rivals: wherever a self-overlap T of the part puts what is explained onto the part again,
// the pose X * T is refined and drawn as X was. When the scene speaks clearly for one of the two, that one is kept;
// when it does not, the pose is ambiguous and is marked so (a half turn that is decided by the score alone is a coin
// toss). Unlike view_ambiguity, which asks the CAD what a view can show, this asks the frame what it does show. Frame
// C.
#pragma once

#include <cstdint>
#include <vector>

#include "perception/self_overlap.hpp"
#include "perception/view_check.hpp"

namespace binpick {

struct RivalConfig {
  double least_alike = 0.8;        ///< of the explained points that X * T must explain, too, to be tried at all
  double least_difference = 0.03;  ///< of the explained pixels: net evidence that decides between two poses, where the
                                   ///< foreground grows by a pixel; a third of it where it does not

  void visit(ConfigVisitor& v);
  void validate() const;
};

struct RivalSettings {
  const RivalConfig& rivals;
  const IcpConfig& icp;
  const CheckConfig& check;
};

/// Puts the better pose into the candidate and says whether it is ambiguous. `taken`: of every pixel, how many other
/// poses explain it. True when the pose was changed.
bool settle_rivals(const Scene& scene, const SurfaceModel& model, const std::vector<SelfOverlap>& overlaps,
                   const RivalSettings& settings, const std::vector<std::uint8_t>& taken, Candidate& candidate);

}  // namespace binpick

// What the scene does where a drawn part ends: does its surface simply go on beyond the outline, straight or bent? By
// eight sides (outward directions in the image), of which the worst counts: a bolt laid along a shaft leaks at one end
// only, a plate on one leg of a bracket hangs together with the other. Frame C.
#pragma once

#include <cstdint>
#include <vector>

#include "perception/hypothesis_check.hpp"
#include "perception/part_view.hpp"

namespace binpick {

struct RimEvidence {
  double leak_side = 0;  ///< of the judged outline of the worst side, at which the scene's surface goes on straight and
                         ///< no other pose explains it
  double attached = 0;   ///< the same, at which no depth step separates what follows, whichever way it turns
  double judged = 0;     ///< of the whole outline, that could be judged
};

/// `taken`: of every pixel, how many other poses explain it.
RimEvidence judge_rims(const Scene& scene, const PartView& view, const std::vector<std::uint8_t>& taken,
                       const CheckConfig& config);

}  // namespace binpick

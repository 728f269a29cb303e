// From voted poses of one kind of part to refined and accepted ones: verification, coarse ICP, one pose of each place,
// fine ICP and the check of the drawn part (paper 4.2). Every stage spreads its poses over Scene::threads and puts them
// together by index; what depends on an order goes best first in waves of a fixed size. Frame C, metres.
#pragma once

#include "perception/part_search.hpp"

namespace binpick {

/// Of the voted poses, what the scene bears out best, from every region some.
std::vector<PoseHypothesis> verified_poses(const Scene& scene, const PreparedPart& part,
                                           const std::vector<PoseHypothesis>& poses, const PpfSettings& settings);

/// ICP of those, coarse and fine, and the acceptance of the drawn part. `part` is left 0.
std::vector<Candidate> refined_poses(const Scene& scene, const PreparedPart& part,
                                     const std::vector<PoseHypothesis>& poses, const PpfSettings& settings);

}  // namespace binpick

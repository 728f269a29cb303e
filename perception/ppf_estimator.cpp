// type: ppf. Point pair features of the CAD, voted for, verified by drawing and refined on what is visible.
// The stages are those of ppf_pipeline.hpp; what each of them adds to the paper's method, and what it gains, is
// measured by `binpick bench perception --ablation`. Parameters and defaults: the sections of visit().
#include <memory>

#include "perception/ppf_pipeline.hpp"

namespace binpick {

std::unique_ptr<PoseEstimator> make_ppf_estimator() { return std::make_unique<PpfEstimator>(PpfSettings{}); }

}  // namespace binpick

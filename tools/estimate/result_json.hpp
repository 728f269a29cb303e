// Poses as JSON, for robots and scripts: docs/estimate.md. Private to tools.
#pragma once

#include <string>
#include <vector>

#include "perception/frame_request.hpp"

namespace binpick {

/// One object; SI units, matrices row-major; wall times in an object of their own.
std::string estimates_json(const FrameRequest& request, const std::vector<Part>& parts, const EstimateResult& result);

}  // namespace binpick

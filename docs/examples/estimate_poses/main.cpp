// estimate_poses FOLDER: poses of the parts in one recorded frame, without simulator or robot.
#include <cstdio>
#include <exception>

#include "core/part.hpp"
#include "perception/frame_request.hpp"

int main(int argc, char** argv) try {
  if (argc != 2) return std::fprintf(stderr, "usage: estimate_poses FOLDER\n"), 2;
  // A camera's driver would fill the view itself: depth in metres (NaN = no return), intrinsics, stated noise, and the
  // bin with its believed pose X_CB when there is one.
  binpick::RecordedFrame frame = binpick::read_frame_folder(argv[1]);
  frame.view.threads = 2;
  std::vector<binpick::Part> parts;
  for (const binpick::PartSpec& spec : frame.request.parts) parts.push_back(binpick::load_part(spec));

  const auto estimator = binpick::make_estimator("ppf");
  estimator->prepare(parts);  // once; the prepared estimator serves any number of frames and threads
  const binpick::EstimateResult found = estimator->estimate(frame.view, frame.request.seed);
  for (const binpick::PoseEstimate& e : found.estimates) {
    const Eigen::Vector3d t = e.X_CP.translation();  // X_CP: from the part's frame to the camera's
    std::printf("%s score %.2f at %.4f %.4f %.4f m%s\n", parts[e.part].name.c_str(), e.score, t.x(), t.y(), t.z(),
                e.ambiguous ? ", ambiguous" : "");
  }
  return found.status == binpick::EstimateStatus::kFailed;
} catch (const std::exception& error) {  // a bad file: one readable line
  return std::fprintf(stderr, "%s\n", error.what()), 2;
}

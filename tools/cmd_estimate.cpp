// binpick estimate FOLDER: poses in a recorded or real frame (request.yaml + depth.tiff); no simulator, no robot.

#include <iostream>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "perception/frame_request.hpp"
#include "tools/commands.hpp"

namespace binpick {

Action add_estimate(CLI::App& app) {
  auto folder = std::make_shared<std::string>();
  auto out = std::make_shared<std::string>();
  CLI::App* command =
      app.add_subcommand("estimate", "poses in a recorded or real depth frame (request.yaml + depth.tiff)");
  command->add_option("folder", *folder, "folder with request.yaml and depth.tiff")->required();
  command->add_option("--out", *out, "write the CSV here instead of to standard output");
  return [folder, out] {
    const RecordedFrame frame = read_frame_folder(*folder);
    std::vector<Part> parts;
    for (const PartSpec& spec : frame.request.parts) parts.push_back(load_part(spec));
    frame.request.estimator->prepare(parts);
    const EstimateResult found = frame.request.estimator->estimate(frame.view, frame.request.seed);
    if (found.status == EstimateStatus::kFailed) throw AssetError(*folder + ": " + found.message);
    if (out->empty()) {
      std::cout << estimates_csv(found) << std::flush;
      if (!std::cout) throw StorageError("standard output: cannot write");
    } else {
      write_file(*out, estimates_csv(found));
    }
    std::cerr << found.estimates.size() << " poses in " << static_cast<int>(found.wall.total * 1e3 + 0.5) << " ms\n";
    return 0;
  };
}

}  // namespace binpick

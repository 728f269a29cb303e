// binpick estimate FOLDER, or --part PART.. with --depth IMAGE --camera FILE or --cloud FILE: poses in a recorded or
// real frame; no simulator, no robot. docs/estimate.md.

#include <iostream>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "perception/overlay.hpp"
#include "tools/commands.hpp"
#include "tools/estimate/request.hpp"
#include "tools/estimate/result_json.hpp"

namespace binpick {
namespace {

struct Outputs {
  std::string csv, json, overlay;
};

void say(const std::string& text) {
  std::cout << text << std::flush;
  if (!std::cout) throw StorageError("standard output: cannot write");
}

int estimate(const EstimateOptions& options, const Outputs& outputs) {
  const RecordedFrame frame = read_frame(options);
  const std::vector<Part> parts = load_parts(frame.request);
  frame.request.estimator->prepare(parts);
  EstimateResult found = frame.request.estimator->estimate(frame.view, frame.request.seed);
  const std::string& seen = !options.folder.empty() ? options.folder : options.depth + options.cloud;
  if (found.status == EstimateStatus::kFailed) throw AssetError(seen + ": " + found.message);
  if (found.estimates.empty() && found.message.empty()) found.message = why_nothing(frame.view);
  const bool recorded = !options.folder.empty();
  if (!outputs.csv.empty()) write_file(outputs.csv, estimates_csv(found));
  if (!outputs.json.empty()) write_file(outputs.json, estimates_json(frame.request, parts, found));
  if (!outputs.overlay.empty()) {
    const DepthFrame depth = depth_of(frame.view);
    write_png(outputs.overlay, overlay_picture(depth_picture(depth), depth, found.estimates, parts));
  }
  if (recorded && outputs.csv.empty()) say(estimates_csv(found));
  if (!recorded && outputs.json.empty()) say(estimates_json(frame.request, parts, found));
  std::cerr << found.estimates.size() << " poses in " << static_cast<int>(found.wall.total * 1e3 + 0.5) << " ms"
            << (found.estimates.empty() ? ": " + found.message : "") << "\n";
  return 0;
}

}  // namespace

Action add_estimate(CLI::App& app) {
  auto options = std::make_shared<EstimateOptions>();
  auto outputs = std::make_shared<Outputs>();
  CLI::App* command = app.add_subcommand("estimate", "poses in a recorded frame (a folder) or in a real one");
  command->add_option("folder", options->folder, "folder with request.yaml and depth.tiff or cloud.ply");
  command->add_option("--part", options->parts, "part.yaml or a mesh (STL, OBJ, PLY, STEP); may be given again");
  command->add_option("--unit", options->unit, "length unit of the meshes named by --part: mm, cm, m, inch");
  command->add_option("--depth", options->depth, "depth image: 16-bit PNG or float TIFF in metres");
  command->add_option("--camera", options->camera, "camera.yaml of the depth image");
  command->add_option("--cloud", options->cloud, "point cloud in the camera's frame, metres: PLY or PCD");
  command->add_option("--bin", options->bin, "bin.yaml: the bin and where it is believed to stand");
  command->add_option("--noise", options->noise, "sigma_z = C + L z + Q z^2 in metres, outlines grown by F pixels")
      ->delimiter(',')
      ->expected(1, 4)
      ->type_name("C[,L[,Q[,F]]]");
  command->add_option("--estimator", options->estimator, "an estimator's name, or a YAML file with type and keys");
  command->add_option("--seed", options->seed, "seed of the estimator");
  command->add_option("--out", outputs->csv, "write the poses as CSV here");
  command->add_option("--json", outputs->json, "write the poses as JSON here");
  command->add_option("--overlay", outputs->overlay, "write a picture of the poses over the depth here (PNG)");
  return [options, outputs] { return estimate(*options, *outputs); };
}

}  // namespace binpick

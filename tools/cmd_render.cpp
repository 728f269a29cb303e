// binpick render SCENE --seed N [--sensor NAME[:PRESET]] --out DIR: the seed's heap as the camera sees it, as files.
// The frame is the one that `binpick trial` looks at first.

#include <iostream>

#include "core/error.hpp"
#include "core/image_io.hpp"
#include "perception/cloud_io.hpp"
#include "sim/grey_image.hpp"
#include "tools/commands.hpp"
#include "trials/observation.hpp"
#include "trials/render_folder.hpp"

namespace binpick {
namespace {

struct Options {
  std::string scene, out, sensor;
  std::uint64_t seed = 0;
  bool grey = false;
};

// What a grey camera of the same intrinsics sees from the same place, through the lens of the cell file.
void write_grey(const std::string& file, const Scenario& s, const CellWorld& cell_world, DepthRenderer& renderer,
                Seed trial_seed) {
  const GreyCamera camera{s.cell.camera.intrinsics, s.cell.camera.lens,
                          cell_world.cell().camera_pose(cell_world.joints())};
  write_png8(file, capture_grey(renderer, cell_world.render_scene(), camera, {}, trial_seed.child("sensor")));
}

int run(const Options& options) {
  Scenario scenario = read_scenario(options.scene, {options.sensor});
  TrialContext context = make_trial_context(scenario);
  const TrueCell built = true_cell(scenario, context, Seed{options.seed});
  CellWorld cell_world(built.cell, scenario.physics, context.parts);
  const DropResult heap = drop_heap(scenario, context, Seed{options.seed}, cell_world);
  const bool settled = heap.settled && heap.escaped.empty();
  if (!settled) std::cerr << "note: this heap is not at rest inside its bin; a trial would end as Unsettled\n";
  const Observation seen = observe(scenario, cell_world, context, Seed{options.seed}, 0);
  for (std::size_t k = 0; k < seen.captures.size(); ++k)
    write_render_folder(options.out + (k == 0 ? "" : "/camera_" + std::to_string(k)), scenario,
                        {context.hash, options.seed, settled, built.cell.camera_pose(cell_world.joints(), k)},
                        seen.captures[k], cell_world, *context.renderer);
  if (const auto* cloud_C = std::get_if<PointCloud>(&seen.view.seen))
    write_cloud_ply(options.out + "/fused.ply", *cloud_C, "frame C of the first camera, metres; all cameras' points");
  if (options.grey) write_grey(options.out + "/grey.png", scenario, cell_world, *context.renderer, Seed{options.seed});
  std::cout << options.out << std::endl;
  if (!std::cout) throw StorageError("standard output: cannot write");
  return 0;
}

}  // namespace

Action add_render(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("render", "one look at a seed's heap: depth, ids, cloud and pictures as files");
  command->add_option("scene", options->scene, "scene file (YAML)")->required();
  command->add_option("--seed", options->seed, "seed of the trial whose heap is looked at")->required();
  command->add_option("--out", options->out, "folder for the files")->required();
  command->add_flag("--grey", options->grey, "also grey.png, as a grey camera in the same place would see it");
  add_sensor_option(*command, options->sensor);
  return [options] { return run(*options); };
}

}  // namespace binpick

// binpick view RUN --seed N: one replay as a page of its own; --png F and --gif F: pictures of it.

#include <cmath>
#include <filesystem>
#include <iostream>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "tools/commands.hpp"
#include "trials/gif_file.hpp"
#include "trials/replay_picture.hpp"
#include "trials/run_report.hpp"

namespace binpick {
namespace {

struct Options {
  std::string run, out, png, gif;
  std::uint64_t seed = 0;
  double time = -1;  // s; not given: where it says most
  int pick = -1;     // not given: the first that failed
  int width = 960;
  double speed = 4, rate = 10;
};

int height_of(int width) { return 2 * width / 3; }

void write_picture(const Options& options, const Replay& replay, DepthRenderer& renderer) {
  const double time = options.time >= 0 ? options.time : telling_time(replay, options.pick);
  write_png(options.png, ReplayPicture(replay, renderer).at(time, options.width, height_of(options.width)));
  std::cout << options.png << ": seed " << options.seed << " at " << time << " s" << std::endl;
}

void write_film(const Options& options, const Replay& replay, DepthRenderer& renderer) {
  const ReplayPicture picture(replay, renderer);
  const auto [from, to] = span_of(replay, options.pick);
  const int frames = std::max(1, static_cast<int>(std::ceil((to - from) / options.speed * options.rate)));
  StderrProgress progress;
  GifFile gif(options.gif, options.width, height_of(options.width), 1 / options.rate);
  for (int k = 0; k < frames; ++k) {
    gif.add(picture.at(from + k * options.speed / options.rate, options.width, height_of(options.width)));
    progress.update(static_cast<std::size_t>(k + 1), static_cast<std::size_t>(frames), "frames");
  }
  gif.close();
  progress.finish();
  std::cout << options.gif << ": seed " << options.seed << ", " << from << " to " << to << " s in " << frames
            << " frames" << std::endl;
}

int run(Options options) {
  if (!std::filesystem::is_directory(options.run + "/records"))
    throw SpecError(options.run + ": is not a run folder: no records/ in it");
  if (options.png.empty() && options.gif.empty()) {
    if (options.out.empty())
      options.out = options.run + "/artifacts/seed-" + std::to_string(options.seed) + "/replay.html";
    write_replay_page(options.run, options.seed, options.out);
    std::cout << options.out << std::endl;
    return 0;
  }
  // The meshes as they are, where the page has small ones: the trial runs again.
  std::cerr << "running seed " << options.seed << " again" << std::endl;
  const Replay replay = replay_again(options.run, options.seed);
  const std::unique_ptr<DepthRenderer> renderer = make_osmesa_renderer();
  if (!options.png.empty()) write_picture(options, replay, *renderer);
  if (!options.gif.empty()) write_film(options, replay, *renderer);
  return 0;
}

}  // namespace

Action add_view(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("view", "one trial of a run to look at: a page, a picture or a GIF");
  command->add_option("run", options->run, "run folder")->required();
  command->add_option("--seed", options->seed, "seed of the trial")->required();
  command->add_option("--out", options->out, "the page (default: RUN/artifacts/seed-N/replay.html)");
  command->add_option("--png", options->png, "a picture instead");
  command->add_option("--gif", options->gif, "a GIF of one pick instead");
  command->add_option("--time", options->time, "s of the trial, for --png (default: when the part hangs in the air)")
      ->check(CLI::Range(0.0, 1e6));
  command->add_option("--pick", options->pick, "which pick (default: the first that failed, else the first)")
      ->check(CLI::Range(0, 100000));
  command->add_option("--width", options->width, "pixels")->check(CLI::Range(120, 3840));
  command->add_option("--speed", options->speed, "of the GIF")->check(CLI::Range(0.1, 100.0));
  command->add_option("--rate", options->rate, "frames a second of the GIF")->check(CLI::Range(1.0, 50.0));
  return [options] { return run(*options); };
}

}  // namespace binpick

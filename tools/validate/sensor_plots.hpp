// The curves that `binpick validate sensors --plots` draws: what the models deliver beside what is published. Each
// function measures one, writes its data and script into the folder, and returns its name.
#pragma once

#include <string>

#include "tools/validate/sensor_bench.hpp"

namespace binpick {

/// A curve of a plot: a sensor as a scene would choose it, and over how many frames it is measured.
struct PlotSubject {
  std::string type, preset;
  int frames = 3;

  bool matches_views() const { return type == "active_stereo"; }                      ///< needs its whole image
  bool plays_light() const { return matches_views() || type == "structured_light"; }  ///< shoots pictures
  std::string name() const { return plays_light() ? type + " " + preset : preset; }
  std::unique_ptr<SensorModel> make() const { return configured_sensor(type, "preset: " + preset + "\n"); }
};

std::string plot_noise(SensorBench& bench, const std::string& folder);        ///< sigma_z over range
std::string plot_subpixel(SensorBench& bench, const std::string& folder);     ///< s over range
std::string plot_shadow(SensorBench& bench, const std::string& folder);       ///< shadow width over step
std::string plot_correlation(SensorBench& bench, const std::string& folder);  ///< of the noise, over the lag
std::string plot_averaging(SensorBench& bench, const std::string& folder);    ///< RMS of the mean of n frames
std::string plot_bias(SensorBench& bench, const std::string& folder);         ///< mean error over range

/// Writes every plot and draws them. False when gnuplot is not installed: the data and the scripts are there, the
/// pictures are not. Throws StorageError.
bool plot_sensors(SensorBench& bench, const std::string& folder);

}  // namespace binpick

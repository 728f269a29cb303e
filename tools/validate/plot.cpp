#include "tools/validate/plot.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "core/error.hpp"
#include "core/file_io.hpp"

namespace binpick {
namespace {

constexpr char kHead[] =
    "set terminal pngcairo size 1100,750 font 'DejaVu Sans,13' background rgb 'white'\n"
    "set datafile separator ','\n"
    "set grid lt -1 lw 0.7 lc rgb '#dddddd'\n"
    "set border lc rgb '#444444'\n"
    "set key font ',11' noenhanced Left reverse\n"
    "set linetype 1 lc rgb '#1f77b4'\nset linetype 2 lc rgb '#d62728'\nset linetype 3 lc rgb '#2ca02c'\n"
    "set linetype 4 lc rgb '#9467bd'\nset linetype 5 lc rgb '#ff7f0e'\nset linetype 6 lc rgb '#8c564b'\n"
    "set linetype 7 lc rgb '#e377c2'\nset linetype 8 lc rgb '#17becf'\nset linetype 9 lc rgb '#7f7f7f'\n"
    "set linetype 10 lc rgb '#bcbd22'\n"
    "set for [i=1:10] linetype i lw 2 pt 7 ps 1.3\n"
    "curve(name, c) = (strcol(1) eq name ? column(c) : NaN)\n";

}  // namespace

void CurveTable::add(const std::string& curve, std::initializer_list<double> values) {
  text_ += curve;
  for (const double value : values) {
    char number[32];
    std::snprintf(number, sizeof number, ",%.9g", value);
    text_ += std::isnan(value) ? "," : number;
  }
  text_ += "\n";
}

void write_plot(const std::string& folder, const std::string& name, const CurveTable& table,
                const std::string& commands) {
  write_file(folder + "/" + name + ".csv", table.csv());
  write_file(folder + "/" + name + ".gp",
             "reset\n" + std::string(kHead) + "set output '" + name + ".png'\nfile = '" + name + ".csv'\n" + commands);
}

bool draw_plots(const std::string& folder, const std::vector<std::string>& names) {
  std::vector<std::string> words = {"gnuplot"};
  for (const std::string& name : names) words.push_back(name + ".gp");
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "gnuplot.log", O_WRONLY | O_CREAT | O_TRUNC, 0644);
  pid_t child = 0;
  const int error = ::posix_spawnp(&child, "gnuplot", &actions, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  const std::string log = folder + "/gnuplot.log";
  if (error == ENOENT) return std::filesystem::remove(log), false;
  if (error != 0) throw StorageError(folder + ": cannot start gnuplot: " + std::strerror(error));
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw StorageError(log + ": gnuplot could not draw the curves");
  std::filesystem::remove(log);
  return true;
}

}  // namespace binpick

// Reachability of the bin, place by place: of the poses that the tool may need there, how many can the arm take up, and
// how many without meeting bin, cell or itself? The empty bin, the poses alone: no ways between them, no held part.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "robot/cell.hpp"

namespace binpick {

struct ReachMapConfig {
  double place = 0.025;   ///< m, edge of a place at most
  double tilt = 0.52;     ///< rad, of the tool's axis off the vertical, besides none
  int sides = 8;          ///< directions into which the tool is tilted
  int levels = 3;         ///< heights of the tip: `low` above the floor, .., the rim
  double low = 0.01;      ///< m
  int spins = 12;         ///< turns about the tool's axis, any of which will do
  double margin = 0.012;  ///< m, of the outermost places from the walls: half a stem
};

/// One level of the bin seen from above: places[j * columns + i] is the i-th along x of B and the j-th along y.
struct ReachLevel {
  double height = 0;           ///< m above the bin's floor
  std::vector<double> within;  ///< share of the poses that lie within reach and joint limits
  std::vector<double> free;    ///< of those, share of all poses that meet no obstacle
};

struct ReachMap {
  int columns = 0, rows = 0;              ///< along x and y of B
  std::vector<Eigen::Vector2d> places;    ///< m, in B
  std::vector<ReachLevel> levels;         ///< lowest first
  int poses = 0, within = 0, free = 0;    ///< over all places and levels
  int upright = 0, upright_free = 0;      ///< of them with the tool straight down
  std::map<std::string, int> lost;        ///< why the others are not free: poses
  double share(std::size_t place) const;  ///< free share of a place over all levels
};

ReachMap reach_map(const Cell& cell, const ReachMapConfig& config = {});

}  // namespace binpick

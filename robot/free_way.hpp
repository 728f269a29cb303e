// A way of the joints around obstacles, where the direct one is blocked: two trees that grow towards each other
// (RRT-Connect, Kuffner and LaValle 2000; OMPL), then cut short. The same question has the same answer to the bit: the
// samples come from one fixed stream of core/random, and what bounds the search is a number, never time.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "robot/arm.hpp"

namespace binpick {

struct FreeWayQuery {
  Vector6d q_from, q_to;                      ///< rad, within the limits
  std::function<bool(const Vector6d&)> free;  ///< may the arm stand there?
  /// Optional: a random joint position drawn near to those that may be free, where free ones are few (a tool that must
  /// stay upright). Empty result: as it was.
  std::function<std::optional<Vector6d>(const Vector6d&)> draw_near;
  double step = 0.01;  ///< m, about how far the arm moves between two checks
};

/// Joint positions from q_from to q_to; between neighbours the straight joint motion was free at every step. Takes what
/// it checks from `checks_left`; empty when that is used up or an end is not free.
std::optional<std::vector<Vector6d>> find_free_way(const Arm& arm, const FreeWayQuery& query, int& checks_left);

}  // namespace binpick

// Triangles of mixed orientation: turned until neighbours agree.
#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <tuple>

#include "core/mesh_repair.hpp"

namespace binpick {
namespace {

struct Neighbour {
  std::uint32_t triangle;
  bool agrees;  ///< the shared edge is passed in opposite directions
};
using Neighbours = std::vector<std::vector<Neighbour>>;

struct Side {
  std::uint32_t low, high, triangle;
  bool upward;
  bool same_edge(const Side& other) const { return low == other.low && high == other.high; }
};

/// Nothing when some edge has not exactly two triangles: then there is no telling what agrees with what.
std::optional<Neighbours> neighbours_of(const TriangleMesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[i][k], b = mesh.triangles[i][(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), i, a < b});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& s, const Side& t) {
    return std::tie(s.low, s.high, s.triangle) < std::tie(t.low, t.high, t.triangle);
  });
  Neighbours neighbours(mesh.triangles.size());
  for (std::size_t i = 0; i < sides.size(); i += 2) {
    if (i + 1 >= sides.size() || !sides[i].same_edge(sides[i + 1])) return {};
    if (i + 2 < sides.size() && sides[i].same_edge(sides[i + 2])) return {};
    const bool agrees = sides[i].upward != sides[i + 1].upward;
    neighbours[sides[i].triangle].push_back({sides[i + 1].triangle, agrees});
    neighbours[sides[i + 1].triangle].push_back({sides[i].triangle, agrees});
  }
  return neighbours;
}

enum class State : char { kUnknown, kKept, kTurned };

State other(State s) { return s == State::kKept ? State::kTurned : State::kKept; }

/// Spreads from `first` over its connected piece. Nothing: the surface is one-sided.
std::optional<std::vector<std::uint32_t>> spread(const Neighbours& neighbours, std::uint32_t first,
                                                 std::vector<State>& states) {
  std::vector<std::uint32_t> piece = {first};
  states[first] = State::kKept;
  for (std::size_t at = 0; at < piece.size(); ++at) {
    const State mine = states[piece[at]];
    for (const Neighbour& next : neighbours[piece[at]]) {
      const State wanted = next.agrees ? mine : other(mine);
      if (states[next.triangle] == State::kUnknown) {
        states[next.triangle] = wanted;
        piece.push_back(next.triangle);
      } else if (states[next.triangle] != wanted) {
        return {};
      }
    }
  }
  return piece;
}

/// A piece that agrees with itself stays (it may be a cavity); a mixed one is turned outward. Returns how many turn.
std::size_t settle(const TriangleMesh& mesh, const std::vector<std::uint32_t>& piece, std::vector<State>& states) {
  const auto is_turned = [&](std::uint32_t i) { return states[i] == State::kTurned; };
  if (std::none_of(piece.begin(), piece.end(), is_turned)) return 0;
  const Eigen::Vector3d reference = mesh.vertices[mesh.triangles[piece[0]][0]];
  double six_volumes = 0;
  for (const std::uint32_t i : piece) {
    const auto& t = mesh.triangles[i];
    const Eigen::Vector3d a = mesh.vertices[t[0]] - reference;
    const Eigen::Vector3d b = mesh.vertices[t[1]] - reference;
    six_volumes += (is_turned(i) ? -1 : 1) * a.dot(b.cross(mesh.vertices[t[2]] - reference));
  }
  if (six_volumes < 0) {
    for (const std::uint32_t i : piece) states[i] = other(states[i]);
  }
  return static_cast<std::size_t>(std::count_if(piece.begin(), piece.end(), is_turned));
}

}  // namespace

std::size_t turn_to_neighbours(TriangleMesh& mesh) {
  const std::optional<Neighbours> neighbours = neighbours_of(mesh);
  if (!neighbours) return 0;
  std::vector<State> states(mesh.triangles.size(), State::kUnknown);
  std::size_t turned = 0;
  for (std::uint32_t i = 0; i < states.size(); ++i) {
    if (states[i] != State::kUnknown) continue;
    const auto piece = spread(*neighbours, i, states);
    if (!piece) return 0;
    turned += settle(mesh, *piece, states);
  }
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (states[i] == State::kTurned) std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
  }
  return turned;
}

}  // namespace binpick

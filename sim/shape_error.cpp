#include "sim/shape_error.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/check.hpp"
#include "core/mesh_properties.hpp"
#include "core/primitive.hpp"
#include "core/random.hpp"
#include "core/sample_surface.hpp"

namespace binpick {
namespace {

constexpr Seed kSeed{0x5ea9e};  // one measurement, one set of samples

/// A line along z enters (+1) or leaves (-1) a closed surface.
struct Crossing {
  double z;
  int step;
};
using Crossings = std::vector<Crossing>;

/// Twice the signed area of p, q and s. Computed from the same end whichever way the edge is given, so that a line
/// through an edge crosses exactly one of the two triangles beside it.
double side(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector2d& s) {
  const bool turned = q.x() < p.x() || (q.x() == p.x() && q.y() < p.y());
  const Eigen::Vector3d &a = turned ? q : p, &b = turned ? p : q;
  double area = (b.x() - a.x()) * (s.y() - a.y()) - (b.y() - a.y()) * (s.x() - a.x());
  if (area == 0) area = 1e-300;
  return turned ? -area : area;
}

/// Lines along z, two at random places in every cell of a grid over a rectangle.
class LineGrid {
 public:
  LineGrid(const Eigen::AlignedBox3d& box, int cells) : low_(box.min().head<2>()) {
    const Eigen::Vector2d size = box.sizes().head<2>();
    count_ = (size / size.maxCoeff() * cells).array().ceil().cast<int>().max(1);
    cell_ = size.cwiseQuotient(count_.cast<double>());
    const Rng stream = kSeed.child("lines").rng();
    for (int v = 0; v < count_.y(); ++v)
      for (int u = 0; u < count_.x(); ++u) {
        Rng rng = stream.at(static_cast<std::uint64_t>(v) * static_cast<std::uint64_t>(count_.x()) +
                            static_cast<std::uint64_t>(u));
        for (int k = 0; k < 2; ++k) {
          const double x = rng.uniform(), y = rng.uniform();
          lines_.push_back(low_ + cell_.cwiseProduct(Eigen::Vector2d(u + x, v + y)));
        }
      }
  }

  std::size_t cells() const { return lines_.size() / 2; }
  double cell_area() const { return cell_.x() * cell_.y(); }

  /// Crossings of every line, the lowest first. Line 2 i and 2 i + 1 are those of cell i.
  std::vector<Crossings> crossings(const TriangleMesh& mesh) const {
    std::vector<Crossings> result(lines_.size());
    for (const auto& t : mesh.triangles) add(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]], result);
    for (Crossings& line : result)
      std::sort(line.begin(), line.end(), [](const Crossing& a, const Crossing& b) { return a.z < b.z; });
    return result;
  }

 private:
  void add(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
           std::vector<Crossings>& result) const {
    const Eigen::Vector2d low = a.cwiseMin(b).cwiseMin(c).head<2>(), high = a.cwiseMax(b).cwiseMax(c).head<2>();
    const Eigen::Vector2i from = cell_of(low), to = cell_of(high);
    for (int v = from.y(); v <= to.y(); ++v)
      for (int u = from.x(); u <= to.x(); ++u)
        for (int k = 0; k < 2; ++k) {
          const auto line = static_cast<std::size_t>(2 * (v * count_.x() + u) + k);
          const Eigen::Vector2d& s = lines_[line];
          const double wa = side(b, c, s), wb = side(c, a, s), wc = side(a, b, s);
          const bool faces_up = wa > 0;
          if ((wb > 0) != faces_up || (wc > 0) != faces_up) continue;
          result[line].push_back({(wa * a.z() + wb * b.z() + wc * c.z()) / (wa + wb + wc), faces_up ? -1 : 1});
        }
  }
  Eigen::Vector2i cell_of(const Eigen::Vector2d& p) const {
    return (p - low_).cwiseQuotient(cell_).array().floor().cast<int>().max(0).min(count_.array() - 1);
  }

  Eigen::Vector2d low_, cell_;
  Eigen::Vector2i count_;
  std::vector<Eigen::Vector2d> lines_;
};

struct Lengths {
  double solid = 0, extra = 0, missing = 0;
};

/// Lengths along one line in the solid, in pieces only, in the solid only.
Lengths lengths(const Crossings& solid, const Crossings& pieces) {
  Lengths sum;
  std::size_t i = 0, j = 0;
  int in_solid = 0, in_pieces = 0;
  double z = 0;
  while (i < solid.size() || j < pieces.size()) {
    const bool first = j == pieces.size() || (i < solid.size() && solid[i].z < pieces[j].z);
    const Crossing& next = first ? solid[i++] : pieces[j++];
    if (in_solid > 0) sum.solid += next.z - z;
    if (in_pieces > 0 && in_solid <= 0) sum.extra += next.z - z;
    if (in_pieces <= 0 && in_solid > 0) sum.missing += next.z - z;
    (first ? in_solid : in_pieces) += next.step;
    z = next.z;
  }
  return sum;
}

/// Turned so that the shortest edge of the box lies along z: most lines pass the broadest side.
TriangleMesh with_axis_up(const TriangleMesh& mesh, int axis) {
  TriangleMesh result = mesh;
  for (Eigen::Vector3d& v : result.vertices) v = Eigen::Vector3d(v[(axis + 1) % 3], v[(axis + 2) % 3], v[axis]);
  return result;
}

void measure_volume(const TriangleMesh& solid, const TriangleMesh& all, int cells, ShapeError& error) {
  Eigen::AlignedBox3d box = bounding_box(solid);
  box.extend(bounding_box(all));
  int axis = 0;
  box.sizes().minCoeff(&axis);
  const TriangleMesh solid_up = with_axis_up(solid, axis), all_up = with_axis_up(all, axis);
  box = bounding_box(solid_up);
  box.extend(bounding_box(all_up));
  const LineGrid grid(box, cells);
  const std::vector<Crossings> of_solid = grid.crossings(solid_up), of_pieces = grid.crossings(all_up);
  Lengths sum;
  double squares = 0;
  for (std::size_t cell = 0; cell < grid.cells(); ++cell) {
    const Lengths a = lengths(of_solid[2 * cell], of_pieces[2 * cell]);
    const Lengths b = lengths(of_solid[2 * cell + 1], of_pieces[2 * cell + 1]);
    sum.solid += (a.solid + b.solid) / 2;
    sum.extra += (a.extra + b.extra) / 2;
    sum.missing += (a.missing + b.missing) / 2;
    const double difference = a.extra + a.missing - b.extra - b.missing;
    squares += difference * difference / 4;  // variance of the mean of two
  }
  error.volume = sum.solid * grid.cell_area();
  BP_CHECK(sum.solid > 0, "the solid has no volume");
  error.extra = sum.extra / sum.solid;
  error.missing = sum.missing / sum.solid;
  error.standard_error = std::sqrt(squares) / sum.solid;
}

/// The farthest that a point of one surface lies from the other: even samples, and every corner.
double farthest(const TriangleMesh& from, const TriangleMesh& to, double spacing) {
  const MeshQuery query(to);
  double worst = 0;
  const auto visit = [&](const Eigen::Vector3d& p) {
    if (const auto hit = query.closest(p, 1e3)) worst = std::max(worst, hit->distance);
  };
  for (const Eigen::Vector3d& p : sample_surface(from, spacing, kSeed.child("surface")).points) visit(p);
  for (const Eigen::Vector3d& p : from.vertices) visit(p);
  return worst;
}

}  // namespace

ShapeError shape_error(const TriangleMesh& solid, const std::vector<TriangleMesh>& pieces,
                       const ShapeErrorOptions& options) {
  BP_CHECK(!solid.empty() && !pieces.empty());
  ShapeError error;
  TriangleMesh all;
  for (const TriangleMesh& piece : pieces) append(all, piece);
  measure_volume(solid, all, options.cells, error);
  const double diagonal = bounding_box(solid).diagonal().norm();
  error.spacing = diagonal / options.points;
  const TriangleMesh surface = union_surface(pieces, options.touch * diagonal);
  error.solid_to_pieces = farthest(solid, surface, error.spacing);
  error.pieces_to_solid = farthest(surface, solid, error.spacing);
  return error;
}

}  // namespace binpick

#include "core/convex_hull.hpp"

extern "C" {
#include <libqhull_r/libqhull_r.h>
}

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <numeric>

#include "core/check.hpp"

namespace binpick {
namespace {

/// One run of Qhull. The reentrant library keeps its state here, so threads do not meet.
class Hull {
 public:
  Hull(const std::vector<Eigen::Vector3d>& points, const char* options) : coordinates_(3 * points.size()) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) coordinates_[3 * i + k] = points[i][static_cast<Eigen::Index>(k)];
    }
    std::vector<char> command(options, options + std::char_traits<char>::length(options) + 1);
    sink_ = std::fopen("/dev/null", "w");  // Qhull must have a file for its complaints; libraries never print
    BP_CHECK(sink_ != nullptr);
    qh_zero(&state_, sink_);
    ok_ = qh_new_qhull(&state_, 3, static_cast<int>(points.size()), coordinates_.data(), False, command.data(), sink_,
                       sink_) == 0;
  }
  ~Hull() {
    qh_freeqhull(&state_, !qh_ALL);
    int kept = 0;
    int total = 0;
    qh_memfreeshort(&state_, &kept, &total);
    std::fclose(sink_);
  }
  Hull(const Hull&) = delete;
  Hull& operator=(const Hull&) = delete;

  bool ok() const { return ok_; }
  qhT* state() { return &state_; }

 private:
  std::vector<coordT> coordinates_;
  qhT state_ = {};
  std::FILE* sink_ = nullptr;
  bool ok_ = false;
};

std::vector<std::uint32_t> all_indices(std::size_t count) {
  std::vector<std::uint32_t> indices(count);
  std::iota(indices.begin(), indices.end(), 0u);
  return indices;
}

/// The facet's corners, counter-clockwise seen from outside.
std::array<std::uint32_t, 3> corners_of(qhT* qh, facetT* facet, const std::vector<Eigen::Vector3d>& points) {
  std::array<std::uint32_t, 3> corner = {};
  std::size_t n = 0;
  vertexT* vertex = nullptr;
  vertexT** vertexp = nullptr;
  FOREACHvertex_(facet->vertices) {
    BP_CHECK(n < 3);
    corner[n++] = static_cast<std::uint32_t>(qh_pointid(qh, vertex->point));
  }
  const Eigen::Vector3d outward(facet->normal[0], facet->normal[1], facet->normal[2]);
  const Eigen::Vector3d& a = points[corner[0]];
  if ((points[corner[1]] - a).cross(points[corner[2]] - a).dot(outward) < 0) std::swap(corner[1], corner[2]);
  return corner;
}

}  // namespace

std::vector<std::uint32_t> hull_indices(const std::vector<Eigen::Vector3d>& points) {
  if (points.size() < 5) return all_indices(points.size());
  Hull hull(points, "qhull");
  if (!hull.ok()) return all_indices(points.size());
  qhT* qh = hull.state();
  std::vector<std::uint32_t> indices;
  vertexT* vertex = nullptr;
  FORALLvertices { indices.push_back(static_cast<std::uint32_t>(qh_pointid(qh, vertex->point))); }
  std::sort(indices.begin(), indices.end());
  return indices;
}

TriangleMesh convex_hull(const std::vector<Eigen::Vector3d>& points) {
  if (points.size() < 4) return {};
  Hull hull(points, "qhull Qt");
  if (!hull.ok()) return {};
  qhT* qh = hull.state();
  constexpr std::uint32_t kUnused = ~0u;
  std::vector<std::uint32_t> number(points.size(), kUnused);
  TriangleMesh mesh;
  facetT* facet = nullptr;
  FORALLfacets {
    std::array<std::uint32_t, 3> triangle = corners_of(qh, facet, points);
    for (std::uint32_t& corner : triangle) {
      if (number[corner] == kUnused) {
        number[corner] = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(points[corner]);
      }
      corner = number[corner];
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

}  // namespace binpick

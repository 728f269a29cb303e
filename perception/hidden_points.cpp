#include "perception/hidden_points.hpp"

#include <cmath>
#include <cstdio>

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

#include "core/check.hpp"

namespace binpick {
namespace {

/// The state of one Qhull run, freed whatever happens.
class HullRun {
 public:
  HullRun() { qh_zero(&state_, nullptr); }
  ~HullRun() {
    state_.NOerrexit = True;
    qh_freeqhull(&state_, !qh_ALL);
    int curlong = 0, totlong = 0;
    qh_memfreeshort(&state_, &curlong, &totlong);
  }
  HullRun(const HullRun&) = delete;
  HullRun& operator=(const HullRun&) = delete;

  /// Marks the hull's points; false when they span no volume.
  bool mark(std::vector<double>& coordinates, std::vector<char>& on_hull) {
    char command[] = "qhull Qc Pp";
    qhT* qh = &state_;
    if (qh_new_qhull(qh, 3, static_cast<int>(on_hull.size()), coordinates.data(), False, command, nullptr, nullptr) !=
        0)
      return false;
    vertexT *vertex = nullptr, **vertexp = nullptr;
    facetT* facet = nullptr;
    FORALLvertices {
      const int id = qh_pointid(qh, vertex->point);
      if (id >= 0) on_hull[static_cast<std::size_t>(id)] = 1;
    }
    FORALLfacets {  // points that Qhull merged into a facet lie on the hull as well
      if (facet->coplanarset == nullptr) continue;
      pointT *point = nullptr, **pointp = nullptr;
      FOREACHpoint_(facet->coplanarset) {
        const int id = qh_pointid(qh, point);
        if (id >= 0) on_hull[static_cast<std::size_t>(id)] = 1;
      }
    }
    (void)vertexp;
    return true;
  }

 private:
  qhT state_;
};

}  // namespace

std::vector<std::size_t> visible_points(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& viewpoint,
                                        double radius_factor) {
  BP_CHECK(radius_factor > 1, radius_factor);
  double farthest = 0;
  for (const Eigen::Vector3d& p : points) farthest = std::max(farthest, (p - viewpoint).norm());
  const double radius = radius_factor * farthest;
  // Reflected points scaled by 1 / radius: Qhull's tolerances are absolute in the size of its input.
  std::vector<double> coordinates;
  coordinates.reserve(3 * (points.size() + 1));
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector3d d = p - viewpoint;
    const double norm = d.norm();
    const Eigen::Vector3d flipped = norm > 0 ? Eigen::Vector3d(d * ((2 * radius - norm) / (norm * radius))) : d;
    coordinates.insert(coordinates.end(), flipped.data(), flipped.data() + 3);
  }
  coordinates.insert(coordinates.end(), {0.0, 0.0, 0.0});
  std::vector<char> on_hull(points.size() + 1, 0);
  HullRun run;
  const bool solid = points.size() >= 4 && run.mark(coordinates, on_hull);
  std::vector<std::size_t> visible;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!solid || on_hull[i]) visible.push_back(i);
  return visible;
}

}  // namespace binpick

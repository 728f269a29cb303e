#include "core/zbuffer.hpp"

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

#include "core/check.hpp"

namespace binpick {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr PixelRect kNoPixels{std::numeric_limits<int>::max(), std::numeric_limits<int>::max(), 0, 0};

// Smallest integer >= x, held inside [low, high] (also for NaN, so that the conversion is always defined).
int ceil_within(double x, int low, int high) {
  if (!(x > low)) return low;
  if (x > high) return high;
  const int whole = static_cast<int>(x);
  return whole + (static_cast<double>(whole) < x ? 1 : 0);
}

// One edge of a triangle as u(v). The ends are sorted by their users, so that both triangles of a shared edge evaluate
// the very same expression and agree to the last bit.
struct Edge {
  double u, v, slope;
  double at(double row) const { return u + (row - v) * slope; }
};

}  // namespace

// 1/z over the image of a triangle whose corners are sorted downwards.
struct ZBuffer::InversePlane {
  InversePlane(const ScreenPoint& top, const ScreenPoint& middle, const ScreenPoint& bottom, double area)
      : u(top.u), v(top.v), start(top.inverse_z) {
    const double to_middle = middle.inverse_z - top.inverse_z;
    const double to_bottom = bottom.inverse_z - top.inverse_z;
    per_u = (to_middle * (bottom.v - top.v) - to_bottom * (middle.v - top.v)) / area;
    per_v = (to_bottom * (middle.u - top.u) - to_middle * (bottom.u - top.u)) / area;
    std::tie(lowest, highest) = std::minmax({top.inverse_z, middle.inverse_z, bottom.inverse_z});
  }
  double at_row(int row) const { return start + per_v * (row - v); }
  // A triangle seen almost edge-on has huge gradients: its depth still stays between those of its corners.
  double at(double row_start, int column) const {
    return std::clamp(row_start + per_u * (column - u), lowest, highest);
  }

  double u, v, start, per_u, per_v, lowest, highest;
};

ZBuffer::ZBuffer(const PinholeCamera& camera, double near) : camera_(camera), near_(near), dirty_(kNoPixels) {
  BP_CHECK(near > 0, "near " << near);
  out_.depth = Image<float>(camera.width, camera.height, kFar);
  out_.ids = Image<std::int32_t>(camera.width, camera.height, -1);
  window_ = {0, 0, camera.width, camera.height};
}

void ZBuffer::clear() {
  for (int v = dirty_.v0; v < dirty_.v1; ++v) {
    std::fill_n(&out_.depth(dirty_.u0, v), dirty_.width(), kFar);
    std::fill_n(&out_.ids(dirty_.u0, v), dirty_.width(), -1);
  }
  dirty_ = kNoPixels;
}

void ZBuffer::restrict_to(const PixelRect& window) {
  window_ = {std::max(window.u0, 0), std::max(window.v0, 0), std::min(window.u1, camera_.width),
             std::min(window.v1, camera_.height)};
}

ZBuffer::ScreenPoint ZBuffer::to_screen(const Eigen::Vector3d& p_C) const {
  const double inverse_z = 1.0 / p_C.z();
  return {camera_.fx * p_C.x() * inverse_z + camera_.cx, camera_.fy * p_C.y() * inverse_z + camera_.cy, inverse_z};
}

void ZBuffer::draw(const TriangleMesh& mesh_O, const Pose& X_CO, std::int32_t id) {
  if (window_.empty()) return;
  points_C_.resize(mesh_O.vertices.size());
  screen_.resize(mesh_O.vertices.size());
  const Eigen::Matrix3d R_CO = X_CO.linear();
  const Eigen::Vector3d p_CO = X_CO.translation();
  for (std::size_t i = 0; i < mesh_O.vertices.size(); ++i) {
    points_C_[i] = R_CO * mesh_O.vertices[i] + p_CO;
    if (points_C_[i].z() >= near_) screen_[i] = to_screen(points_C_[i]);
  }
  for (const auto& [a, b, c] : mesh_O.triangles) {
    const int in_front = (points_C_[a].z() >= near_) + (points_C_[b].z() >= near_) + (points_C_[c].z() >= near_);
    if (in_front == 3)
      fill(screen_[a], screen_[b], screen_[c], id);
    else if (in_front > 0)
      draw_triangle(points_C_[a], points_C_[b], points_C_[c], id);
  }
}

// Cuts a triangle at z = near (Sutherland-Hodgman for one plane) and fills the one or two triangles that remain.
void ZBuffer::draw_triangle(const Eigen::Vector3d& a_C, const Eigen::Vector3d& b_C, const Eigen::Vector3d& c_C,
                            std::int32_t id) {
  const std::array<Eigen::Vector3d, 3> corners{a_C, b_C, c_C};
  std::array<ScreenPoint, 4> kept{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d& p = corners[i];
    const Eigen::Vector3d& q = corners[(i + 1) % 3];
    const bool p_in = p.z() >= near_;
    const bool q_in = q.z() >= near_;
    if (p_in) kept[count++] = to_screen(p);
    if (p_in != q_in) {
      // Always from the inner to the outer end: the neighbour across this edge finds the same point.
      const Eigen::Vector3d& inner = p_in ? p : q;
      const Eigen::Vector3d& outer = p_in ? q : p;
      Eigen::Vector3d cut = inner + (outer - inner) * ((inner.z() - near_) / (inner.z() - outer.z()));
      cut.z() = near_;
      kept[count++] = to_screen(cut);
    }
  }
  for (std::size_t i = 2; i < count; ++i) fill(kept[0], kept[i - 1], kept[i], id);
}

void ZBuffer::fill(const ScreenPoint& a, const ScreenPoint& b, const ScreenPoint& c, std::int32_t id) {
  const ScreenPoint* top = &a;
  const ScreenPoint* middle = &b;
  const ScreenPoint* bottom = &c;
  const auto below = [](const ScreenPoint* p, const ScreenPoint* q) {
    return p->v > q->v || (p->v == q->v && p->u > q->u);
  };
  if (below(top, middle)) std::swap(top, middle);
  if (below(middle, bottom)) std::swap(middle, bottom);
  if (below(top, middle)) std::swap(top, middle);

  const int first_row = ceil_within(top->v, window_.v0, window_.v1);
  const int end_row = ceil_within(bottom->v, window_.v0, window_.v1);
  if (first_row >= end_row) return;
  const auto [left_u, right_u] = std::minmax({a.u, b.u, c.u});
  if (right_u <= window_.u0 || left_u > window_.u1) return;
  // Twice the signed area; positive when the middle corner lies right of the long edge.
  const double area = (middle->u - top->u) * (bottom->v - top->v) - (middle->v - top->v) * (bottom->u - top->u);
  if (!(area != 0)) return;

  const InversePlane plane(*top, *middle, *bottom, area);
  const auto edge = [](const ScreenPoint* p, const ScreenPoint* q) {
    return Edge{p->u, p->v, q->v > p->v ? (q->u - p->u) / (q->v - p->v) : 0.0};
  };
  const Edge long_edge = edge(top, bottom), upper = edge(top, middle), lower = edge(middle, bottom);
  for (int v = first_row; v < end_row; ++v) {
    const double on_long = long_edge.at(v);
    const double on_short = v < middle->v ? upper.at(v) : lower.at(v);
    const int first = ceil_within(area > 0 ? on_long : on_short, window_.u0, window_.u1);
    const int end = ceil_within(area > 0 ? on_short : on_long, window_.u0, window_.u1);
    if (first < end) fill_row(plane, v, first, end, id);
  }
}

void ZBuffer::fill_row(const InversePlane& plane, int v, int first, int end, std::int32_t id) {
  dirty_ = {std::min(dirty_.u0, first), std::min(dirty_.v0, v), std::max(dirty_.u1, end), std::max(dirty_.v1, v + 1)};
  float* depth = &out_.depth(0, v);
  std::int32_t* ids = &out_.ids(0, v);
  const double row_start = plane.at_row(v);
  for (int u = first; u < end; ++u) {
    const float z = static_cast<float>(1.0 / plane.at(row_start, u));
    if (z < depth[u]) {
      depth[u] = z;
      ids[u] = id;
    }
  }
}

}  // namespace binpick

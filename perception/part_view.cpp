#include "perception/part_view.hpp"

#include <algorithm>

#include "core/zbuffer.hpp"

namespace binpick {
namespace {

constexpr double kNear = 0.01;  // m
constexpr int kRim = 2;         // px about the part's projection

}  // namespace

PartView draw_part(const PinholeCamera& camera, const SurfaceModel& model, const Pose& X_CP) {
  PartView view;
  Eigen::Array2d low = Eigen::Array2d::Constant(1e9), high = -low;
  for (int corner = 0; corner < 8; ++corner) {
    const auto type = static_cast<Eigen::AlignedBox3f::CornerType>(corner);
    const Eigen::Vector3d p_C = X_CP * model.box().corner(type).cast<double>();
    if (!(p_C.z() > kNear)) return view;
    const Eigen::Array2d pixel = camera.project(p_C).array();
    low = low.min(pixel);
    high = high.max(pixel);
  }
  const int u0 = std::max(0, static_cast<int>(std::max(low.x(), -1e6)) - kRim);
  const int v0 = std::max(0, static_cast<int>(std::max(low.y(), -1e6)) - kRim);
  const int u1 = std::min(camera.width - 1, static_cast<int>(std::min(high.x(), 1e6)) + kRim);
  const int v1 = std::min(camera.height - 1, static_cast<int>(std::min(high.y(), 1e6)) + kRim);
  if (u1 <= u0 || v1 <= v0) return view;
  PinholeCamera crop = camera;
  crop.width = u1 - u0 + 1;
  crop.height = v1 - v0 + 1;
  crop.cx -= u0;
  crop.cy -= v0;
  ZBuffer buffer(crop, kNear);
  buffer.draw(model.shell_facing(X_CP.inverse() * Eigen::Vector3d::Zero()), X_CP, 0);
  view.u0 = u0;
  view.v0 = v0;
  view.depth = buffer.result().depth;
  for (const float z : view.depth) view.pixels += std::isfinite(z);
  return view;
}

std::vector<OutlinePixel> outline_of(const PartView& view) {
  std::vector<OutlinePixel> out;
  for (int v = view.v0; v < view.v0 + view.depth.height(); ++v)
    for (int u = view.u0; u < view.u0 + view.depth.width(); ++u) {
      if (!view.inside(u, v)) continue;
      if (view.inside(u - 1, v) && view.inside(u + 1, v) && view.inside(u, v - 1) && view.inside(u, v + 1)) continue;
      Eigen::Vector2f outward = Eigen::Vector2f::Zero();
      for (int b = -3; b <= 3; ++b)
        for (int a = -3; a <= 3; ++a)
          if (!view.inside(u + a, v + b)) outward += Eigen::Vector2f(static_cast<float>(a), static_cast<float>(b));
      if (outward.squaredNorm() < 1) continue;  // a spike, open on both sides: no direction
      out.push_back({u, v, view.at(u, v), outward.normalized()});
    }
  return out;
}

}  // namespace binpick

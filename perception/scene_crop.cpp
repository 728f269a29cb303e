#include "perception/scene_crop.hpp"

#include <algorithm>

namespace binpick {
namespace {

constexpr double kNear = 0.05;  // m, nearer corners have no place in the image
constexpr int kRim = 8;         // px, past what the checks look at beside a part

void include(PixelBox& box, int u, int v) {
  box.u0 = std::min(box.u0, u), box.v0 = std::min(box.v0, v);
  box.u1 = std::max(box.u1, u + 1), box.v1 = std::max(box.v1, v + 1);
}

PixelBox within(const PixelBox& box, const PinholeCamera& camera) {
  return {std::max(0, box.u0 - kRim), std::max(0, box.v0 - kRim), std::min(camera.width, box.u1 + kRim),
          std::min(camera.height, box.v1 + kRim)};
}

/// The projection of the bin's eight corners; false when one is behind the camera.
bool project_bin(const PinholeCamera& camera, const BinSpec& bin, const Pose& X_CB, double margin, PixelBox& box) {
  for (int corner = 0; corner < 8; ++corner) {
    const double x = bin.rim_size().x() / 2 + margin, y = bin.rim_size().y() / 2 + margin;
    const Eigen::Vector3d p_B(corner & 1 ? x : -x, corner & 2 ? y : -y,
                              corner & 4 ? bin.inner_size.z() + margin : -margin);
    const Eigen::Vector3d p_C = X_CB * p_B;
    if (!(p_C.z() > kNear)) return false;
    const Eigen::Vector2d pixel = camera.project(p_C).cwiseMax(-1e6).cwiseMin(1e6);
    include(box, static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
  }
  return true;
}

}  // namespace

BinRays bin_rays(const PinholeCamera& camera, const Pose& X_CB) {
  const Pose X_BC = X_CB.inverse();
  const Eigen::Matrix3d& R = X_BC.linear();
  const Eigen::Vector3d a = R * Eigen::Vector3d(-camera.cx / camera.fx, -camera.cy / camera.fy, 1);
  BinRays rays;
  for (int k = 0; k < 3; ++k) {
    rays.a[k] = static_cast<float>(a[k]);
    rays.b[k] = static_cast<float>(R(k, 0) / camera.fx);
    rays.c[k] = static_cast<float>(R(k, 1) / camera.fy);
    rays.t[k] = static_cast<float>(X_BC.translation()[k]);
  }
  return rays;
}

PixelBox pixels_of_bin(const DepthFrame& frame, const BinSpec& bin, const Pose& X_CB, double margin, double headroom) {
  const int width = frame.depth.width(), height = frame.depth.height();
  PixelBox box{width, height, 0, 0};
  if (!project_bin(frame.camera, bin, X_CB, margin, box)) return {0, 0, width, height};
  const BinRays rays = bin_rays(frame.camera, X_CB);
  const auto f = [](double x) { return static_cast<float>(x); };
  const BinBox above{f(bin.rim_size().x() / 2), f(bin.rim_size().y() / 2), f(bin.inner_size.z()),
                     f(bin.inner_size.z() + headroom)};
  for (int v = 0; v < height; ++v) {
    int first = 0, last = 0;
    if (!inside_span({&frame.depth(0, v), v, width}, rays, above, first, last)) continue;
    include(box, first, v);
    include(box, last, v);
  }
  box = within(box, frame.camera);
  return box.u1 - box.u0 >= 16 && box.v1 - box.v0 >= 16 ? box : PixelBox{0, 0, width, height};
}

DepthFrame cropped(const DepthFrame& frame, const PixelBox& box) {
  DepthFrame out;
  out.camera = frame.camera;
  out.camera.width = box.u1 - box.u0;
  out.camera.height = box.v1 - box.v0;
  out.camera.cx -= box.u0;
  out.camera.cy -= box.v0;
  out.X_WC = frame.X_WC;
  out.noise = frame.noise;
  out.depth = Image<float>(out.camera.width, out.camera.height);
  for (int v = 0; v < out.camera.height; ++v)
    std::copy_n(&frame.depth(box.u0, box.v0 + v), out.camera.width, &out.depth(0, v));
  return out;
}

}  // namespace binpick

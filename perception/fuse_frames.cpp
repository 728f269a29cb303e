#include "perception/fuse_frames.hpp"

#include <limits>

#include "core/check.hpp"
#include "perception/floor_offset.hpp"

namespace binpick {

PointCloud cloud_with_normals(const DepthFrame& frame, const NormalsConfig& config) {
  Scene scene;
  scene.camera = frame.camera;
  scene.depth = frame.depth;
  scene.noise = frame.noise;
  scene.wanted = Image<std::uint8_t>(frame.depth.width(), frame.depth.height(), 0);
  for (std::size_t i = 0; i < frame.depth.size(); ++i) scene.wanted[i] = frame.depth[i] > 0;  // not NaN
  scene.normals = Image<Eigen::Vector3f>(frame.depth.width(), frame.depth.height(), Eigen::Vector3f::Zero());
  estimate_normals(scene, config);
  PointCloud cloud_C;
  for (int v = 0; v < frame.depth.height(); ++v)
    for (int u = 0; u < frame.depth.width(); ++u) {
      if (!scene.wanted(u, v)) continue;
      cloud_C.points.push_back(frame.camera.unproject(u, v, frame.depth(u, v)));
      cloud_C.normals.push_back(scene.normals(u, v).cast<double>());
    }
  return cloud_C;
}

namespace {

DepthFrame without_offset(const DepthFrame& frame, const KnownBin& bin) {
  Scene scene;
  scene.camera = frame.camera;
  scene.depth = frame.depth;
  scene.noise = frame.noise;
  scene.bin = bin.spec;
  scene.X_CB = frame.X_WC.inverse() * bin.X_WB;
  const auto offset = static_cast<float>(floor_offset(scene, bin.largest_offset));
  DepthFrame corrected = frame;
  for (float& z : corrected.depth) {
    const float inverse = 1 / z - offset;
    z = inverse > 0 ? 1 / inverse : std::numeric_limits<float>::quiet_NaN();
  }
  return corrected;
}

}  // namespace

PointCloud fuse_frames(std::span<const DepthFrame> frames, const NormalsConfig& config,
                       const std::optional<KnownBin>& bin) {
  BP_CHECK(!frames.empty());
  const auto rounded = [](const Eigen::Vector3d& v) { return Eigen::Vector3d(v.cast<float>().cast<double>()); };
  PointCloud fused_C;
  for (const DepthFrame& frame : frames) {
    const Pose X_CK = frames.front().X_WC.inverse() * frame.X_WC;
    const PointCloud cloud_C = transformed(X_CK, cloud_with_normals(bin ? without_offset(frame, *bin) : frame, config));
    for (const Eigen::Vector3d& p : cloud_C.points) fused_C.points.push_back(rounded(p));
    for (const Eigen::Vector3d& n : cloud_C.normals) fused_C.normals.push_back(rounded(n));
  }
  return fused_C;
}

}  // namespace binpick

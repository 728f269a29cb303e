#include "perception/fuse_frames.hpp"

#include <cmath>

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

}  // namespace binpick

#include "tools/bench/perception_view.hpp"

#include <utility>

namespace binpick {
namespace {

Pose misplaced_bin(const Pose& X_CB, const ViewTrouble& trouble, Seed seed) {
  Rng rng = seed.child("bin").rng();
  const Eigen::Vector3d offset_B = trouble.bin_offset * rng.unit_vector();
  const Eigen::AngleAxisd turn(trouble.bin_turn, rng.unit_vector());
  return X_CB * Eigen::Translation3d(offset_B) * turn;
}

}  // namespace

SceneView troubled(SceneView view, const ViewTrouble& trouble, Seed seed) {
  if (trouble.bin_offset != 0 || trouble.bin_turn != 0) view.X_CB = misplaced_bin(view.X_CB, trouble, seed);
  if (trouble.no_bin) view.bin.reset();
  if (const auto* frame = std::get_if<DepthFrame>(&view.seen); frame && trouble.as_cloud) {
    PointCloud cloud_C = unproject(*frame);
    seed.child("order").rng().shuffle(cloud_C.points);
    view.cloud_noise = frame->noise;
    view.seen = std::move(cloud_C);
  }
  return view;
}

}  // namespace binpick

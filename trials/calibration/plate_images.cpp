#include "trials/calibration/plate_images.hpp"

#include "core/primitive.hpp"

namespace binpick {
namespace {

constexpr double kThickness = 0.004;  // m

}  // namespace

PlateImages::PlateImages(const MarkerPlate& plate, const std::string& renderer)
    : plate_(plate), renderer_(make_renderer(renderer)) {
  item_.mesh_O = std::make_shared<const TriangleMesh>(mesh_of(
      Primitive::box({plate.edge(), plate.edge(), kThickness}, Pose(Eigen::Translation3d(0, 0, -kThickness / 2)))));
  item_.id = 1;
  item_.texture = std::make_shared<const SurfaceTexture>(plate.texture());
}

PlateImages::~PlateImages() = default;

// The camera stands at the world's origin: only where the plate is before it counts.
Image<std::uint8_t> PlateImages::image(const Pose& X_CQ, const PinholeCamera& camera, Seed seed) const {
  RenderScene scene;
  scene.items.push_back(item_);
  scene.items.back().X_WO = X_CQ;
  GreyCamera grey;
  grey.intrinsics = camera;
  return capture_grey(*renderer_, scene, grey, {}, seed);
}

std::vector<SeenCorner> PlateImages::corners(const Pose& X_CQ, const PinholeCamera& camera, Seed seed) const {
  return find_corners(image(X_CQ, camera, seed), plate_);
}

}  // namespace binpick

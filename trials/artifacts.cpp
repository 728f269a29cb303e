#include "trials/artifacts.hpp"

#include <algorithm>
#include <cmath>

#include "core/file_io.hpp"

namespace binpick {
namespace {

// A camera at `eye` that looks at `target`, upright.
Pose looking_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target) {
  const Eigen::Vector3d z = (target - eye).normalized(), x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Matrix3d R;
  R << x, z.cross(x), z;
  return pose_from(R, eye);
}

// From beside and above the bin, looking at its middle.
Pose bystander(const Cell& cell) {
  const Eigen::Vector3d target = cell.X_WB * Eigen::Vector3d(0, 0, 0.3 * cell.bin.inner_size.z());
  const double away = 1.9 * cell.bin.inner_size.head<2>().maxCoeff();
  return looking_at(target + away * Eigen::Vector3d(0.55, -0.55, 1.25), target);
}

// From close by, a little above the lips: does the cup touch what it lifts?
Pose beside_tip(const CellWorld& cell_world) {
  const Eigen::Vector3d tip = cell_world.cell().tip_pose(cell_world.joints()).translation();
  return looking_at(tip + Eigen::Vector3d(0.17, -0.20, 0.08), tip);
}

PinholeCamera bystander_camera() { return {960, 640, 900, 900, 479.5, 319.5}; }

}  // namespace

double noise_scale(const StatedNoise& noise, double z) {
  constexpr double kWithoutSheet = 1e-3;
  return noise.sigma(z) > 0 ? 3 * noise.sigma(z) : kWithoutSheet;
}

Image<Rgb> noise_picture(const DepthFrame& frame, const Image<float>& exact_depth) {
  Image<Rgb> picture(frame.depth.width(), frame.depth.height(), Rgb{0, 0, 0});
  for (std::size_t i = 0; i < picture.size(); ++i) {
    const double z = exact_depth[i], seen = frame.depth[i];
    if (!std::isfinite(z)) {
      if (std::isfinite(seen)) picture[i] = {255, 0, 255};
      continue;
    }
    if (!std::isfinite(seen)) {
      picture[i] = {90, 90, 90};
      continue;
    }
    const double t = std::clamp((seen - z) / noise_scale(frame.noise, z), -1.0, 1.0);
    const auto fading = static_cast<std::uint8_t>(std::lround(255 * (1 - std::abs(t))));
    picture[i] = t > 0 ? Rgb{255, fading, fading} : Rgb{fading, fading, 255};
  }
  return picture;
}

std::string TrialPictures::path(int pick, const std::string& name) const {
  char prefix[16];
  std::snprintf(prefix, sizeof prefix, "%02d_", pick);
  return folder_ + "/" + prefix + name;
}

void TrialPictures::save(int pick, const std::string& name, const Image<Rgb>& image) {
  make_folder(folder_);
  write_png(path(pick, name + ".png"), image);
  files_.push_back(path(pick, name + ".png"));
}

void TrialPictures::frame(int pick, const FrameRequest& request, const SceneView& view, const EstimateResult& found) {
  if (pick >= looks_) return;
  write_frame_folder(path(pick, "frame"), request, view);
  write_file(path(pick, "frame") + "/estimates.csv", estimates_csv(found));
}

void TrialPictures::look(int pick, const std::string& prefix, DepthRenderer& renderer, const CellWorld& cell_world,
                         const DepthFrame& frame, const EstimateResult& found) {
  if (pick >= looks_) return;
  const RenderScene scene = cell_world.render_scene();
  save(pick, prefix + "heap", renderer.picture(scene, bystander_camera(), bystander(cell_world.cell())));
  save(pick, prefix + "depth", depth_picture(frame));
  const Image<Rgb> from_camera =
      renderer.picture(scene, frame.camera, cell_world.cell().camera_pose(cell_world.joints()));
  save(pick, prefix + "estimates", overlay_picture(from_camera, frame, found.estimates, cell_world.parts()));
}

void TrialPictures::moment(int pick, const char* name, DepthRenderer& renderer, const CellWorld& cell_world) {
  if (pick >= looks_ && std::string(name) != "failed") return;
  const bool close = std::string(name) == "lifted";
  const Pose X_WC = close ? beside_tip(cell_world) : bystander(cell_world.cell());
  save(pick, name, renderer.picture(cell_world.render_scene(), bystander_camera(), X_WC));
}

}  // namespace binpick

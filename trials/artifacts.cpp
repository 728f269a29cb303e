#include "trials/artifacts.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/file_io.hpp"
#include "core/zbuffer.hpp"

namespace binpick {
namespace {

cv::Mat view_of(Image<Rgb>& image) { return {image.height(), image.width(), CV_8UC3, image.data()}; }

// Calm, well separated tints, by rank.
cv::Scalar tint(std::size_t rank) {
  static const cv::Scalar kTints[] = {{46, 204, 113}, {52, 152, 219}, {241, 196, 15}, {231, 76, 60},  {155, 89, 182},
                                      {26, 188, 156}, {230, 126, 34}, {236, 64, 122}, {124, 179, 66}, {121, 134, 203}};
  return kTints[rank % std::size(kTints)];
}

ZBuffer drawn(const DepthFrame& frame, const std::vector<PoseEstimate>& estimates, std::span<const Part> parts) {
  ZBuffer buffer(frame.camera);
  for (std::size_t i = 0; i < estimates.size(); ++i)
    buffer.draw(parts[estimates[i].part].mesh_P, estimates[i].X_CP, static_cast<std::int32_t>(i));
  return buffer;
}

bool on_outline(const Image<std::int32_t>& ids, int u, int v) {
  const std::int32_t here = ids(u, v);
  for (int dv = -1; dv <= 1; ++dv)
    for (int du = -1; du <= 1; ++du)
      if (!ids.contains(u + du, v + dv) || ids(u + du, v + dv) != here) return true;
  return false;
}

void label(cv::Mat& canvas, const std::string& text, const cv::Point& at, const cv::Scalar& colour) {
  cv::putText(canvas, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.45, cv::Scalar(0, 0, 0), 3, cv::LINE_AA);
  cv::putText(canvas, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.45, colour, 1, cv::LINE_AA);
}

// Where the drawn pixels of an estimate lie, for its label.
cv::Point centre_of(const Image<std::int32_t>& ids, std::int32_t id) {
  long long sum_u = 0, sum_v = 0, count = 0;
  for (int v = 0; v < ids.height(); ++v)
    for (int u = 0; u < ids.width(); ++u)
      if (ids(u, v) == id) sum_u += u, sum_v += v, ++count;
  if (count == 0) return {-100, -100};
  return {static_cast<int>(sum_u / count) - 8, static_cast<int>(sum_v / count) + 5};
}

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

Image<Rgb> depth_picture(const DepthFrame& frame) {
  std::vector<float> valid;
  for (const float z : frame.depth)
    if (std::isfinite(z)) valid.push_back(z);
  Image<Rgb> picture(frame.depth.width(), frame.depth.height(), Rgb{0, 0, 0});
  if (valid.empty()) return picture;
  std::sort(valid.begin(), valid.end());
  const float near = valid[valid.size() / 100], far = valid[valid.size() - 1 - valid.size() / 100];
  cv::Mat grey(picture.height(), picture.width(), CV_8UC1, cv::Scalar(0)), colours;
  for (std::size_t i = 0; i < frame.depth.size(); ++i)
    if (std::isfinite(frame.depth[i]))
      grey.data[i] =
          static_cast<std::uint8_t>(std::clamp((far - frame.depth[i]) / std::max(far - near, 1e-6f), 0.f, 1.f) * 255);
  cv::applyColorMap(grey, colours, cv::COLORMAP_TURBO);
  for (std::size_t i = 0; i < picture.size(); ++i) {
    const auto* bgr = colours.data + 3 * i;
    if (std::isfinite(frame.depth[i])) picture[i] = {bgr[2], bgr[1], bgr[0]};
  }
  return picture;
}

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

Image<Rgb> overlay_picture(const Image<Rgb>& base, const DepthFrame& frame, const std::vector<PoseEstimate>& estimates,
                           std::span<const Part> parts) {
  const ZBuffer buffer = drawn(frame, estimates, parts);
  const Image<std::int32_t>& ids = buffer.result().ids;
  Image<Rgb> picture = base;
  for (int v = 0; v < ids.height(); ++v)
    for (int u = 0; u < ids.width(); ++u) {
      if (ids(u, v) < 0) continue;
      const cv::Scalar colour = tint(static_cast<std::size_t>(ids(u, v)));
      const double weight = on_outline(ids, u, v) ? 1.0 : 0.30;
      for (int c = 0; c < 3; ++c)
        picture(u, v)[c] = static_cast<std::uint8_t>((1 - weight) * picture(u, v)[c] + weight * colour[c]);
    }
  cv::Mat canvas = view_of(picture);
  for (std::size_t i = 0; i < estimates.size(); ++i)
    label(canvas, std::to_string(i + 1), centre_of(ids, static_cast<std::int32_t>(i)), cv::Scalar(255, 255, 255));
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

void TrialPictures::look(int pick, DepthRenderer& renderer, const CellWorld& cell_world, const DepthFrame& frame,
                         const EstimateResult& found) {
  if (pick >= looks_) return;
  const RenderScene scene = cell_world.render_scene();
  save(pick, "heap", renderer.picture(scene, bystander_camera(), bystander(cell_world.cell())));
  save(pick, "depth", depth_picture(frame));
  const Image<Rgb> from_camera = renderer.picture(scene, frame.camera, frame.X_WC);
  save(pick, "estimates", overlay_picture(from_camera, frame, found.estimates, cell_world.parts()));
}

void TrialPictures::moment(int pick, const char* name, DepthRenderer& renderer, const CellWorld& cell_world) {
  if (pick >= looks_ && std::string(name) != "failed") return;
  const bool close = std::string(name) == "lifted";
  const Pose X_WC = close ? beside_tip(cell_world) : bystander(cell_world.cell());
  save(pick, name, renderer.picture(cell_world.render_scene(), bystander_camera(), X_WC));
}

}  // namespace binpick

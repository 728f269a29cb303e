#include "perception/overlay.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

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

}  // namespace binpick

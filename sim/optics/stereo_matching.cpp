#include "sim/optics/stereo_matching.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>

#include "sim/optics/subpixel_fit.hpp"

namespace binpick {
namespace {

constexpr int kSteps = 16;          // of an OpenCV disparity, per pixel
constexpr int kGradientLimit = 31;  // keeps every cost sum below the 16-bit limit: 7 x 7 x (62 + 63) + P2, three paths
constexpr int kIslandStep = 1;      // px between neighbours of one island

// The matcher gives nothing in its first `disparities` columns. A dark margin of that width moves the loss out of the
// picture; what the right imager does not see is taken out afterwards.
cv::Mat with_margin(const Image<std::uint8_t>& image, int margin) {
  cv::Mat wide(image.height(), image.width() + margin, CV_8UC1, cv::Scalar(0));
  for (int v = 0; v < image.height(); ++v)
    std::copy(&image(0, v), &image(0, v) + image.width(), wide.ptr<std::uint8_t>(v) + margin);
  return wide;
}

cv::Mat semi_global(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right, const StereoMatching& how) {
  const int area = how.block * how.block;
  const auto matcher = cv::StereoSGBM::create(0, how.disparities, how.block, how.p1 * area, how.p2 * area,
                                              how.left_right, kGradientLimit, how.uniqueness, how.speckle_size,
                                              kIslandStep, cv::StereoSGBM::MODE_SGBM_3WAY);
  cv::Mat result;
  matcher->compute(with_margin(left, how.disparities), with_margin(right, how.disparities), result);
  return result;
}

}  // namespace

Image<float> match_pair(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right, const StereoMatching& how,
                        int threads) {
  const cv::Mat found = semi_global(left, right, how);
  Image<float> disparity(left.width(), left.height(), std::numeric_limits<float>::quiet_NaN());
  for (int v = 0; v < left.height(); ++v) {
    const short* row = found.ptr<short>(v) + how.disparities;
    for (int u = 0; u < left.width(); ++u) {
      const double d = static_cast<double>(row[u]) / kSteps;
      if (d > 0 && u - d >= -0.5) disparity(u, v) = static_cast<float>(d);
    }
  }
  drop_plain(left, how, disparity);
  fit_subpixel(left, right, how.block, disparity, threads);
  return disparity;
}

}  // namespace binpick

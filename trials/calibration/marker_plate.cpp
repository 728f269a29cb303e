#include "trials/calibration/marker_plate.hpp"

#include <array>
#include <opencv2/aruco.hpp>
#include <opencv2/calib3d.hpp>

#include "core/check.hpp"

namespace binpick {
namespace {

constexpr int kCells = 6;           // of a 4x4 marker with its black border
constexpr int kTexelsPerCell = 20;  // the texture's edges stay sharp at any distance

cv::Ptr<cv::aruco::Dictionary> dictionary() { return cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50); }

Eigen::Vector2d centre_of(const MarkerPlate& plate, int marker) {
  const double middle = (plate.rows - 1) / 2.0;
  return {(marker % plate.rows - middle) * plate.pitch, (middle - marker / plate.rows) * plate.pitch};
}

/// OpenCV's camera frame is ours; its pinhole is ours after the lens is taken out.
struct Correspondences {
  std::vector<cv::Point3d> plate_Q;
  std::vector<cv::Point2d> pixels;
  cv::Matx33d camera;
};

Correspondences correspondences(const std::vector<SeenCorner>& corners, const MarkerPlate& plate,
                                const PinholeCamera& camera, const LensDistortion& lens) {
  Correspondences result;
  const std::vector<Eigen::Vector3d> corners_Q = plate.corners_Q();
  for (const SeenCorner& corner : corners) {
    BP_CHECK(corner.index < corners_Q.size(), corner.index);
    const Eigen::Vector3d& p = corners_Q[corner.index];
    const Eigen::Vector3d ideal = ray(camera, lens, corner.pixel.x(), corner.pixel.y());
    const Eigen::Vector2d pixel = camera.project(ideal);
    result.plate_Q.emplace_back(p.x(), p.y(), p.z());
    result.pixels.emplace_back(pixel.x(), pixel.y());
  }
  result.camera = {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
  return result;
}

struct CvPose {
  cv::Mat rotation, translation;
};

CvPose refined(const Correspondences& c, CvPose start) {
  const cv::TermCriteria until(cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 50, 1e-14);
  cv::solvePnPRefineLM(c.plate_Q, c.pixels, c.camera, cv::noArray(), start.rotation, start.translation, until);
  return start;
}

double squared_error(const Correspondences& c, const CvPose& pose) {
  std::vector<cv::Point2d> seen;
  cv::projectPoints(c.plate_Q, pose.rotation, pose.translation, c.camera, cv::noArray(), seen);
  double sum = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) sum += (seen[i] - c.pixels[i]).dot(seen[i] - c.pixels[i]);
  return sum;
}

Pose to_pose(const CvPose& pose) {
  const auto vector = [](const cv::Mat& m) {
    return Eigen::Vector3d(m.at<double>(0), m.at<double>(1), m.at<double>(2));
  };
  return pose_from(exp_so3(vector(pose.rotation)), vector(pose.translation));
}

CvPose to_cv(const Pose& X_CQ) {
  const Eigen::Vector3d r = log_so3(X_CQ.linear()), t = X_CQ.translation();
  return {(cv::Mat_<double>(3, 1) << r.x(), r.y(), r.z()), (cv::Mat_<double>(3, 1) << t.x(), t.y(), t.z())};
}

}  // namespace

double MarkerPlate::edge() const { return (rows - 1) * pitch + 2 * marker; }

std::vector<Eigen::Vector3d> MarkerPlate::corners_Q() const {
  std::vector<Eigen::Vector3d> corners;
  const double half = marker / 2;
  for (int m = 0; m < rows * rows; ++m)
    for (const auto& [x, y] : {std::pair{-half, half}, {half, half}, {half, -half}, {-half, -half}})
      corners.push_back({centre_of(*this, m).x() + x, centre_of(*this, m).y() + y, 0});
  return corners;
}

SurfaceTexture MarkerPlate::texture() const {
  const double texel = marker / (kCells * kTexelsPerCell);
  const int side = static_cast<int>(std::lround(edge() / texel));
  Image<std::uint8_t> image(side, side, 255);
  for (int m = 0; m < rows * rows; ++m) {
    cv::Mat drawn;
    cv::aruco::drawMarker(dictionary(), m, kCells * kTexelsPerCell, drawn, 1);
    const Eigen::Vector2d corner = centre_of(*this, m) + Eigen::Vector2d(-marker, marker) / 2;  // upper left
    const int left = static_cast<int>(std::lround((corner.x() + edge() / 2) / texel));
    const int top = static_cast<int>(std::lround((edge() / 2 - corner.y()) / texel));
    for (int v = 0; v < drawn.rows; ++v)
      for (int u = 0; u < drawn.cols; ++u) image(left + u, top + v) = drawn.at<std::uint8_t>(v, u);
  }
  return {image, Eigen::Vector2d::Constant(side * texel)};
}

std::vector<SeenCorner> find_corners(const Image<std::uint8_t>& image, const MarkerPlate& plate) {
  const cv::Mat picture(image.height(), image.width(), CV_8UC1, const_cast<std::uint8_t*>(image.data()));
  const cv::Ptr<cv::aruco::DetectorParameters> parameters = cv::aruco::DetectorParameters::create();
  parameters->cornerRefinementMethod = cv::aruco::CORNER_REFINE_SUBPIX;
  std::vector<std::vector<cv::Point2f>> found;
  std::vector<int> ids;
  cv::aruco::detectMarkers(picture, dictionary(), found, ids, parameters);
  std::vector<SeenCorner> corners;
  for (std::size_t m = 0; m < ids.size(); ++m) {
    if (ids[m] < 0 || ids[m] >= plate.rows * plate.rows) continue;
    for (std::size_t k = 0; k < 4; ++k)
      corners.push_back({static_cast<std::size_t>(4 * ids[m]) + k, {found[m][k].x, found[m][k].y}});
  }
  return corners;
}

std::vector<SeenCorner> projected_corners(const MarkerPlate& plate, const Pose& X_CQ, const PinholeCamera& camera,
                                          const LensDistortion& lens) {
  std::vector<SeenCorner> corners;
  const std::vector<Eigen::Vector3d> corners_Q = plate.corners_Q();
  for (std::size_t i = 0; i < corners_Q.size(); ++i) {
    const Eigen::Vector3d p_C = X_CQ * corners_Q[i];
    BP_CHECK(p_C.z() > 0, "the plate lies behind the camera");
    const Eigen::Vector2d pixel = project(camera, lens, p_C);
    if ((pixel.array() < 0).any() || pixel.x() > camera.width - 1 || pixel.y() > camera.height - 1) continue;
    corners.push_back({i, pixel});
  }
  return corners;
}

std::optional<Pose> plate_pose(const std::vector<SeenCorner>& corners, const MarkerPlate& plate,
                               const PinholeCamera& camera, const LensDistortion& lens) {
  if (corners.size() < 4) return std::nullopt;
  const Correspondences c = correspondences(corners, plate, camera, lens);
  std::vector<cv::Mat> rotations, translations;
  cv::solvePnPGeneric(c.plate_Q, c.pixels, c.camera, cv::noArray(), rotations, translations, false, cv::SOLVEPNP_IPPE);
  // IPPE of OpenCV 4.6 answers NaN now and then, also for exact corners.
  cv::Mat rotation, translation;
  if (cv::solvePnP(c.plate_Q, c.pixels, c.camera, cv::noArray(), rotation, translation))
    rotations.push_back(rotation), translations.push_back(translation);
  std::optional<CvPose> best;
  double least = 0;
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    if (!cv::checkRange(rotations[i]) || !cv::checkRange(translations[i])) continue;
    const CvPose pose = refined(c, {rotations[i], translations[i]});
    const double error = squared_error(c, pose);
    if (!std::isfinite(error) || (best && error >= least)) continue;
    best = pose;
    least = error;
  }
  if (!best) return std::nullopt;
  return to_pose(*best);
}

Pose refined_plate_pose(const std::vector<SeenCorner>& corners, const MarkerPlate& plate, const PinholeCamera& camera,
                        const LensDistortion& lens, const Pose& X_CQ) {
  return to_pose(refined(correspondences(corners, plate, camera, lens), to_cv(X_CQ)));
}

}  // namespace binpick

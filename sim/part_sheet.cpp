#include "sim/part_sheet.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "core/primitive.hpp"

namespace binpick {
namespace {

constexpr int kWidth = 1600, kHeight = 1000, kBorder = 20;
constexpr int kPoses = 5;
constexpr double kRadius = 0.15;  // m: every part is drawn this big, so that shadows and corners look alike
const cv::Scalar kInk(40, 44, 52), kFaint(120, 126, 134);
const Eigen::Vector3d kView = Eigen::Vector3d(0.62, -1.0, 0.72).normalized();  // from the part to the eye

cv::Mat view_of(Image<Rgb>& image) { return {image.height(), image.width(), CV_8UC3, image.data()}; }

void write(cv::Mat& page, const std::string& text, const cv::Point& at, double size, const cv::Scalar& ink = kInk) {
  cv::putText(page, text, at, cv::FONT_HERSHEY_SIMPLEX, size, ink, size > 0.8 ? 2 : 1, cv::LINE_AA);
}

/// Looks along -kView at the origin, which is seen in the middle; a ball of kRadius * `fill` fits the shorter edge.
struct Panel {
  PinholeCamera camera;
  Pose X_WC = Pose::Identity();

  Panel(int width, int height, double fill, const Eigen::Vector3d& target_W = Eigen::Vector3d::Zero()) {
    const double distance = 12 * kRadius;  // far: hardly any perspective
    camera.width = width;
    camera.height = height;
    camera.fx = camera.fy = 0.5 * std::min(width, height) * distance / (kRadius * fill);
    camera.cx = 0.5 * (width - 1);
    camera.cy = 0.5 * (height - 1);
    const Eigen::Vector3d z = -kView, x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
    Eigen::Matrix3d R_WC;
    R_WC << x, z.cross(x), z;
    X_WC = pose_from(R_WC, target_W + distance * kView);
  }
  cv::Point at(const Eigen::Vector3d& p_W) const {
    const Eigen::Vector2d p = camera.project(X_WC.inverse() * p_W);
    return {static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y()))};
  }
};

class Painter {
 public:
  Painter(const PartSheet& sheet, DepthRenderer& renderer)
      : sheet_(sheet),
        renderer_(renderer),
        center_P_(sheet.part.box_center_P),
        scale_(2 * kRadius / sheet.part.diameter),
        image_(kWidth, kHeight, Rgb{255, 255, 255}),
        page_(view_of(image_)) {}

  Image<Rgb> paint() {
    write(page_, sheet_.part.name, {kBorder, 46}, 1.2);
    const int width = (kWidth - 4 * kBorder) / 3, height = 400, top = 70;
    const auto left = [&](int column) { return kBorder + column * (width + kBorder); };
    mesh_panel({left(0), top, width, height});
    pieces_panel({left(1), top, width, height}, 0);
    pieces_panel({left(2), top, width, height}, 0.45);
    caption("mesh; mass frame (x red, y green, z blue); symmetry axes", left(0), top + height);
    caption(std::to_string(sheet_.shape.pieces_P.size()) + " convex pieces", left(1), top + height);
    caption("the pieces, drawn apart", left(2), top + height);
    poses_row(515, 240);
    text_columns(842);
    return std::move(image_);
  }

 private:
  void caption(const std::string& text, int x, int y) { write(page_, text, {x, y + 22}, 0.5, kFaint); }

  /// A mesh of the part around the origin, in drawing size; moved by `shift_P` first.
  std::shared_ptr<const TriangleMesh> drawn(const TriangleMesh& mesh_P, const Eigen::Vector3d& shift_P) const {
    auto mesh = std::make_shared<TriangleMesh>(mesh_P);
    for (Eigen::Vector3d& v : mesh->vertices) v = scale_ * (v + shift_P - center_P_);
    return mesh;
  }
  Eigen::Vector3d drawn_at(const Eigen::Vector3d& p_P) const { return scale_ * (p_P - center_P_); }

  void paste(const RenderScene& scene, const Panel& panel, const cv::Rect& where) {
    Image<Rgb> picture = renderer_.picture(scene, panel.camera, panel.X_WC);
    view_of(picture).copyTo(page_(where));
  }

  void mesh_panel(const cv::Rect& where) {
    const Panel panel(where.width, where.height, 1.15);
    paste({{{drawn(sheet_.part.mesh_P, {0, 0, 0}), Pose::Identity(), 0, {}}}}, panel, where);
    cv::Mat area = page_(where);
    std::vector<SymmetryAxis> axes = symmetry_axes(sheet_.part.symmetry);
    // Of many axes of one order the first says it all.
    if (axes.size() > 6) axes.resize(2);
    for (const SymmetryAxis& axis : axes) {
      const Eigen::Vector3d middle =
          drawn_at(axis.point_P + axis.direction_P.dot(center_P_ - axis.point_P) * axis.direction_P);
      for (int dash = -13; dash <= 13; dash += 2) {
        const auto end = [&](double at) { return panel.at(middle + at / 13 * 1.12 * kRadius * axis.direction_P); };
        cv::line(area, end(dash - 0.7), end(dash + 0.7), cv::Scalar(20, 20, 20), 1, cv::LINE_AA);
      }
      const cv::Point tip = panel.at(middle + 1.17 * kRadius * axis.direction_P);
      write(area, axis.order == 0 ? "any turn" : "1/" + std::to_string(axis.order), tip + cv::Point(4, 0), 0.45);
    }
    mass_frame(area, panel);
  }

  void mass_frame(cv::Mat& area, const Panel& panel) const {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(sheet_.part.mass.inertia_P);
    Eigen::Matrix3d axes = solver.eigenvectors();
    if (axes.determinant() < 0) axes.col(2) = -axes.col(2);
    const cv::Scalar colours[] = {{214, 48, 38}, {38, 140, 58}, {38, 84, 210}};
    const Eigen::Vector3d origin = drawn_at(sheet_.part.mass.center_P);
    for (Eigen::Index k = 0; k < 3; ++k)
      cv::arrowedLine(area, panel.at(origin), panel.at(origin + 0.4 * kRadius * axes.col(k)), colours[k], 2,
                      cv::LINE_AA, 0, 0.15);
    cv::circle(area, panel.at(origin), 4, kInk, cv::FILLED, cv::LINE_AA);
  }

  void pieces_panel(const cv::Rect& where, double apart) {
    RenderScene scene;
    std::int32_t id = 0;
    for (const TriangleMesh& piece : sheet_.shape.pieces_P) {
      const Eigen::Vector3d shift = apart * (bounding_box(piece).center() - center_P_);
      scene.items.push_back({drawn(piece, shift), Pose::Identity(), id++, {}});
    }
    paste(scene, Panel(where.width, where.height, 1.15 * (1 + 0.7 * apart)), where);
  }

  /// The pose on the floor, turned about z so that its longest side faces the eye.
  Pose facing(const StablePose& pose) const {
    Eigen::Matrix2d moments = Eigen::Matrix2d::Zero();
    const std::vector<Eigen::Vector3d> hull = hull_vertices(sheet_.part.mesh_P);
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    for (const Eigen::Vector3d& p : hull) middle += (pose.X_FP * p).head<2>() / static_cast<double>(hull.size());
    for (const Eigen::Vector3d& p : hull) {
      const Eigen::Vector2d d = (pose.X_FP * p).head<2>() - middle;
      moments += d * d.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(moments);
    const Eigen::Vector2d longest = solver.eigenvectors().col(1);
    const double across = std::atan2(kView.y(), kView.x()) + std::numbers::pi / 2 + 0.35;
    const Eigen::AngleAxisd turn(across - std::atan2(longest.y(), longest.x()), Eigen::Vector3d::UnitZ());
    return Pose(turn) * pose.X_FP;
  }

  void poses_row(int top, int height) {
    const int width = (kWidth - (kPoses + 1) * kBorder) / kPoses;
    for (int i = 0; i < std::min<int>(kPoses, static_cast<int>(sheet_.poses.size())); ++i) {
      const StablePose& pose = sheet_.poses[static_cast<std::size_t>(i)];
      const Pose X_FP = facing(pose);
      auto mesh = std::make_shared<TriangleMesh>(sheet_.part.mesh_P);
      Eigen::AlignedBox3d box;
      for (Eigen::Vector3d& v : mesh->vertices) box.extend(v = scale_ * (X_FP * v));
      RenderScene scene{{{mesh, Pose::Identity(), 0, {}}}};
      const Primitive floor =
          Primitive::box({20 * kRadius, 20 * kRadius, 0.01}, Pose(Eigen::Translation3d(0, 0, -0.006)));
      scene.items.push_back({std::make_shared<TriangleMesh>(mesh_of(floor)), Pose::Identity(), kIdTable, {}});
      const cv::Rect where(kBorder + i * (width + kBorder), top, width, height);
      paste(scene, Panel(width, height, 1.12, box.center()), where);
      char text[80];
      std::snprintf(text, sizeof text, "%.1f %%", 100 * pose.probability);
      write(page_, text, {where.x, top + height + 26}, 0.7);
      std::snprintf(text, sizeof text, "topples at %.0f deg, centre %.1f mm high", pose.tilt * 180 / std::numbers::pi,
                    1e3 * pose.height);
      write(page_, text, {where.x, top + height + 46}, 0.42, kFaint);
    }
    if (sheet_.poses.size() > kPoses)
      write(page_, "and " + std::to_string(sheet_.poses.size() - kPoses) + " more", {kWidth - 110, top + height + 26},
            0.45, kFaint);
  }

  void text_columns(int top) {
    const int width = (kWidth - kBorder) / std::max<int>(1, static_cast<int>(sheet_.columns.size()));
    int x = kBorder;
    for (const std::vector<std::string>& column : sheet_.columns) {
      int y = top;
      for (const std::string& line : column) {
        write(page_, line, {x, y}, y == top ? 0.6 : 0.48, y == top ? kInk : kFaint);
        y += y == top ? 30 : 24;
      }
      x += width;
    }
  }

  const PartSheet& sheet_;
  DepthRenderer& renderer_;
  Eigen::Vector3d center_P_;
  double scale_;
  Image<Rgb> image_;
  cv::Mat page_;
};

}  // namespace

Image<Rgb> part_sheet(const PartSheet& sheet, DepthRenderer& renderer) { return Painter(sheet, renderer).paint(); }

}  // namespace binpick

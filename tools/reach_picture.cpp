#include "tools/reach_picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

namespace binpick {
namespace {

constexpr int kBorder = 24, kHead = 84, kFoot = 76, kGap = 28;
constexpr double kPixels = 1100;  // per metre
const cv::Scalar kInk(40, 44, 52), kFaint(120, 126, 134), kWall(200, 204, 210);

void write(cv::Mat& page, const std::string& text, const cv::Point& at, double size, const cv::Scalar& ink = kInk) {
  cv::putText(page, text, at, cv::FONT_HERSHEY_SIMPLEX, size, ink, 1, cv::LINE_AA);
}

/// Red, yellow, green; readable in grey too, since it grows lighter to the middle and the numbers stand beside.
cv::Scalar color(double share) {
  const double s = std::clamp(share, 0.0, 1.0);
  const Eigen::Vector3d none(197, 57, 50), half(246, 217, 104), all(58, 150, 88);
  const Eigen::Vector3d c = s < 0.5 ? none + 2 * s * (half - none) : half + (2 * s - 1) * (all - half);
  return {c.x(), c.y(), c.z()};
}

std::string formatted(const char* format, double value) {
  char text[80];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// World as the operator sees it from above: x of the bin to the right, y up.
struct Panel {
  cv::Point corner;  // upper left
  Eigen::Vector2d size;

  cv::Point at(const Eigen::Vector2d& p_B) const {
    return {corner.x + static_cast<int>(std::lround((p_B.x() + size.x() / 2) * kPixels)),
            corner.y + static_cast<int>(std::lround((size.y() / 2 - p_B.y()) * kPixels))};
  }
};

void draw_level(cv::Mat& page, const Panel& panel, const ReachMap& map, const ReachLevel& level) {
  const Eigen::Vector2d half = panel.size / 2;
  cv::rectangle(page, panel.at({-half.x(), half.y()}) - cv::Point(6, 6),
                panel.at({half.x(), -half.y()}) + cv::Point(6, 6), kWall, cv::FILLED);
  const auto edge = [](double a, double b, double limit, bool last) { return last ? limit : (a + b) / 2; };
  for (int j = 0; j < map.rows; ++j) {
    for (int i = 0; i < map.columns; ++i) {
      const auto place = static_cast<std::size_t>(j * map.columns + i);
      const auto x = [&](int k) { return map.places[static_cast<std::size_t>(std::clamp(k, 0, map.columns - 1))].x(); };
      const auto y = [&](int k) {
        return map.places[static_cast<std::size_t>(std::clamp(k, 0, map.rows - 1) * map.columns)].y();
      };
      const Eigen::Vector2d low(edge(x(i - 1), x(i), -half.x(), i == 0), edge(y(j - 1), y(j), -half.y(), j == 0));
      const Eigen::Vector2d high(edge(x(i), x(i + 1), half.x(), i + 1 == map.columns),
                                 edge(y(j), y(j + 1), half.y(), j + 1 == map.rows));
      cv::rectangle(page, panel.at({low.x(), high.y()}), panel.at({high.x(), low.y()}), color(level.free[place]),
                    cv::FILLED);
      // Beyond reach or joint limits, whatever stands in the way: a cross.
      if (level.within[place] > 0.999) continue;
      const cv::Point c = panel.at(map.places[place]);
      const int r = level.within[place] > 0 ? 3 : 6;
      cv::line(page, c - cv::Point(r, r), c + cv::Point(r, r), kInk, 1, cv::LINE_AA);
      cv::line(page, c - cv::Point(r, -r), c + cv::Point(r, -r), kInk, 1, cv::LINE_AA);
    }
  }
  double sum = 0;
  for (const double share : level.free) sum += share;
  const cv::Point below(panel.corner.x, panel.corner.y + static_cast<int>(panel.size.y() * kPixels) + 24);
  write(page,
        formatted("tip %.0f mm above the floor: ", level.height * 1e3) +
            formatted("%.0f %%", 100 * sum / static_cast<double>(level.free.size())),
        below, 0.42);
}

void draw_scale(cv::Mat& page, const cv::Point& at) {
  for (int i = 0; i <= 10; ++i) cv::rectangle(page, cv::Rect(at.x + 20 * i, at.y, 20, 12), color(i / 10.0), cv::FILLED);
  write(page, "0 .. 100 % of the tool's poses free of collision;  x: not all within reach and joint limits",
        at + cv::Point(232, 11), 0.42, kFaint);
}

}  // namespace

Image<Rgb> reach_picture(const ReachMap& map, const Cell& cell, const std::string& title) {
  const Eigen::Vector2d size = cell.bin.inner_size.head<2>();
  const int wide = static_cast<int>(size.x() * kPixels), high = static_cast<int>(size.y() * kPixels);
  const int count = static_cast<int>(map.levels.size());
  const int width = std::max(2 * kBorder + count * wide + (count - 1) * kGap, 900);
  Image<Rgb> image(width, kHead + high + kFoot, Rgb{255, 255, 255});
  cv::Mat page(image.height(), image.width(), CV_8UC3, image.data());
  write(page, title, {kBorder, 34}, 0.7);
  write(page, "the bin from above: its x to the right, y up", {kBorder, 60}, 0.42, kFaint);
  for (int l = 0; l < count; ++l)
    draw_level(page, {{kBorder + l * (wide + kGap), kHead}, size}, map, map.levels[static_cast<std::size_t>(l)]);
  draw_scale(page, {kBorder, kHead + high + 44});
  return image;
}

std::string reach_text(const ReachMap& map) {
  std::size_t worst = 0;
  for (std::size_t i = 0; i < map.places.size(); ++i)
    if (map.share(i) < map.share(worst)) worst = i;
  const auto percent = [](int part, int all) { return 100.0 * part / std::max(1, all); };
  char text[400];
  std::snprintf(text, sizeof text,
                "%d tool poses in the bin: %.1f %% within reach, %.1f %% free of collision (straight down %.1f %%); "
                "worst place (%.0f, %.0f) mm: %.0f %%",
                map.poses, percent(map.within, map.poses), percent(map.free, map.poses),
                percent(map.upright_free, map.upright), map.places[worst].x() * 1e3, map.places[worst].y() * 1e3,
                100 * map.share(worst));
  std::string line = text;
  const char* before = "; lost: ";
  for (const auto& [why, poses] : map.lost) {
    std::snprintf(text, sizeof text, "%s%.1f %% %s", before, percent(poses, map.poses), why.c_str());
    line += text;
    before = ", ";
  }
  return line;
}

}  // namespace binpick

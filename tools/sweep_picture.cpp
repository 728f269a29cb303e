#include "tools/sweep_picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

#include "core/file_io.hpp"

namespace binpick {
namespace {

constexpr int kBorder = 30, kHead = 96, kFieldWidth = 132, kFieldHeight = 84, kTitle = 34, kFoot = 96, kGap = 36;
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kText = 0.55, kSmall = 0.45;
const cv::Scalar kInk(30, 32, 38), kFaint(105, 110, 118), kNothing(235, 236, 238), kPaper(255, 255, 255);

int width_of(const std::string& text, double size) { return cv::getTextSize(text, kFont, size, 1, nullptr).width; }

/// The text, cut where it would be wider than this.
std::string fitted(std::string text, double size, int width) {
  if (width_of(text, size) <= width) return text;
  while (text.size() > 1 && width_of(text + "..", size) > width) text.pop_back();
  return text + "..";
}

void write(cv::Mat& page, const std::string& text, const cv::Point& at, double size, const cv::Scalar& ink = kInk) {
  cv::putText(page, text, at, kFont, size, ink, 1, cv::LINE_AA);
}

void write_centred(cv::Mat& page, const std::string& text, const cv::Point& at, double size, const cv::Scalar& ink) {
  write(page, text, at - cv::Point(width_of(text, size) / 2, 0), size, ink);
}

std::string formatted(const char* format, double value) {
  char text[60];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// Percent at the ends of the colours: whole tens around what the maps hold.
struct Scale {
  double low = 0, high = 100;

  explicit Scale(const std::vector<const HeatMap*>& maps) {
    double least = 100, most = 0;
    for (const HeatMap* map : maps)
      for (const auto& row : map->share)
        for (const double share : row)
          if (!std::isnan(share)) least = std::min(least, 100 * share), most = std::max(most, 100 * share);
    if (least > most) return;
    low = std::min(90.0, 10 * std::floor(least / 10));
    high = std::max(low + 10, 10 * std::ceil(most / 10));
  }

  double place(double share) const { return std::clamp((100 * share - low) / (high - low), 0.0, 1.0); }

  cv::Scalar color(double place) const {
    cv::Mat grey(1, 1, CV_8UC1, cv::Scalar(255 * place)), painted;
    cv::applyColorMap(grey, painted, cv::COLORMAP_CIVIDIS);
    const auto bgr = painted.at<cv::Vec3b>(0, 0);
    return {static_cast<double>(bgr[2]), static_cast<double>(bgr[1]), static_cast<double>(bgr[0])};
  }
};

class Page {
 public:
  Page(const SweepResult& result, const std::vector<const HeatMap*>& maps)
      : plan_(result.plan),
        maps_(maps),
        scale_(maps),
        rows_(plan_.factors[maps[0]->rows]),
        columns_(plan_.factors[maps[0]->columns]) {
    for (const std::string& label : rows_.levels)
      margin_ = std::max(margin_, std::min(240, width_of(label, kText) + 14));
    panel_ = static_cast<int>(columns_.levels.size()) * kFieldWidth;
  }

  Image<Rgb> drawn() {
    const int count = static_cast<int>(maps_.size());
    const int width = std::max(2 * kBorder + margin_ + count * panel_ + (count - 1) * kGap, 700);
    const int height = kHead + kTitle + 30 + static_cast<int>(rows_.levels.size()) * kFieldHeight + kFoot;
    Image<Rgb> image(width, height, Rgb{255, 255, 255});
    cv::Mat page(image.height(), image.width(), CV_8UC3, image.data());
    const std::string what =
        plan_.objective == "picks" ? "picks succeeded of attempted, %" : "parts cleared of dropped, %";
    write(page, fitted(plan_.name + ": " + what, 0.7, width - 2 * kBorder), {kBorder, 36}, 0.7);
    write(page, fitted("rows: " + rows_.name + ";  columns: " + columns_.name, kText, width - 2 * kBorder),
          {kBorder, 66}, kText, kFaint);
    for (int k = 0; k < count; ++k)
      draw_map(page, *maps_[static_cast<std::size_t>(k)], {kBorder + margin_ + k * (panel_ + kGap), kHead}, k == 0);
    draw_scale(page, {kBorder + margin_, height - kFoot + 34});
    return image;
  }

 private:
  std::string title(const HeatMap& map) const {
    if (map.given)
      return plan_.factors[map.given->first].name + ": " + plan_.factors[map.given->first].levels[map.given->second];
    return plan_.factors.size() > 2 ? "over all other factors" : "";
  }

  void draw_map(cv::Mat& page, const HeatMap& map, const cv::Point& corner, bool labelled) {
    write_centred(page, fitted(title(map), kText, panel_ + kGap - 8), corner + cv::Point(panel_ / 2, 16), kText, kInk);
    const cv::Point origin = corner + cv::Point(0, kTitle + 30);
    for (std::size_t c = 0; c < columns_.levels.size(); ++c)
      write_centred(page, fitted(columns_.levels[c], kText, kFieldWidth - 6),
                    origin + cv::Point(static_cast<int>(c) * kFieldWidth + kFieldWidth / 2, -10), kText, kInk);
    for (std::size_t r = 0; r < rows_.levels.size(); ++r) {
      const int y = origin.y + static_cast<int>(r) * kFieldHeight;
      if (labelled) {
        const std::string label = fitted(rows_.levels[r], kText, margin_ - 14);
        write(page, label, {origin.x - 12 - width_of(label, kText), y + kFieldHeight / 2 + 6}, kText);
      }
      for (std::size_t c = 0; c < columns_.levels.size(); ++c)
        draw_field(page, {origin.x + static_cast<int>(c) * kFieldWidth, y, kFieldWidth, kFieldHeight}, map.share[r][c],
                   map.trials[r][c]);
    }
  }

  void draw_field(cv::Mat& page, const cv::Rect& field, double share, std::size_t trials) const {
    const bool known = !std::isnan(share);
    const cv::Scalar fill = known ? scale_.color(scale_.place(share)) : kNothing;
    cv::rectangle(page, field, fill, cv::FILLED);
    cv::rectangle(page, field, kPaper, 2);
    const double brightness = 0.299 * fill[0] + 0.587 * fill[1] + 0.114 * fill[2];
    const cv::Scalar ink = brightness < 128 ? kPaper : kInk;
    const cv::Point middle(field.x + field.width / 2, field.y + field.height / 2);
    write_centred(page, known ? formatted("%.1f %%", 100 * share) : "-", middle + cv::Point(0, 2), 0.68, ink);
    write_centred(page, formatted(trials == 1 ? "%.0f pile" : "%.0f piles", static_cast<double>(trials)),
                  middle + cv::Point(0, 26), kSmall, ink);
  }

  void draw_scale(cv::Mat& page, const cv::Point& at) const {
    constexpr int kSteps = 50, kStep = 6, kHeight = 16;
    for (int i = 0; i < kSteps; ++i)
      cv::rectangle(page, cv::Rect(at.x + kStep * i, at.y, kStep, kHeight), scale_.color((i + 0.5) / kSteps),
                    cv::FILLED);
    for (const double place : {0.0, 0.5, 1.0})
      write_centred(page, formatted("%.0f %%", scale_.low + place * (scale_.high - scale_.low)),
                    at + cv::Point(static_cast<int>(place * kSteps * kStep), kHeight + 20), kSmall, kFaint);
  }

  const SweepPlan& plan_;
  std::vector<const HeatMap*> maps_;
  Scale scale_;
  const SweepFactorPlan &rows_, &columns_;
  int margin_ = 40, panel_ = 0;
};

bool same_factors(const HeatMap& a, const HeatMap& b) { return a.rows == b.rows && a.columns == b.columns; }

std::string file_word(const std::string& name) {
  std::string word;
  for (const char c : name) word += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return word.substr(0, 60);
}

}  // namespace

Image<Rgb> heat_map_picture(const SweepResult& result, std::size_t first) {
  std::vector<const HeatMap*> maps;
  for (std::size_t m = first; m < result.heat_maps.size() && same_factors(result.heat_maps[m], result.heat_maps[first]);
       ++m)
    maps.push_back(&result.heat_maps[m]);
  return Page(result, maps).drawn();
}

void write_sweep_files(const SweepResult& result, const std::string& folder) {
  std::vector<std::string> pictures;
  std::vector<PageSources::Picture> shown;
  for (std::size_t m = 0; m < result.heat_maps.size(); ++m) {
    const HeatMap& map = result.heat_maps[m];
    if (m > 0 && same_factors(map, result.heat_maps[m - 1])) {
      pictures.push_back(pictures.back());
      continue;
    }
    const auto name = [&](std::size_t factor) { return file_word(result.plan.factors[factor].name); };
    pictures.push_back("heat_" + std::to_string(map.rows + 1) + "_" + name(map.rows) + "_" +
                       std::to_string(map.columns + 1) + "_" + name(map.columns) + ".png");
    const std::string path = folder + "/" + pictures.back();
    write_png(path, heat_map_picture(result, m));
    shown.push_back(
        {result.plan.factors[map.rows].name + " x " + result.plan.factors[map.columns].name + ": " + pictures.back(),
         read_file(path)});
  }
  write_file(folder + "/sweep.json", sweep_json(result, pictures));
  write_file(folder + "/report.html", html_sweep(result, shown));
  write_file(folder + "/sweep.md", sweep_markdown(result));
  write_file(folder + "/cells.csv", sweep_cells_csv(result));
  write_file(folder + "/factors.csv", sweep_factors_csv(result));
}

}  // namespace binpick

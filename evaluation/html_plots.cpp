#include "evaluation/html_plots.hpp"

#include <algorithm>
#include <cmath>

#include "evaluation/report_text.hpp"

namespace binpick::html {
namespace {

using text::fixed;

std::string line(double x1, double y1, double x2, double y2, const std::string& style) {
  return "<line x1=\"" + fixed(x1, 1) + "\" y1=\"" + fixed(y1, 1) + "\" x2=\"" + fixed(x2, 1) + "\" y2=\"" +
         fixed(y2, 1) + "\" " + style + "/>";
}

std::string label(double x, double y, const std::string& anchor, const std::string& words) {
  return "<text x=\"" + fixed(x, 1) + "\" y=\"" + fixed(y, 1) + "\" text-anchor=\"" + anchor +
         "\" font-size=\"11\" fill=\"var(--soft)\">" + text::html(words) + "</text>";
}

/// The smallest round number that is not below x.
double round_up(double x) {
  const double power = std::pow(10, std::floor(std::log10(x)));
  for (const double step : {1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0}) {
    if (step * power >= x) return step * power;
  }
  return 10 * power;
}

}  // namespace

std::string rate_track(const Rate& rate, double reference) {
  const auto x = [](double share) { return 4 + 192 * share; };
  std::string svg =
      "<svg viewBox=\"0 0 200 16\" role=\"img\" aria-label=\"" +
      text::html(text::percent(rate.rate) + ", 95 % interval " + text::percent(rate.interval)) + "\">" +
      line(x(0), 8, x(1), 8, "stroke=\"var(--line)\" stroke-width=\"6\" stroke-linecap=\"round\"") +
      line(x(rate.interval.low), 8, x(rate.interval.high), 8, "stroke=\"var(--band)\" stroke-width=\"6\"");
  if (reference >= 0) svg += line(x(reference), 1, x(reference), 15, "stroke=\"var(--paper)\" stroke-width=\"1.5\"");
  if (std::isfinite(rate.rate)) {
    svg += "<circle cx=\"" + fixed(x(rate.rate), 1) + "\" cy=\"8\" r=\"4\" fill=\"var(--good)\"/>";
  }
  return svg + "</svg>";
}

std::string distribution(const std::string& title, const std::string& unit, std::vector<double> values) {
  if (values.empty()) return "";
  std::sort(values.begin(), values.end());
  const double median = quantile(values, 0.5), p95 = quantile(values, 0.95);
  if (p95 < 1e-6) return "";  // the oracle's: nothing to draw
  const double end = round_up(1.2 * p95);
  const double left = 44, right = 350, top = 12, bottom = 140;
  const auto x = [&](double value) { return left + (right - left) * std::min(value / end, 1.0); };
  const auto y = [&](double share) { return bottom - (bottom - top) * share; };
  std::string svg = "<svg viewBox=\"0 0 360 178\" role=\"img\" aria-label=\"" +
                    text::html(title + ": median " + fixed(median, 2) + " " + unit + ", 95 % " + fixed(p95, 2)) + "\">";
  for (const double share : {0.0, 0.5, 0.95, 1.0}) {
    svg += line(left, y(share), right, y(share), "stroke=\"var(--line)\"");
    if (share != 0.95) svg += label(left - 4, y(share) + 4, "end", fixed(100 * share, 0) + " %");
  }
  std::string points;
  constexpr int kSteps = 200;
  for (int i = 0; i <= kSteps; ++i) {
    const double value = end * i / kSteps;
    const auto below = std::upper_bound(values.begin(), values.end(), value) - values.begin();
    points +=
        fixed(x(value), 1) + "," + fixed(y(static_cast<double>(below) / static_cast<double>(values.size())), 1) + " ";
  }
  svg += "<polyline points=\"" + points + "\" fill=\"none\" stroke=\"var(--good)\" stroke-width=\"2\"/>";
  for (const double value : {median, p95}) {
    svg += line(x(value), top, x(value), bottom, "stroke=\"var(--soft)\" stroke-dasharray=\"3 3\"");
  }
  svg += label(left, bottom + 15, "middle", "0") + label(right, bottom + 15, "end",
                                                         fixed(end, end < 1    ? 3
                                                                    : end < 10 ? 1
                                                                               : 0) +
                                                             " " + unit);
  svg += label(left, bottom + 31, "start",
               title + ": median " + fixed(median, 2) + ", 95 % " + fixed(p95, 2) + " " + unit + " (" +
                   std::to_string(values.size()) + " poses)");
  return svg + "</svg>";
}

}  // namespace binpick::html

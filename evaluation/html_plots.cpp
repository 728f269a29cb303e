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

}  // namespace binpick::html

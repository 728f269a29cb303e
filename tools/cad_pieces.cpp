#include "tools/cad_pieces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/convex_hull.hpp"
#include "core/primitive.hpp"
#include "tools/cad_dimensions.hpp"

namespace binpick {
namespace {

constexpr double kMetres = 0.001;  // per millimetre
constexpr int kBossFacets = 12;
constexpr int kShaftFacets = 24;

/// Circumradius of the regular polygon with the area of a circle of radius r: n/2 R^2 sin(2 pi/n) = pi r^2.
double polygon_radius(double r, int facets) {
  const double step = 2 * std::numbers::pi / facets;
  return r * std::sqrt(step / std::sin(step));
}

Eigen::Vector3d on_circle(double radius, double angle, double z) {
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

/// Prism about z over a regular polygon with the area of the circle, millimetres.
TriangleMesh round_bar(double radius, int facets, double low, double high) {
  std::vector<Eigen::Vector3d> points;
  for (int k = 0; k < facets; ++k)
    for (const double z : {low, high})
      points.push_back(kMetres * on_circle(polygon_radius(radius, facets), 2 * std::numbers::pi * k / facets, z));
  return convex_hull(points);
}

/// Box between two corners given in millimetres.
TriangleMesh block(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  const Eigen::Vector3d middle = kMetres * (low + high) / 2;
  return mesh_of(Primitive::box(kMetres * (high - low), Pose(Eigen::Translation3d(middle))));
}

}  // namespace

TriangleMesh ring_envelope(double inner, double outer, double width, int facets) {
  TriangleMesh mesh;
  const auto n = static_cast<std::uint32_t>(facets);
  const double radii[2] = {polygon_radius(inner, facets), polygon_radius(outer, facets)};
  for (std::uint32_t i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / facets;
    for (const double r : radii) {
      for (const double z : {-width / 2, width / 2}) mesh.vertices.push_back(on_circle(r, angle, z));
    }
  }
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t a = 4 * i;              // inner low, inner high, outer low, outer high
    const std::uint32_t b = 4 * ((i + 1) % n);  // the same at the next angle
    quad(a + 2, b + 2, b + 3, a + 3);
    quad(a, a + 1, b + 1, b);
    quad(a + 1, a + 3, b + 3, b + 1);
    quad(a, b, b + 2, a + 2);
  }
  return mesh;
}

std::vector<TriangleMesh> ring_wedges(double inner, double outer, double width) {
  constexpr int kWedges = 12;
  constexpr int kFacets = 2;
  const double inner_radius = polygon_radius(inner, kWedges);
  const double outer_radius = polygon_radius(outer, kWedges * kFacets);
  const double step = 2 * std::numbers::pi / (kWedges * kFacets);
  std::vector<TriangleMesh> wedges;
  for (int wedge = 0; wedge < kWedges; ++wedge) {
    std::vector<Eigen::Vector3d> points;
    for (const double z : {-width / 2, width / 2}) {
      for (int k = 0; k <= kFacets; ++k) points.push_back(on_circle(outer_radius, (wedge * kFacets + k) * step, z));
      for (const int k : {0, kFacets}) points.push_back(on_circle(inner_radius, (wedge * kFacets + k) * step, z));
    }
    wedges.push_back(convex_hull(points));
  }
  return wedges;
}

std::vector<TriangleMesh> bearing_pieces() {
  return ring_wedges(kMetres * bearing::kInnerRadius, kMetres * bearing::kOuterRadius, kMetres * bearing::kWidth);
}

std::vector<TriangleMesh> bracket_pieces() {
  using namespace bracket;
  std::vector<Eigen::Vector3d> boss;
  for (int k = 0; k < kBossFacets; ++k) {
    const double angle = 2 * std::numbers::pi * k / kBossFacets;
    for (const double z : {kPlate, kPlate + kBossHeight}) {
      const Eigen::Vector3d center(kBossX, kBossY, 0);
      boss.push_back(kMetres * (center + on_circle(polygon_radius(kBossRadius, kBossFacets), angle, z)));
    }
  }
  return {block({0, 0, 0}, {kLength, kWidth, kPlate}), block({0, 0, kPlate}, {kPlate, kWidth, kHeight}),
          convex_hull(boss)};
}

std::vector<TriangleMesh> tee_pieces() {
  using namespace tee;
  const double x = kLength / 2, top = kHeight / 2, z = kThickness / 2;
  return {block({-x, top - kBar, -z}, {x, top, z}), block({-kStem / 2, -top, -z}, {kStem / 2, top - kBar, z})};
}

std::vector<TriangleMesh> bolt_pieces() {
  using namespace bolt;
  std::vector<Eigen::Vector3d> head;
  for (int k = 0; k < 6; ++k)
    for (const double z : {-kHeadHeight, 0.0})
      head.push_back(kMetres * on_circle(kAcrossFlats / std::sqrt(3.0), (k + 0.5) * std::numbers::pi / 3, z));
  return {convex_hull(head), round_bar(kThread / 2, kShaftFacets, 0, kLength)};
}

std::vector<TriangleMesh> gear_pieces() {
  using namespace gear;
  // One piece a tooth, from the bore to its tip. In the gap it meets its neighbours kBelowRoot under the root circle,
  // so that what it adds beside the foot of the tooth and what it lacks of the gap's floor are least together; from
  // there it is bounded by two straight lines, through the involute at kFlank and at the tip. 2.8 % of the gear in all.
  constexpr double kBelowRoot = 1.5;
  constexpr double kFlank = 0.5 * kModule * kTeeth + 0.4 * kModule;
  constexpr double tip = 0.5 * kModule * kTeeth + kModule;
  constexpr double gap = 0.5 * kModule * kTeeth - kDedendum * kModule - kBelowRoot;
  const double half = std::numbers::pi / kTeeth;
  const std::array<std::pair<double, double>, 4> corners = {
      {{polygon_radius(kBoreRadius, kTeeth), half}, {gap, half}, {kFlank, half_tooth(kFlank)}, {tip, half_tooth(tip)}}};
  std::vector<TriangleMesh> teeth;
  for (int tooth = 0; tooth < kTeeth; ++tooth) {
    std::vector<Eigen::Vector3d> points;
    for (const auto& [radius, angle] : corners)
      for (const double side : {-1.0, 1.0})
        for (const double z : {-kWidth / 2, kWidth / 2})
          points.push_back(kMetres * on_circle(radius, 2 * half * tooth + side * angle, z));
    teeth.push_back(convex_hull(points));
  }
  return teeth;
}

std::vector<TriangleMesh> plate_pieces() {
  using namespace plate;
  const double x = kLength / 2, y = kWidth / 2, z = kThickness / 2, inner = kSlotWidth / 2;
  // Square holes and a slot with square ends, each of the area of the drawn one.
  const double hole = kHoleRadius * std::sqrt(std::numbers::pi) / 2;
  const double end = kSlotLength / 2 - inner + std::numbers::pi * inner / 4;
  std::vector<TriangleMesh> blocks;
  for (const double side : {-1.0, 1.0}) {
    const auto strip = [&](double x0, double y0, double x1, double y1) {
      blocks.push_back(block({std::min(side * x0, side * x1), y0, -z}, {std::max(side * x0, side * x1), y1, z}));
    };
    strip(inner, -end, kHoleX - hole, end);
    strip(kHoleX - hole, -end, kHoleX + hole, -hole);
    strip(kHoleX - hole, hole, kHoleX + hole, end);
    strip(kHoleX + hole, -end, x, end);
  }
  blocks.push_back(block({-x, -y, -z}, {x, -end, z}));
  blocks.push_back(block({-x, end, -z}, {x, y, z}));
  return blocks;
}

std::vector<TriangleMesh> shaft_pieces() {
  using namespace shaft;
  const double half = kLength / 2, step = -half + kThickLength;
  return {round_bar(kThick / 2, kShaftFacets, -half, step), round_bar(kThin / 2, kShaftFacets, step, half)};
}

}  // namespace binpick

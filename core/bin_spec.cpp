#include "core/bin_spec.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/bin_mesh.hpp"

namespace binpick {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kSteepest = 20 * kDegree;  // totes have 1 to 5, stacking crates up to 15

Pose at(double x, double y, double z) { return Pose(Eigen::Translation3d(x, y, z)); }

/// Compartments must be wide enough to be one.
void require_dividers(const std::vector<double>& places, double width, double thickness, const char* name) {
  constexpr double kNarrowest = 0.01;  // m
  std::vector<double> sorted = places;
  std::sort(sorted.begin(), sorted.end());
  double free_from = -width / 2;
  for (const double place : sorted) {
    if (!(place - thickness / 2 - free_from >= kNarrowest))
      throw SpecError(std::string("bin.") + name + ": a compartment would be narrower than 10 mm, or outside the bin");
    free_from = place + thickness / 2;
  }
  if (!sorted.empty() && !(width / 2 - free_from >= kNarrowest))
    throw SpecError(std::string("bin.") + name + ": a compartment would be narrower than 10 mm, or outside the bin");
}

}  // namespace

void BinSpec::visit(ConfigVisitor& v) {
  v.field("inner_size", inner_size, Unit::kLength, "inner length and width at the floor, and height of the walls");
  v.field("wall", wall, Unit::kLength, "thickness of walls and floor as seen (collision walls are thicker, outwards)");
  v.field("draft", draft, Unit::kAngle, "by which every wall leans outwards");
  v.field("dividers_x", dividers_x, Unit::kLength, "dividers along y: their places along x, from the bin's middle");
  v.field("dividers_y", dividers_y, Unit::kLength, "dividers along x: their places along y, from the bin's middle");
  v.field("divider_height", divider_height, Unit::kLength, "of the dividers above the floor; 0: as high as the walls");
  v.field("divider_thickness", divider_thickness, Unit::kLength, "of the dividers");
  v.field("friction", friction, Unit::kNone, "Coulomb coefficient of bin against part");
  v.field("restitution", restitution, Unit::kNone, "restitution of bin against part");
  if (v.reading() || !mesh.empty()) {
    v.path("mesh", mesh, "closed CAD mesh that is the bin, in its frame; the keys above say where floor and walls are");
    v.choice("mesh_unit", mesh_unit, {"", "mm", "cm", "m", "inch"}, "of STL, OBJ, PLY; empty: mm (STEP has its own)");
  }
}

void BinSpec::validate() const {
  if (!(inner_size.minCoeff() > 0.01) || !(inner_size.maxCoeff() < 5))
    throw SpecError("bin.inner_size: each edge must lie between 10 mm and 5 m");
  if (!(wall >= 0.001) || !(wall <= 0.1)) throw SpecError("bin.wall: must lie between 1 and 100 mm");
  if (!(draft >= 0 && draft <= kSteepest)) throw SpecError("bin.draft: must lie between 0 and 20 degrees");
  if (!(divider_height >= 0 && divider_height <= inner_size.z()))
    throw SpecError("bin.divider_height: must lie between 0 and the height of the walls");
  if (!(divider_thickness >= 0.002 && divider_thickness <= 0.1))
    throw SpecError("bin.divider_thickness: must lie between 2 and 100 mm");
  require_dividers(dividers_x, inner_size.x(), divider_thickness, "dividers_x");
  require_dividers(dividers_y, inner_size.y(), divider_thickness, "dividers_y");
  if (!mesh.empty() && (!dividers_x.empty() || !dividers_y.empty()))
    throw SpecError("bin.mesh: dividers are part of the mesh; dividers_x and dividers_y go without one");
  if (!(friction >= 0 && friction <= 2)) throw SpecError("bin.friction: must lie between 0 and 2");
  if (!(restitution >= 0 && restitution < 1)) throw SpecError("bin.restitution: must lie between 0 and 1");
}

void BinSpec::load() {
  if (!mesh.empty() && !solid) solid = std::make_shared<const BinMesh>(read_bin_mesh(*this));
}

BinSpec BinSpec::plain() const {
  BinSpec box = *this;
  box.dividers_x.clear(), box.dividers_y.clear();
  box.mesh.clear(), box.mesh_unit.clear();
  box.solid.reset(), box.pieces_B.reset();
  return box;
}

Eigen::Vector2d BinSpec::half_at(double z) const {
  const double lean = draft == 0 ? 0 : std::tan(draft) * std::clamp(z, 0.0, inner_size.z());
  return inner_size.head<2>() / 2 + Eigen::Vector2d::Constant(lean);
}

Eigen::Vector3d BinSpec::rim_size() const {
  const Eigen::Vector2d half = half_at(inner_size.z());
  return {2 * half.x(), 2 * half.y(), inner_size.z()};
}

double BinSpec::volume() const {
  const double h = inner_size.z(), t = std::tan(draft) * h;  // m, by which a rim leans out
  const double x = inner_size.x(), y = inner_size.y();
  const double open = h * (x * y + (x + y) * t + 4.0 / 3 * t * t);
  const double high = divider_height > 0 ? divider_height : h, wide = divider_thickness * high;
  const double nx = static_cast<double>(dividers_x.size()), ny = static_cast<double>(dividers_y.size());
  return open - wide * (nx * y + ny * x - nx * ny * divider_thickness);
}

std::vector<Primitive> bin_boxes(const BinSpec& bin, double thickness) {
  const Eigen::Vector3d& s = bin.inner_size;
  const double t = thickness, lean = s.z() * std::tan(bin.draft), slant = s.z() / std::cos(bin.draft);
  const double full_x = s.x() + 2 * t, full_y = s.y() + 2 * (t + lean);
  // The long walls reach over the corners, and all walls stand on the floor plate, so that no gap is left. A wall that
  // leans turns about its lower inner edge, and is as long everywhere as at the rim.
  std::vector<Primitive> boxes = {Primitive::box({full_x, s.y() + 2 * t, t}, at(0, 0, -t / 2))};
  const auto stand = [&](const Eigen::Vector3d& edges, const Eigen::Vector3d& foot, const Eigen::Vector3d& axis) {
    const Eigen::Vector3d out(foot.x() == 0 ? 0 : std::copysign(t / 2, foot.x()),
                              foot.y() == 0 ? 0 : std::copysign(t / 2, foot.y()), slant / 2);
    const Eigen::Matrix3d R_BS = Eigen::AngleAxisd(bin.draft, axis).toRotationMatrix();
    boxes.push_back(Primitive::box(edges, pose_from(R_BS, foot + R_BS * out)));
  };
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY();
  stand({t, full_y, slant}, s.x() / 2 * x, y);
  stand({t, full_y, slant}, -s.x() / 2 * x, -y);
  stand({s.x() + 2 * lean, t, slant}, s.y() / 2 * y, -x);
  stand({s.x() + 2 * lean, t, slant}, -s.y() / 2 * y, x);
  const double high = bin.divider_height > 0 ? bin.divider_height : s.z();
  const double reach = bin.draft == 0 ? 0 : std::tan(bin.draft) * high;  // into the leaning walls
  for (const double place : bin.dividers_x)
    boxes.push_back(Primitive::box({bin.divider_thickness, s.y() + 2 * reach, high}, at(place, 0, high / 2)));
  for (const double place : bin.dividers_y)
    boxes.push_back(Primitive::box({s.x() + 2 * reach, bin.divider_thickness, high}, at(0, place, high / 2)));
  return boxes;
}

}  // namespace binpick

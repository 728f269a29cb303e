// How far pieces are from a solid: figures known on paper, and the bounds that every shipped part keeps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "core/primitive.hpp"
#include "example_parts.hpp"
#include "sim/collision_shape.hpp"
#include "sim/convex_decomposition.hpp"
#include "sim/shape_error.hpp"

namespace binpick {
namespace {

constexpr double kPi = std::numbers::pi;

TriangleMesh box_between(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  return mesh_of(Primitive::box(high - low, Pose(Eigen::Translation3d((low + high) / 2))));
}

TEST(ShapeError, ASolidIsNoErrorOfItself) {
  const TriangleMesh box = box_between({0, 0, 0}, {0.05, 0.04, 0.03});
  const ShapeError error = shape_error(box, {box});
  EXPECT_NEAR(error.volume, 60e-6, 1e-12);
  EXPECT_NEAR(error.volume_error(), 0, 1e-12);
  EXPECT_NEAR(error.hausdorff(), 0, 1e-12);
}

TEST(ShapeError, AShiftedBoxIsWrongOnBothSides) {
  // 50 mm long, 2 mm along x: 4 % too much at one end, 4 % missing at the other; both surfaces 2 mm apart.
  const TriangleMesh box = box_between({0, 0, 0}, {0.05, 0.04, 0.03});
  const ShapeError error = shape_error(box, {box_between({0.002, 0, 0}, {0.052, 0.04, 0.03})});
  EXPECT_GT(error.standard_error, 0);
  EXPECT_LT(error.standard_error, 0.001);
  EXPECT_NEAR(error.extra, 0.04, 4 * error.standard_error);
  EXPECT_NEAR(error.missing, 0.04, 4 * error.standard_error);
  EXPECT_NEAR(error.solid_to_pieces, 0.002, 1e-9);
  EXPECT_NEAR(error.pieces_to_solid, 0.002, 1e-9);
}

TEST(ShapeError, TheTwoDistancesAreTold) {
  // A plate with a pin of 10 mm on it, and pieces without the pin: from the solid the pin's end is 10 mm away, from the
  // pieces no point is farther than the pin's foot is wide.
  TriangleMesh solid = box_between({-0.02, -0.02, -0.01}, {0.02, 0.02, 0});
  append(solid, box_between({-0.002, -0.002, 0}, {0.002, 0.002, 0.01}));
  const ShapeError error = shape_error(solid, {box_between({-0.02, -0.02, -0.01}, {0.02, 0.02, 0})});
  EXPECT_NEAR(error.missing, 0.16e-6 / (16e-6 + 0.16e-6), 4 * error.standard_error + 1e-6);
  EXPECT_EQ(error.extra, 0);
  EXPECT_NEAR(error.solid_to_pieces, 0.01, 1e-9);
  EXPECT_LT(error.pieces_to_solid, 1e-9);  // its foot is still a face of the mesh
}

TEST(ShapeError, AHoleThatWasClosedIsSeen) {
  // Ring 70 x 100 x 16 mm, one disc for a piece: the hole is 0.49 / 0.51 of the ring's volume. The hole's wall at half
  // height lies 8 mm from the disc's faces, the middle of a face 35 mm from the ring.
  const int sectors = 240;
  const TriangleMesh ring = example::ring_mesh(0.035, 0.05, 0.016, sectors);
  const TriangleMesh disc = mesh_of(Primitive::cylinder(0.05, 0.016), sectors);
  const ShapeError error = shape_error(ring, {disc});
  EXPECT_NEAR(error.extra, 0.49 / 0.51, 4 * error.standard_error);
  EXPECT_NEAR(error.missing, 0, 1e-9);
  EXPECT_NEAR(error.solid_to_pieces, 0.008, error.spacing);
  EXPECT_LE(error.solid_to_pieces, 0.008 + 1e-9);
  EXPECT_NEAR(error.pieces_to_solid, 0.035, error.spacing);
}

TEST(ShapeError, PolygonsOfEqualAreaMissARoundBarByTheirLunes) {
  // Regular n-gon of the area of the circle: it lies outside where |angle| < a, cos a = rho / r with rho its inner
  // radius, r = 1. Per side the lune beyond the circle's chord is the segment outside the polygon: 2 (a - sin a cos a)
  // / 2; n of them missing, and as much too much at the corners.
  const int n = 8;
  const double step = 2 * kPi / n;
  const double rho = std::sqrt(step / std::sin(step)) * std::cos(step / 2);
  const double a = std::acos(rho);
  const double expected = 2 * n * (a - std::sin(a) * std::cos(a)) / kPi;
  const TriangleMesh bar = mesh_of(Primitive::cylinder(0.02, 0.01), 720);
  const TriangleMesh piece = mesh_of(Primitive::cylinder(0.02 * std::sqrt(step / std::sin(step)), 0.01), n);
  const ShapeError error = shape_error(bar, {piece});
  EXPECT_NEAR(error.volume_error(), expected, 4 * error.standard_error + 2e-4);
  EXPECT_NEAR(error.extra, error.missing, 4 * error.standard_error + 2e-4);
}

TEST(ShapeError, TheUnionHasNoSurfaceWherePiecesMeetOrOverlap) {
  // Two boxes that touch, and a third across both: 30 x 10 x 10 mm in all.
  const std::vector<TriangleMesh> pieces = {box_between({0, 0, 0}, {0.015, 0.01, 0.01}),
                                            box_between({0.015, 0, 0}, {0.03, 0.01, 0.01}),
                                            box_between({0.01, 0.002, 0.002}, {0.02, 0.008, 0.008})};
  EXPECT_NEAR(surface_area(union_surface(pieces, 1e-6)), (4 * 0.03 * 0.01 + 2 * 0.01 * 0.01), 1e-8);
  const ShapeError error = shape_error(box_between({0, 0, 0}, {0.03, 0.01, 0.01}), pieces);
  EXPECT_LT(error.volume_error(), 1e-9);
  EXPECT_LT(error.hausdorff(), 1e-9);
}

TEST(ShapeError, TheSameMeshesGiveTheSameBits) {
  const TriangleMesh ring = example::ring_mesh(0.035, 0.05, 0.016, 48);
  const ShapeError a = shape_error(ring, example::ring().pieces_P), b = shape_error(ring, example::ring().pieces_P);
  EXPECT_EQ(a.volume_error(), b.volume_error());
  EXPECT_EQ(a.hausdorff(), b.hausdorff());
}

/// Parts of assets/parts, by name.
std::vector<Part> shipped_parts() {
  std::vector<std::string> folders;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(BINPICK_SOURCE_DIR) + "/assets/parts"))
    folders.push_back(entry.path().string());
  std::sort(folders.begin(), folders.end());
  std::vector<Part> parts;
  for (const std::string& folder : folders) parts.push_back(load_part(read_part_spec(folder + "/part.yaml")));
  return parts;
}

void expect_within_bounds(const Part& part, const std::vector<TriangleMesh>& pieces) {
  ShapeErrorOptions options;
  options.cells = 320;
  const ShapeError error = shape_error(part.envelope_P, pieces, options);
  EXPECT_LE(pieces.size(), 32u) << part.name;
  EXPECT_LT(error.volume_error() + 3 * error.standard_error, 0.05) << part.name;
  EXPECT_NEAR(error.volume, part.mass.volume, 1e-3 * part.mass.volume) << part.name;
}

TEST(ShippedParts, ComeWithFewPiecesOfLittleError) {
  const std::vector<Part> parts = shipped_parts();
  EXPECT_GE(parts.size(), 7u);
  for (const Part& part : parts) expect_within_bounds(part, collision_shape(part).pieces_P);
}

TEST(ShippedParts, ABallIsOnePieceWithinTheSameBounds) {
  for (const double radius : {0.002, 0.02}) {
    const TriangleMesh ball = mesh_of(Primitive::sphere(radius), 96);
    const std::vector<TriangleMesh> pieces = convex_decomposition(ball);
    ASSERT_EQ(pieces.size(), 1u);
    EXPECT_LE(pieces[0].vertices.size(), 128u);
    EXPECT_LT(shape_error(ball, pieces).volume_error(), 0.05) << radius;
  }
}

TEST(ShippedParts, WithoutTheirPiecesAreDecomposedWithinTheSameBounds) {
  for (const Part& part : shipped_parts()) expect_within_bounds(part, convex_decomposition(part.envelope_P));
}

}  // namespace
}  // namespace binpick

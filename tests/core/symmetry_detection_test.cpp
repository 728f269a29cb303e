// Groups known on paper, found from meshes that lie anywhere.
#include "core/symmetry_detection.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/part.hpp"
#include "core/primitive.hpp"
#include "core/random.hpp"

namespace binpick {
namespace {

constexpr double kTolerance = 0.01;

Pose at(double x, double y, double z) { return Pose(Eigen::Translation3d(x, y, z)); }

/// Every member carries every vertex of the mesh onto the mesh.
void expect_members_hold(const TriangleMesh& mesh, const Symmetry& symmetry) {
  const MeshQuery query(mesh);
  const double limit = 1.5 * kTolerance * mesh_diameter(mesh);
  for (const Pose& S : sampled_group(symmetry, 7)) {
    ASSERT_TRUE(is_rigid(S));
    for (const Eigen::Vector3d& p : mesh.vertices) ASSERT_TRUE(query.closest(S * p, limit)) << S.matrix();
  }
}

TriangleMesh frustum(int sides, double scale, double height) {
  TriangleMesh mesh;
  for (const double z : {0.0, height})
    for (int k = 0; k < sides; ++k) {
      const double r = 0.05 * (z > 0 ? scale : 1), angle = 2 * M_PI * k / sides;
      mesh.vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
  const auto n = static_cast<std::uint32_t>(sides);
  for (std::uint32_t k = 0; k < n; ++k) {
    const std::uint32_t next = (k + 1) % n;
    mesh.triangles.push_back({k, next, n + next});
    mesh.triangles.push_back({k, n + next, n + k});
    if (k + 2 < n) {
      mesh.triangles.push_back({0, k + 2, k + 1});
      mesh.triangles.push_back({n, n + k + 1, n + k + 2});
    }
  }
  return mesh;
}

struct Case {
  const char* name;
  TriangleMesh mesh;
  std::size_t members;  // finite members; with an axis: 1 or 2
  bool axis;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  all.push_back({"box", mesh_of(Primitive::box({0.1, 0.06, 0.03})), 4, false});
  all.push_back({"square_plate", mesh_of(Primitive::box({0.1, 0.1, 0.03})), 8, false});
  all.push_back({"cube", mesh_of(Primitive::box({0.1, 0.1, 0.1})), 24, false});
  all.push_back({"cylinder", mesh_of(Primitive::cylinder(0.03, 0.1)), 2, true});
  all.push_back({"coin_as_thick_as_its_moments_alike", mesh_of(Primitive::cylinder(0.05, 0.0707)), 2, true});
  all.push_back({"cone", frustum(64, 0.4, 0.06), 1, true});
  all.push_back({"hexagonal_frustum", frustum(6, 0.8, 0.014), 6, false});
  all.push_back({"hexagonal_prism", frustum(6, 1.0, 0.014), 12, false});
  all.push_back({"pentagonal_prism", frustum(5, 1.0, 0.014), 10, false});
  all.push_back({"triangular_frustum", frustum(3, 0.5, 0.03), 3, false});
  // A notch of 3 mm in a box of 117 mm diameter breaks the half turns but for the one about the notch's own axis.
  TriangleMesh tee = mesh_of(Primitive::box({0.1, 0.02, 0.016}));
  append(tee, mesh_of(Primitive::box({0.02, 0.05, 0.016}, at(0, -0.035, 0))));
  all.push_back({"tee", tee, 2, false});
  TriangleMesh bracket = mesh_of(Primitive::box({0.1, 0.02, 0.016}));
  append(bracket, mesh_of(Primitive::box({0.02, 0.05, 0.016}, at(0.03, -0.035, 0.004))));
  all.push_back({"bracket", bracket, 1, false});
  // Opposite vertices of a cube: a regular tetrahedron.
  TriangleMesh tetrahedron;
  tetrahedron.vertices = {{0.03, 0.03, 0.03}, {-0.03, -0.03, 0.03}, {-0.03, 0.03, -0.03}, {0.03, -0.03, -0.03}};
  tetrahedron.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  all.push_back({"tetrahedron", tetrahedron, 12, false});
  return all;
}

class Detection : public testing::TestWithParam<std::size_t> {};

TEST_P(Detection, FindsTheGroupWhereverThePartIsDrawn) {
  const Case c = cases()[GetParam()];
  for (std::uint64_t k = 0; k < 4; ++k) {
    Pose X = Pose::Identity();
    if (k > 0) {
      Rng draw = Seed{k}.child("place").rng();
      X.linear() = draw.rotation().toRotationMatrix();
      X.translation() = 0.2 * draw.unit_vector();
    }
    const TriangleMesh mesh = transformed(X, c.mesh);
    const Symmetry found = detect_symmetry(mesh, kTolerance);
    EXPECT_EQ(found.finite.size(), c.members) << "placed by seed " << k;
    EXPECT_EQ(found.axis.has_value(), c.axis) << "placed by seed " << k;
    EXPECT_FALSE(found.center_P.has_value());
    expect_members_hold(mesh, found);
  }
}

INSTANTIATE_TEST_SUITE_P(Solids, Detection, testing::Range<std::size_t>(0, cases().size()),
                         [](const auto& solid) { return std::string(cases()[solid.param].name); });

TEST(SymmetryDetection, ASphereIsASphere) {
  const Symmetry found = detect_symmetry(mesh_of(Primitive::sphere(0.02, at(0.1, 0, 0)), 64), kTolerance);
  ASSERT_TRUE(found.center_P.has_value());
  EXPECT_NEAR((*found.center_P - Eigen::Vector3d(0.1, 0, 0)).norm(), 0, 1e-4);
  EXPECT_EQ(describe(found), "sphere");
}

TEST(SymmetryDetection, ToleranceDecidesWhatCountsAsAlike) {
  // 2 mm of difference between two edges of 100 mm: alike at 2 % of the diameter, not at 0.2 %.
  const TriangleMesh plate = mesh_of(Primitive::box({0.100, 0.102, 0.03}));
  EXPECT_EQ(detect_symmetry(plate, 0.02).finite.size(), 8u);
  EXPECT_EQ(detect_symmetry(plate, 0.002).finite.size(), 4u);
}

TEST(SymmetryDetection, AnEmptyMeshHasNone) {
  EXPECT_TRUE(detect_symmetry({}, kTolerance).trivial());
  EXPECT_EQ(describe(Symmetry{}), "none");
}

// A turn of 360/64 degrees alone moves the edges of this long hexagon (radius 50 mm) out by 50 cos(24.4 deg) - 43.3
// = 2.2 mm: within the tolerance of 2.6 mm, and yet it has no more than six.
TEST(SymmetryDetection, ASmallTurnAloneIsNoSymmetry) {
  const Symmetry found = detect_symmetry(frustum(6, 0.9, 0.25), kTolerance);
  EXPECT_FALSE(found.axis);
  EXPECT_EQ(found.finite.size(), 6u);
}

// What the shipped parts state, found from their meshes alone.
TEST(SymmetryDetection, ShippedPartsAreWhatTheirFilesSay) {
  for (const char* name :
       {"bearing_6914", "bracket_l", "tee", "bolt_m24x80", "gear_m3_z24", "plate_100x60", "shaft_25_35x120"}) {
    const PartSpec spec = read_part_spec(std::string(BINPICK_SOURCE_DIR) + "/assets/parts/" + name + "/part.yaml");
    const Part part = load_part(spec);
    const Symmetry found = detect_symmetry(part.envelope_P, kTolerance);
    EXPECT_EQ(found.finite.size(), part.symmetry.finite.size()) << name << ": " << describe(found);
    ASSERT_EQ(found.axis.has_value(), part.symmetry.axis.has_value()) << name;
    if (found.axis) {
      EXPECT_GT(std::abs(found.axis->direction_P.dot(part.symmetry.axis->direction_P)), std::cos(1e-3)) << name;
    }
    for (const Pose& stated : part.symmetry.finite) {
      if (found.axis) break;  // the flip of a revolution may be about any axis across
      const Pose near = nearest_equivalent(Pose::Identity(), stated, found);
      EXPECT_LT(angle_between(near.linear(), stated.linear()), 0.01) << name;
      EXPECT_LT((near.translation() - stated.translation()).norm(), 0.5e-3) << name;
    }
  }
}

}  // namespace
}  // namespace binpick

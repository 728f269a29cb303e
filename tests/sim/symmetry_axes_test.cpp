// What a symmetry group says: its axes, where they lie, and words.
#include <gtest/gtest.h>

#include "sim/part_sheet.hpp"

namespace binpick {
namespace {

Symmetry group(const std::string& type, int order, const Eigen::Vector3d& axis = {0, 0, 1},
               const Eigen::Vector3d& point = {0, 0, 0}) {
  SymmetrySpec spec;
  spec.type = type;
  spec.order = order;
  spec.axis = axis;
  spec.point = point;
  return make_symmetry(spec);
}

TEST(SymmetryAxes, ATurnHasItsOrderAndItsPlace) {
  const Eigen::Vector3d point(0.01, -0.02, 0.03);
  const std::vector<SymmetryAxis> axes = symmetry_axes(group("cyclic", 6, {0, 0, -2}, point));
  ASSERT_EQ(axes.size(), 1u);
  EXPECT_EQ(axes[0].order, 6);
  EXPECT_LT((axes[0].direction_P - Eigen::Vector3d(0, 0, 1)).norm(), 1e-9);
  EXPECT_LT((axes[0].point_P - point).cross(axes[0].direction_P).norm(), 1e-9);
}

TEST(SymmetryAxes, ADihedralGroupHasHalfTurnsAcross) {
  const std::vector<SymmetryAxis> axes = symmetry_axes(group("dihedral", 4));
  ASSERT_EQ(axes.size(), 5u);
  EXPECT_EQ(axes[0].order, 4);
  for (std::size_t i = 1; i < axes.size(); ++i) {
    EXPECT_EQ(axes[i].order, 2);
    EXPECT_NEAR(axes[i].direction_P.z(), 0, 1e-9);
  }
}

TEST(SymmetryAxes, Words) {
  EXPECT_EQ(symmetry_in_words({}), "none");
  EXPECT_EQ(symmetry_in_words(group("cyclic", 2, {0, 1, 0})), "half turns about (0 1 0)");
  EXPECT_EQ(symmetry_in_words(group("cyclic", 6)), "turns of 1/6 about (0 0 1)");
  EXPECT_EQ(symmetry_in_words(group("dihedral", 24)), "turns of 1/24 about (0 0 1); half turns about 24 axes");
  SymmetrySpec spec;
  spec.type = "revolution";
  EXPECT_EQ(symmetry_in_words(make_symmetry(spec)), "any turn about (0 0 1)");
  spec.flip = true;
  EXPECT_EQ(symmetry_in_words(make_symmetry(spec)), "any turn about (0 0 1); half turns about any axis across it");
  EXPECT_EQ(symmetry_in_words(group("sphere", 2)), "any rotation");
}

}  // namespace
}  // namespace binpick

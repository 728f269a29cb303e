// Whole rows of random numbers: their law, their independence of each other and of the order of rows.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/normal_words.hpp"
#include "core/random_field.hpp"

namespace binpick {
namespace {

TEST(NormalWords, AreBoxMuller) {
  Rng rng = Seed{3}.rng();
  for (int round = 0; round < 2000; ++round) {
    std::array<std::uint32_t, kNormalLanes> a, b;
    std::array<float, kNormalLanes> x, y;
    for (int i = 0; i < kNormalLanes; ++i) a[i] = rng.next_u32(), b[i] = rng.next_u32();
    a[0] = 0, a[1] = ~0u, b[2] = static_cast<std::uint32_t>(round) << 21;  // both ends, and all around
    normals_from_words(a.data(), b.data(), x.data(), y.data());
    for (int i = 0; i < kNormalLanes; ++i) {
      const double u = ((a[i] >> 1) + 0.5) / 2147483648.0;
      // The angle, up to a turn that is the same for all: quarters of b centred on the axes.
      const double angle = 2 * M_PI * (b[i] / 4294967296.0) - M_PI / 4, radius = std::sqrt(-2 * std::log(u));
      // Near u = 1 the float u rounds by 6e-8, which the root makes 2e-4 of a radius near 0.
      ASSERT_NEAR(x[i], radius * std::cos(angle), 4e-4) << a[i] << " " << b[i];
      ASSERT_NEAR(y[i], radius * std::sin(angle), 4e-4) << a[i] << " " << b[i];
      if (radius > 0.1) {
        ASSERT_NEAR(x[i], radius * std::cos(angle), 2e-6) << a[i] << " " << b[i];
      }
    }
  }
}

TEST(RandomField, NormalsHaveTheirMoments) {
  constexpr int kRows = 400, kWidth = 1001;
  std::vector<float> row(kWidth), above(kWidth);
  double sum = 0, squares = 0, cubes = 0, fourths = 0, beside = 0, across = 0, far = 0;
  for (int v = 0; v < kRows; ++v) {
    fill_normals(Seed{5}.rng(), static_cast<std::uint64_t>(v), row);
    for (int u = 0; u < kWidth; ++u) {
      const double x = row[u];
      sum += x, squares += x * x, cubes += x * x * x, fourths += x * x * x * x;
      if (u > 0) beside += x * row[u - 1];
      if (v > 0) across += x * above[u];
      far += std::abs(x) > 3;
    }
    above = row;
  }
  const double n = kRows * kWidth, root = std::sqrt(n);
  EXPECT_NEAR(sum / n, 0, 4 / root);
  EXPECT_NEAR(squares / n, 1, 4 * std::sqrt(2.0) / root);
  EXPECT_NEAR(cubes / n, 0, 4 * std::sqrt(15.0) / root);
  EXPECT_NEAR(fourths / n, 3, 4 * std::sqrt(96.0) / root);
  EXPECT_NEAR(beside / n, 0, 4 / root);
  EXPECT_NEAR(across / n, 0, 4 / root);
  EXPECT_NEAR(far / n, 0.0026998, 4 * std::sqrt(0.0027) / root);
}

TEST(RandomField, ShorterRowsAreTheBeginningOfLongerOnes) {
  std::vector<float> row(100), part(37), other(100);
  fill_normals(Seed{5}.rng(), 7, row);
  fill_normals(Seed{5}.rng(), 7, part);
  EXPECT_TRUE(std::equal(part.begin(), part.end(), row.begin()));
  fill_normals(Seed{5}.rng(), 8, other);
  EXPECT_NE(row, other);
  fill_normals(Seed{6}.rng(), 7, other);
  EXPECT_NE(row, other);
}

TEST(RandomField, UniformsFillTheirRange) {
  std::vector<float> row(200000);
  fill_uniforms(Seed{5}.rng(), 1, row);
  double sum = 0, squares = 0, low = 0;
  for (const float x : row) {
    ASSERT_GE(x, 0.0f);
    ASSERT_LT(x, 1.0f);
    sum += x, squares += double(x) * x, low += x < 0.005f;
  }
  const double n = static_cast<double>(row.size());
  EXPECT_NEAR(sum / n, 0.5, 4 * std::sqrt(1 / 12.0 / n));
  EXPECT_NEAR(squares / n, 1.0 / 3, 4 * std::sqrt(4 / 45.0 / n));
  EXPECT_NEAR(low / n, 0.005, 4 * std::sqrt(0.005 / n));
}

}  // namespace
}  // namespace binpick

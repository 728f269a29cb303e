#include "perception/pair_kernel.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "core/random.hpp"
#include "perception/pair_feature.hpp"
#include "perception/point_columns.hpp"
#include "perception/vote_kernel.hpp"

namespace binpick {
namespace {

std::vector<OrientedPoint> random_points(Rng& rng, std::size_t count, double size) {
  std::vector<OrientedPoint> out;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d p(rng.uniform(-size, size), rng.uniform(-size, size), rng.uniform(-size, size));
    out.push_back({p.cast<float>(), rng.unit_vector().cast<float>()});
  }
  return out;
}

TEST(PairKernel, GivesTheBitsOfThePlainFormula) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Rng rng(seed);
    const PairQuantiser q(0.1, 0.005, 12 * std::numbers::pi / 180);
    std::vector<OrientedPoint> points = random_points(rng, 101, 0.06);  // not a whole number of registers
    points[7].point = points[3].point;                                  // no length
    points[8].point = points[3].point + 0.02f * points[3].normal;       // along the normal: alpha has no direction
    points[9].normal = -points[3].normal;
    points[11].point = points[3].point + Eigen::Vector3f(0.3f, 0, 0);  // longer than the model
    const OrientedColumns columns(points);
    std::vector<int> cell(points.size()), alpha(points.size());
    pair_cells(pair_reference(points[3]), columns.view(), static_cast<int>(points.size()), {q.steps(), 1.0f},
               cell.data(), alpha.data());
    const Eigen::Matrix3f R = frame_with_x(points[3].normal);
    int with_cell = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
      EXPECT_EQ(cell[k], q.cell(pair_feature(points[3], points[k]))) << "seed " << seed << " point " << k;
      EXPECT_EQ(alpha[k], alpha_turns(R, points[k].point - points[3].point)) << "seed " << seed << " point " << k;
      with_cell += cell[k] >= 0;
    }
    EXPECT_GT(with_cell, 50) << "seed " << seed;
    EXPECT_EQ(cell[3], -1);
    EXPECT_EQ(cell[7], -1);
    EXPECT_EQ(cell[11], -1);
  }
}

TEST(PairKernel, LeavesOutPairsLongerThanTheRadius) {
  Rng rng(5);
  const std::vector<OrientedPoint> points = random_points(rng, 64, 0.06);
  const OrientedColumns columns(points);
  const PairQuantiser q(0.3, 0.005, 0.2);
  std::vector<int> cell(64), alpha(64);
  pair_cells(pair_reference(points[0]), columns.view(), 64, {q.steps(), 0.05f * 0.05f}, cell.data(), alpha.data());
  for (std::size_t k = 1; k < 64; ++k)
    EXPECT_EQ(cell[k] >= 0, (points[k].point - points[0].point).norm() <= 0.05f) << k;
}

TEST(PairMath, PolynomialAtan2StaysCloseToTheLibrarys) {
  for (int i = 0; i < 4000; ++i) {
    const double angle = 2 * std::numbers::pi * i / 4000, r = 1e-4 * (1 + i % 7);
    const int turns =
        pair_math::turns_of(static_cast<float>(r * std::cos(angle)), static_cast<float>(r * std::sin(angle)));
    EXPECT_NEAR(std::remainder(turns / 65536.0 * 2 * std::numbers::pi - angle, 2 * std::numbers::pi), 0, 8e-5) << i;
    EXPECT_TRUE(turns >= 0 && turns < 65536) << i;
  }
  EXPECT_EQ(pair_math::turns_of(0, 0), 0);
  EXPECT_EQ(pair_math::turns_of(-1, 0), 32768);  // pi exactly, as coplanar pairs have it
  EXPECT_EQ(pair_math::turns_of(-1, -0.0f), 32768);
}

TEST(PointColumns, GatherEveryPointWithinTheRadius) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Rng rng(seed);
    const std::vector<OrientedPoint> points = random_points(rng, 500, 0.1);
    for (const float cell : {0.003f, 0.02f, 0.5f}) {
      const PointColumns columns(points, cell);
      OrientedColumns out(points.size());
      for (int query = 0; query < 40; ++query) {
        const Eigen::Vector3f center = (query < 30 ? 0.1 : 1.0) * rng.unit_vector().cast<float>();
        const auto radius = static_cast<float>(rng.uniform(0.01, 0.12));
        const std::size_t count = columns.gather(center, radius, out);
        std::set<float> gathered(out.column[0].begin(), out.column[0].begin() + static_cast<std::ptrdiff_t>(count));
        EXPECT_EQ(gathered.size(), count) << "a point twice, seed " << seed;  // the x of random points differ
        for (const OrientedPoint& p : points)
          if ((p.point - center).norm() < radius) {
            EXPECT_TRUE(gathered.count(p.point.x())) << "seed " << seed << " cell " << cell;
          }
      }
    }
  }
}

TEST(PointColumns, ThinningTakesEveryPointInItsTurn) {
  Rng rng(2);
  const std::vector<OrientedPoint> points = random_points(rng, 103, 0.1);
  std::set<float> seen;
  std::size_t all = 0;
  for (std::size_t turn = 0; turn < 4; ++turn) {
    OrientedColumns columns(points);
    const std::size_t kept = columns.thin(103, 4, turn);
    all += kept;
    for (std::size_t k = 0; k < kept; ++k) {
      EXPECT_EQ(columns.column[5][k], points[turn + 4 * k].normal.z());
      seen.insert(columns.column[0][k]);
    }
  }
  EXPECT_EQ(all, 103u);
  EXPECT_EQ(seen.size(), 103u);
  OrientedColumns columns(points);
  EXPECT_EQ(columns.thin(103, 1, 5), 103u);
}

TEST(VoteKernel, FindsTheMostOfEveryRow) {
  Rng rng(3);
  std::vector<std::uint16_t> votes(37 * kAngles);
  for (std::uint16_t& v : votes) v = static_cast<std::uint16_t>(rng.below(65536));
  std::vector<std::uint16_t> maxima(37);
  const std::uint32_t most = row_maxima(votes.data(), 37, maxima.data());
  EXPECT_EQ(most, *std::max_element(votes.begin(), votes.end()));
  for (std::size_t r = 0; r < 37; ++r) {
    const auto row = votes.begin() + static_cast<std::ptrdiff_t>(r * kAngles);
    EXPECT_EQ(maxima[r], *std::max_element(row, row + kAngles)) << r;
  }
}

/// A table of two cells: 5 entries of references 0 .. 4, and 100 entries of references 0 .. 99.
struct SmallTable {
  std::vector<std::uint32_t> first = {0, 5, 105};
  std::vector<PairEntry> entries;
  SmallTable() {
    for (std::uint16_t r = 0; r < 5; ++r) entries.push_back({0, r});
    for (std::uint16_t r = 0; r < 100; ++r) entries.push_back({0, r});
  }
};

int sum(const std::vector<std::uint16_t>& votes) { return std::accumulate(votes.begin(), votes.end(), 0); }

TEST(VoteKernel, SkipsOrThinsCellsWithTooManyEntries) {
  const SmallTable table;
  const std::vector<int> cell(30, 1), alpha(30, 0);
  const CellPairs pairs{cell.data(), alpha.data(), 30};
  std::vector<std::uint16_t> all(100 * kAngles), skipped = all, thinned = all;
  cast_votes({table.first.data(), table.entries.data(), 100, 100}, pairs, all.data());
  cast_votes({table.first.data(), table.entries.data(), 99, 99}, pairs, skipped.data());
  cast_votes({table.first.data(), table.entries.data(), 100, 10}, pairs, thinned.data());
  EXPECT_EQ(sum(all), 30 * 100);
  EXPECT_EQ(sum(skipped), 0);
  EXPECT_EQ(sum(thinned), 30 * 10);
  for (std::size_t r = 0; r < 100; ++r) EXPECT_EQ(thinned[r * kAngles], 3) << r;  // each entry a tenth of the time
}

TEST(VoteKernel, NarrowAndWideCountersAgree) {
  const SmallTable table;
  Rng rng(9);
  std::vector<int> cell(200), alpha(200);
  for (int k = 0; k < 200; ++k) cell[k] = static_cast<int>(rng.below(2)), alpha[k] = static_cast<int>(rng.below(65536));
  std::vector<std::uint16_t> narrow(100 * kAngles);
  std::vector<std::uint32_t> wide(100 * kAngles);
  cast_votes({table.first.data(), table.entries.data(), 100, 100}, {cell.data(), alpha.data(), 200}, narrow.data());
  cast_votes({table.first.data(), table.entries.data(), 100, 100}, {cell.data(), alpha.data(), 200}, wide.data());
  EXPECT_TRUE(std::equal(narrow.begin(), narrow.end(), wide.begin()));
  EXPECT_GT(sum(narrow), 5000);
}

}  // namespace
}  // namespace binpick

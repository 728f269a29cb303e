#include "robot/free_way.hpp"

#include <gtest/gtest.h>

#include <future>

#include "robot_fixture.hpp"

namespace binpick {
namespace {

using namespace testing_robot;

Vector6d joints(double q1, double q2) { return (Vector6d() << q1, q2, 0, 0, 1.5, 0).finished(); }

/// A wall across joint 1 from 0.4 to 0.6 rad that reaches up to joint 2 = 0.5 rad.
FreeWayQuery around_a_wall() {
  FreeWayQuery query{joints(0, 0), joints(1, 0), {}, {}};
  query.free = [](const Vector6d& q) { return q[0] < 0.4 || q[0] > 0.6 || q[1] > 0.5; };
  return query;
}

TEST(FreeWay, GoesRoundAWall) {
  const Arm arm = mz07();
  const FreeWayQuery query = around_a_wall();
  int left = 20000;
  const auto way = find_free_way(arm, query, left);
  ASSERT_TRUE(way);
  EXPECT_GE(left, 0);
  EXPECT_EQ(way->front(), query.q_from);
  EXPECT_EQ(way->back(), query.q_to);
  EXPECT_GE(way->size(), 3u);
  for (std::size_t i = 1; i < way->size(); ++i) {
    EXPECT_TRUE(arm.within_limits((*way)[i], 1e-9));
    for (int k = 0; k <= 200; ++k) {
      const Vector6d q = (*way)[i - 1] + ((*way)[i] - (*way)[i - 1]) * (k / 200.0);
      // Checked in steps of 10 mm at a lever of 1 m: no deeper than that over a corner.
      EXPECT_TRUE(q[0] < 0.41 || q[0] > 0.59 || q[1] > 0.49) << i << ' ' << q.transpose();
    }
  }
}

TEST(FreeWay, TheDirectWayIsTakenWhereItIsFree) {
  FreeWayQuery query = around_a_wall();
  query.free = [](const Vector6d&) { return true; };
  int left = 20000;
  const auto way = find_free_way(mz07(), query, left);
  ASSERT_TRUE(way);
  EXPECT_EQ(way->size(), 2u);
}

TEST(FreeWay, GivesUpAfterTheStatedNumberOfChecks) {
  FreeWayQuery query = around_a_wall();
  int asked = 0;
  query.free = [&](const Vector6d& q) {
    ++asked;
    return q[0] < 0.4 || q[0] > 0.6;  // no gap in this wall
  };
  int left = 3000;
  EXPECT_FALSE(find_free_way(mz07(), query, left));
  EXPECT_EQ(left, 0);
  EXPECT_EQ(asked, 3000);
}

TEST(FreeWay, AnEndThatIsNotFreeCostsNoSearch) {
  FreeWayQuery query = around_a_wall();
  query.q_to = joints(0.5, 0);
  int left = 1000;
  EXPECT_FALSE(find_free_way(mz07(), query, left));
  EXPECT_EQ(left, 998);
}

TEST(FreeWay, SameBitsAgainAndOnTwoThreads) {
  const Arm arm = mz07();
  const auto search = [&] {
    int left = 20000;
    return *find_free_way(arm, around_a_wall(), left);
  };
  const std::vector<Vector6d> first = search();
  auto other = std::async(std::launch::async, search);
  const std::vector<Vector6d> second = search(), third = other.get();
  EXPECT_EQ(first, second);
  EXPECT_EQ(first, third);
}

}  // namespace
}  // namespace binpick

#include "core/bin_spec.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "core/random.hpp"

namespace binpick {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

BinSpec tote() {
  BinSpec bin;
  bin.draft = 5 * kDegree;
  bin.dividers_x = {-0.05, 0.1};
  bin.dividers_y = {0.02};
  bin.divider_height = 0.15;
  return bin;
}

bool in_any(const std::vector<Primitive>& boxes, const Eigen::Vector3d& p_B) {
  for (const Primitive& box : boxes)
    if (((box.X_OS.inverse() * p_B).cwiseAbs() - box.size / 2).maxCoeff() <= 0) return true;
  return false;
}

TEST(BinSpec, BoxesLeaveFreeWhatHalfAtSays) {
  BinSpec bin = tote();
  bin.dividers_x.clear(), bin.dividers_y.clear();
  const std::vector<Primitive> boxes = bin_boxes(bin, 0.05);
  Rng rng(1);
  int inside = 0;
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3d p(rng.uniform(-0.225, 0.225), rng.uniform(-0.175, 0.175), rng.uniform(-0.01, 0.199));
    const Eigen::Vector2d into = bin.half_at(p.z()) - p.head<2>().cwiseAbs();
    const bool free = p.z() > 0 && into.minCoeff() > 0;
    if (std::abs(p.z()) < 1e-9 || std::abs(into.minCoeff()) < 1e-9) continue;
    EXPECT_EQ(in_any(boxes, p), !free) << p.transpose();
    inside += free;
  }
  EXPECT_GT(inside, 10000);
  EXPECT_NEAR(bin.rim_size().x(), 0.4 + 2 * 0.2 * std::tan(5 * kDegree), 1e-12);
  EXPECT_EQ(bin.half_at(1), bin.half_at(0.2));
  EXPECT_EQ(bin.half_at(-1), bin.half_at(0));
}

TEST(BinSpec, VolumeIsWhatTheBoxesLeaveFree) {
  const BinSpec bin = tote();
  const std::vector<Primitive> boxes = bin_boxes(bin, 0.05);
  const Eigen::Vector3d rim = bin.rim_size();
  Rng rng(2);
  const int draws = 200000;
  int free = 0;
  for (int i = 0; i < draws; ++i)
    free +=
        !in_any(boxes, {rng.uniform(-0.5, 0.5) * rim.x(), rng.uniform(-0.5, 0.5) * rim.y(), rng.uniform() * rim.z()});
  const double share = static_cast<double>(free) / draws;
  const double sigma = std::sqrt(share * (1 - share) / draws);
  EXPECT_NEAR(bin.volume() / rim.prod(), share, 4 * sigma + 0.001);  // dividers are cut short at leaning walls
}

TEST(BinSpec, PlainBoxIsWhatItWas) {
  const BinSpec bin;
  EXPECT_FALSE(bin.shaped());
  EXPECT_EQ(bin_boxes(bin, 0.05).size(), 5u);
  EXPECT_EQ(bin.half_at(0.1), Eigen::Vector2d(0.2, 0.15));
  EXPECT_NEAR(bin.volume(), 0.4 * 0.3 * 0.2, 1e-15);
  EXPECT_EQ(bin.rim_size(), bin.inner_size);
}

TEST(BinSpec, SaysWhatIsWrong) {
  const auto error_of = [](auto&& change) {
    BinSpec bin;
    change(bin);
    try {
      bin.validate();
    } catch (const SpecError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(error_of([](BinSpec& b) { b.draft = 30 * kDegree; }).find("bin.draft"), std::string::npos);
  EXPECT_NE(error_of([](BinSpec& b) { b.draft = -0.01; }).find("bin.draft"), std::string::npos);
  EXPECT_NE(error_of([](BinSpec& b) { b.dividers_x = {0.0, 0.005}; }).find("bin.dividers_x"), std::string::npos);
  EXPECT_NE(error_of([](BinSpec& b) { b.dividers_y = {0.15}; }).find("bin.dividers_y"), std::string::npos);
  EXPECT_NE(error_of([](BinSpec& b) { b.divider_height = 0.3; }).find("bin.divider_height"), std::string::npos);
  EXPECT_NE(error_of([](BinSpec& b) { b.divider_thickness = 0; }).find("bin.divider_thickness"), std::string::npos);
  EXPECT_EQ(error_of([](BinSpec& b) { b = tote(); }), "");
}

}  // namespace
}  // namespace binpick

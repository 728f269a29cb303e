#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "core/cup_models.hpp"
#include "core/error.hpp"
#include "core/random.hpp"
#include "core/yaml.hpp"
#include "robot/gripper.hpp"

namespace binpick {
namespace {

std::unique_ptr<Gripper> suction(const std::string& yaml) {
  std::unique_ptr<Gripper> gripper = make_gripper("suction");
  read_yaml_text(yaml, "gripper.yaml", "", [&](ConfigVisitor& v) { gripper->visit(v); });
  gripper->validate();
  return gripper;
}

/// Height (along +z_G) and normal of a surface at (x, y); no value where nothing is.
using Surface = std::function<std::optional<SurfaceSample>(double x, double y)>;

std::vector<SurfaceSample> sampled(const Gripper& gripper, const Surface& surface) {
  std::vector<SurfaceSample> samples;
  for (const Eigen::Vector3d& p : gripper.probe_points_G()) {
    const auto met = surface(p.x(), p.y());
    samples.push_back(met ? *met : SurfaceSample{});
  }
  return samples;
}

SurfaceSample at(double x, double y, double z, const Eigen::Vector3d& normal, int body = 0) {
  return {true, {x, y, z}, normal.normalized(), body};
}

Surface plane(double height, double tilt = 0) {
  return [=](double x, double y) {
    return at(x, y, height + std::tan(tilt) * x, {std::sin(tilt), 0, -std::cos(tilt)});
  };
}

/// Sphere of radius R touched at its pole by the lip's plane: the rim of radius r rests on it at height 0.
Surface sphere(double R, double r) {
  const double center = std::sqrt(R * R - r * r);
  return [=](double x, double y) {
    const double z = center - std::sqrt(R * R - x * x - y * y);
    return at(x, y, z, {x, y, z - center});
  };
}

constexpr const char* kOneCup = "cups: [{radius: 10 mm}]\n";

TEST(Seal, PlaneSealsWithTheFormulasForce) {  // V-B1: 20 mm cup, 60 and 80 kPa
  const auto at_60 = suction("cups: [{radius: 10 mm, vacuum: 60 kPa}]\n"),
             at_80 = suction("cups: [{radius: 10 mm, vacuum: 80 kPa}]\n");
  const Contact contact = at_60->judge(sampled(*at_60, plane(0)));
  EXPECT_TRUE(contact.sealed) << contact.why.front();
  EXPECT_NEAR(contact.limits.pull, 18.85, 0.01);
  EXPECT_NEAR(contact.limits.shear, 9.42, 0.01);  // Coulomb, without the pyramid's 1/sqrt(3)
  EXPECT_NEAR(contact.limits.moment, 18.85 * 0.010, 1e-4);
  EXPECT_NEAR(at_80->judge(sampled(*at_80, plane(0))).limits.pull, 25.13, 0.01);
}

TEST(Seal, SphereOf50SealsAnd12DoesNot) {  // V-B5
  const auto gripper = suction(kOneCup);
  EXPECT_NEAR(50 - std::sqrt(50.0 * 50 - 100), 1.01, 0.01);  // the sag, mm
  EXPECT_TRUE(gripper->judge(sampled(*gripper, sphere(0.050, 0.010))).sealed);
  EXPECT_FALSE(gripper->judge(sampled(*gripper, sphere(0.012, 0.010))).sealed);
}

TEST(Seal, ALeakCostsVacuumInProportion) {
  // A saddle of height h: the lip rests on its crests; 32 points of h cos(2 angle) - (-h) - compliance, where positive.
  const auto gripper = suction("cups: [{radius: 10 mm, lip_compliance: 0.5 mm, leak_gap: 0.1 mm}]\n");
  const auto saddle = [](double h) -> Surface {
    return [=](double x, double y) {
      const double z = h * (x * x - y * y) / 1e-4;
      return at(x, y, z, {2 * h * x / 1e-4, -2 * h * y / 1e-4, -1});
    };
  };
  const double full = suction("cups: [{radius: 10 mm}]\n")->cups()[0].limits().pull;
  for (const double h : {0.0001, 0.00025, 0.00027, 0.00030, 0.00040}) {
    double gap = 0;
    for (int i = 0; i < 32; ++i)
      gap += std::max(0.0, h * std::cos(2 * 2 * std::numbers::pi * i / 32) + h - 0.0005) / 32;
    const double vacuum = std::max(0.0, 1 - gap / 0.0001);
    const Contact contact = gripper->judge(sampled(*gripper, saddle(h)));
    EXPECT_NEAR(contact.cup_vacuum[0], vacuum, 1e-6) << h;
    EXPECT_EQ(contact.sealed, vacuum >= 0.8) << h << ": " << contact.why[0];
    EXPECT_NEAR(contact.limits.pull, contact.sealed ? vacuum * full : 0, 1e-4) << h;
  }
}

TEST(CupModels, EachIsValidAndHoldsByItsArea) {
  for (const CupModel& model : cup_models()) {
    CupSpec cup = model.spec;
    EXPECT_NO_THROW(cup.validate()) << model.name;
    const bool flat = model.name.rfind("flat_", 0) == 0;
    const double diameter = std::stod(model.name.substr(model.name.find('_') + 1)) * 1e-3;
    EXPECT_NEAR(cup.limits().pull, (flat ? 1.0 : 0.8) * 60e3 * std::numbers::pi * diameter * diameter / 4, 1e-9);
    EXPECT_GE(cup.stroke, flat ? 0.001 : 0.004) << model.name;
    EXPECT_LE(cup.stroke, flat ? 0.003 : 0.008) << model.name;
  }
  EXPECT_NEAR(cup_model("flat_20").spec.limits().pull, 18.85, 0.005);  // physical_models B1's table
  EXPECT_NEAR(cup_model("flat_40").spec.limits().pull, 75.4, 0.05);
}

TEST(CupModels, AModelComesFirstAndOtherKeysOverrideIt) {
  const auto gripper = suction(
      "cups:\n  - {pose: {xyz: [10 mm, 0, 0]}, stroke: 20 mm, model: bellows_10}\n  - {model: flat_6}\nmin_cups: 1\n");
  ASSERT_EQ(gripper->cups().size(), 2u);
  EXPECT_EQ(gripper->cups()[0].radius, 0.005);
  EXPECT_EQ(gripper->cups()[0].stroke, 0.020);
  EXPECT_EQ(gripper->cups()[0].lip_stiffness, 1000);
  EXPECT_NEAR(gripper->cups()[0].X_GU.translation().x(), 0.010, 1e-12);
  EXPECT_EQ(gripper->cups()[1].radius, 0.003);
  try {
    suction("cups: [{model: flat_11}]\n");
    FAIL();
  } catch (const SpecError& error) {
    EXPECT_NE(std::string(error.what()).find("flat_1"), std::string::npos) << error.what();
  }
}

TEST(Seal, RimAcrossAnEdgeNeverSeals) {
  const auto gripper = suction(kOneCup);
  for (const double edge : {-0.0099, -0.005, 0.0, 0.005, 0.0099}) {
    const Contact off = gripper->judge(sampled(*gripper, [&](double x, double y) -> std::optional<SurfaceSample> {
      if (x > edge) return std::nullopt;
      return at(x, y, 0, -Eigen::Vector3d::UnitZ());
    }));
    EXPECT_FALSE(off.sealed) << edge;
    const Contact step = gripper->judge(sampled(
        *gripper, [&](double x, double y) { return at(x, y, x > edge ? 0.003 : 0, -Eigen::Vector3d::UnitZ()); }));
    EXPECT_FALSE(step.sealed) << edge;
    const Contact two = gripper->judge(sampled(
        *gripper, [&](double x, double y) { return at(x, y, 0, -Eigen::Vector3d::UnitZ(), x > edge ? 1 : 0); }));
    EXPECT_FALSE(two.sealed) << edge;
  }
}

TEST(Seal, HoleUnderTheCupLeaksThoughTheRimIsClosed) {
  const auto gripper = suction(kOneCup);
  EXPECT_FALSE(gripper
                   ->judge(sampled(*gripper,
                                   [](double x, double y) -> std::optional<SurfaceSample> {
                                     if (std::hypot(x, y) < 0.006) return std::nullopt;
                                     return at(x, y, 0, -Eigen::Vector3d::UnitZ());
                                   }))
                   .sealed);
}

TEST(Seal, TiltUpToItsLimit) {
  const auto gripper = suction("cups: [{radius: 10 mm, max_tilt: 15 deg}]\n");
  EXPECT_TRUE(gripper->judge(sampled(*gripper, plane(0, 14 * std::numbers::pi / 180))).sealed);
  EXPECT_FALSE(gripper->judge(sampled(*gripper, plane(0, 16 * std::numbers::pi / 180))).sealed);
}

TEST(Seal, PlungerReachesFromTouchToFullStroke) {
  const auto gripper = suction("cups: [{radius: 10 mm, stroke: 8 mm, lip_compliance: 0.5 mm}]\n");
  EXPECT_FALSE(gripper->judge(sampled(*gripper, plane(0.001))).sealed);
  EXPECT_TRUE(gripper->judge(sampled(*gripper, plane(0))).sealed);
  EXPECT_TRUE(gripper->judge(sampled(*gripper, plane(-0.008))).sealed);
  EXPECT_FALSE(gripper->judge(sampled(*gripper, plane(-0.009))).sealed);
}

TEST(Hold, OneCupOnTheLandPeelsAndThreeHold) {  // physical_models B1
  const double weight = 0.173 * 9.81, lever = 0.0425;
  const double moment = weight * lever;
  EXPECT_NEAR(moment, 0.072, 0.0005);
  const auto one = suction("cups: [{radius: 7 mm, vacuum: 60 kPa}]\n");
  const HoldLimits single = one->judge(sampled(*one, plane(0))).limits;
  EXPECT_NEAR(single.pull, 9.2, 0.05);
  EXPECT_GT(moment, (single.pull - weight) * 0.007);
  const auto twelve = suction("cups: [{radius: 6 mm, vacuum: 60 kPa}]\n");
  const HoldLimits small = twelve->judge(sampled(*twelve, plane(0))).limits;
  EXPECT_NEAR((small.pull - weight) * 0.006, 0.031, 0.0005);

  const auto three = suction("preset: three_cups\n");
  const HoldLimits held = three->judge(sampled(*three, plane(0))).limits;
  EXPECT_NEAR(held.pull, 14.1, 0.05);
  EXPECT_NEAR(held.pull / (0.173 * (9.81 + 5)), 5.5, 0.05);
  // Three equal pulls about the edge between two of them, and about the far side of their lips.
  EXPECT_NEAR(held.moment, held.pull * (0.0425 / 2 + 0.005), 1e-9);
  EXPECT_NEAR(held.torsion, 0.5 * held.pull * 0.0425, 1e-9);
}

TEST(Hold, TwoOfThreeCupsHoldOnlyAgainstTheirOwnRims) {
  const auto gripper = suction("preset: three_cups\nmin_cups: 2\n");
  const Contact contact = gripper->judge(sampled(*gripper, [](double x, double y) -> std::optional<SurfaceSample> {
    if (x > 0.02) return std::nullopt;  // the cup at (42.5, 0) misses
    return at(x, y, 0, -Eigen::Vector3d::UnitZ());
  }));
  EXPECT_TRUE(contact.sealed);
  const double two = 2 * gripper->cups().front().limits().pull;
  EXPECT_NEAR(contact.limits.moment, two * 0.005, 1e-9);
  // A pull at G acts 21.25 mm beside their line, 5 mm of which the lips can bear: F (21.25 + 5) = 2 V 5.
  EXPECT_NEAR(contact.limits.pull, two * 0.005 / 0.02625, 1e-9);
  const auto all = suction("preset: three_cups\n");
  EXPECT_FALSE(all->judge(sampled(*all,
                                  [](double x, double y) -> std::optional<SurfaceSample> {
                                    if (x > 0.02) return std::nullopt;
                                    return at(x, y, 0, -Eigen::Vector3d::UnitZ());
                                  }))
                   .sealed);
}

TEST(BadGripper, EachSaysWhatIsWrong) {
  const std::pair<std::string, std::string> cases[] = {
      {"cups: []\n", "at least one cup"},
      {"cups: [{radius: -1 mm}]\n", "cup.radius"},
      {"cups: [{vacuum: 200 kPa}]\n", "cup.vacuum"},
      {"min_cups: 2\n", "gripper.min_cups"},
      {"tool_length: 20 mm\n", "gripper.tool_length: too short"},
      {"preset: five_cups\n", "one_cup"},
      {"stem_radus: 1 mm\n", "did you mean stem_radius"},
  };
  for (const auto& [yaml, expected] : cases) {
    try {
      suction(yaml);
      ADD_FAILURE() << "accepted: " << yaml;
    } catch (const SpecError& error) {
      EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
    }
  }
  EXPECT_THROW(make_gripper("sucton"), SpecError);
}

}  // namespace
}  // namespace binpick

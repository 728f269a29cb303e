// Pose errors that are known on paper, MSSD against brute force, and the public BOP toolkit's own figures.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "evaluation/matching.hpp"
#include "evaluation/metric.hpp"
#include "tests/evaluation/example_parts.hpp"

namespace binpick {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180;

TEST(PoseError, OneMillimetreIsOneMillimetre) {
  for (const Part& part : examples::all()) {
    Rng rng = Seed{1}.child("1 mm").rng();
    const Pose X_true = examples::random_pose(rng);
    const PoseError error = pose_error(examples::moved_to(0.001, 0, 0) * X_true, X_true, part);
    EXPECT_NEAR(error.mssd, 0.001, 1e-9) << part.name;
    EXPECT_NEAR(error.translation, 0.001, 1e-12) << part.name;
    EXPECT_NEAR(error.rotation, 0, 1e-9) << part.name;
    EXPECT_LE(error.add_s, 0.001 + 1e-12) << part.name;
    EXPECT_LT((error.abs_xyz - Eigen::Vector3d(0.001, 0, 0)).norm(), 1e-12) << part.name;
  }
}

// A box turned about its own centre: a corner at distance r from the axis moves by 2 r sin(angle / 2).
TEST(PoseError, ABoxTurnedAboutItsCentre) {
  const Part part = examples::box();
  const double angle = 7 * kDegree;
  const Pose X_est = examples::turn(part.box_center_P, Eigen::Vector3d::UnitZ(), angle);
  const PoseError error = pose_error(X_est, Pose::Identity(), part);
  const double move = 2 * std::hypot(0.04, 0.025) * std::sin(angle / 2);
  EXPECT_NEAR(error.mssd, move, 1e-12);
  EXPECT_NEAR(error.rotation, angle, 1e-12);
  EXPECT_NEAR(error.translation, 0, 1e-15);
  EXPECT_LT((error.abs_rpy - Eigen::Vector3d(0, 0, angle)).norm(), 1e-12);
  EXPECT_NEAR(make_metric("add")->error(X_est, Pose::Identity(), ScoringModel(part)), move, 1e-12);
  EXPECT_NEAR(error.add_s, move, 1e-12);  // so small a turn leaves every corner nearest to itself
}

// Beyond 90 degrees the twin that is half a turn away is the nearer one.
TEST(PoseError, ABoxTurnedByOneHundredAndSeventyDegrees) {
  const Part part = examples::box();
  const PoseError error =
      pose_error(examples::turn(part.box_center_P, Eigen::Vector3d::UnitZ(), 170 * kDegree), Pose::Identity(), part);
  EXPECT_NEAR(error.rotation, 10 * kDegree, 1e-12);
  EXPECT_NEAR(error.abs_rpy.z(), 10 * kDegree, 1e-12);
  EXPECT_NEAR(error.mssd, 2 * std::hypot(0.04, 0.025) * std::sin(5 * kDegree), 1e-12);
}

// An origin drawn far from the part must not turn rotation into translation.
TEST(PoseError, TranslationIsTakenAtTheBoxCentre) {
  const Part part = examples::bracket();
  const PoseError error = pose_error(examples::turn(part.box_center_P, {1, 2, 3}, 0.3), Pose::Identity(), part);
  EXPECT_NEAR(error.translation, 0, 1e-15);
  EXPECT_LT(error.abs_xyz.norm(), 1e-15);
  EXPECT_NEAR(error.rotation, 0.3, 1e-12);
  EXPECT_GT(error.mssd, 0.01);
}

// A disc (radius r, height h) tilted by a about its centre: the twin turned by nothing is the best, and the rim point
// on the steepest line moves most, by 2 sqrt(r^2 + h^2/4) sin(a / 2). The rim of the mesh is on the true circle.
TEST(PoseError, ATiltedDisc) {
  const Part part = examples::disc();
  const double tilt = 4 * kDegree;
  const Pose X_est = examples::turn(part.box_center_P, Eigen::Vector3d::UnitY(), tilt) *
                     examples::turn(part.box_center_P, Eigen::Vector3d::UnitZ(), 1.234) *
                     examples::turn(part.box_center_P, Eigen::Vector3d::UnitX(), kPi);
  const PoseError error = pose_error(X_est, Pose::Identity(), part);
  EXPECT_NEAR(error.rotation, tilt, 1e-9);
  EXPECT_NEAR(error.translation, 0, 1e-12);
  const double largest = 2 * std::hypot(0.05, 0.008) * std::sin(tilt / 2);
  EXPECT_LE(error.mssd, largest + 1e-6 * part.diameter);
  EXPECT_GE(error.mssd, largest * std::cos(kPi / 48));  // 48 facets: some vertex is within 3.75 degrees of that line
}

TEST(PoseError, AngleErrorsWrap) {
  const Part part = examples::bracket();
  const Pose X_true = pose_from_xyz_rpy({0, 0, 0}, {0, 0, kPi - 0.01});
  const Pose X_est = pose_from_xyz_rpy({0, 0, 0}, {0, 0, -kPi + 0.01});
  EXPECT_NEAR(pose_error(X_est, X_true, part).abs_rpy.z(), 0.02, 1e-12);
}

// The branch and bound of a continuous axis against 5000 turns: never above the samples (but for its tolerance), and
// below them by no more than half a step can make.
TEST(PoseError, MssdOfRoundPartsAgainstBruteForce) {
  const std::unique_ptr<Metric> mssd = make_metric("mssd");
  constexpr int kTurns = 5000;
  for (const Part& part : {examples::disc(), examples::shaft()}) {
    const ScoringModel model(part);
    const std::vector<Pose> group = sampled_group(part.symmetry, kTurns);
    for (std::uint64_t i = 0; i < 12; ++i) {
      Rng rng = Seed{20261124}.child("brute force " + part.name).rng().at(i);
      const Pose X_true = examples::random_pose(rng);
      Pose X_est = X_true * examples::random_member(part.symmetry, rng);
      X_est = X_est * examples::turn(part.box_center_P, rng.unit_vector(), i < 6 ? 0.1 : rng.uniform(0, kPi));
      X_est.translation() += rng.uniform(0, 0.02) * rng.unit_vector();
      double sampled = 1e9;
      for (const Pose& S : group) {
        double worst = 0;
        for (const Eigen::Vector3d& x : model.hull_P()) worst = std::max(worst, (X_est * x - X_true * (S * x)).norm());
        sampled = std::min(sampled, worst);
      }
      const double ours = mssd->error(X_est, X_true, model);
      EXPECT_LE(ours, sampled + 1e-6 * part.diameter) << part.name << ", item " << i;
      EXPECT_GE(ours, sampled - part.diameter / 2 * kPi / kTurns) << part.name << ", item " << i;
    }
  }
}

TEST(PoseError, LowerBoundIsOne) {
  const std::unique_ptr<Metric> mssd = make_metric("mssd");
  std::vector<Part> parts = examples::all();
  SymmetrySpec eccentric;  // an axis beside the middle of the hull: a twin may carry that far away
  eccentric.type = "revolution";
  parts.push_back(examples::part_of("eccentric", examples::bracket().mesh_P, eccentric));
  for (const Part& part : parts) {
    const ScoringModel model(part);
    for (std::uint64_t i = 0; i < 100; ++i) {
      Rng rng = Seed{20261124}.child("bound " + part.name).rng().at(i);
      const Pose X_true = examples::random_pose(rng);
      const Pose X_est = i % 2 ? examples::random_pose(rng) : X_true * examples::random_member(part.symmetry, rng);
      EXPECT_LE(model.mssd_lower_bound(X_est, X_true), mssd->error(X_est, X_true, model) + 1e-12)
          << part.name << ", item " << i;
    }
  }
}

/// The objects and poses of the BOP figures, in metres.
class BopFigures : public testing::Test {
 protected:
  BopFigures() {
    std::ifstream file(BINPICK_SOURCE_DIR "/tests/evaluation/data/bop_metric_cases.json");
    figures_ = nlohmann::json::parse(file);
  }

  Part part(const std::string& name) const {
    const nlohmann::json& object = figures_["objects"][name];
    TriangleMesh mesh;
    for (const auto& p : object["points"]) mesh.vertices.push_back(1e-3 * Eigen::Vector3d(p[0], p[1], p[2]));
    for (std::uint32_t i = 0; i + 2 < mesh.vertices.size(); ++i) mesh.triangles.push_back({i, i + 1, i + 2});
    SymmetrySpec symmetry;
    if (name == "box") symmetry.type = "dihedral";
    if (object.contains("symmetries_continuous")) symmetry.type = "revolution";
    symmetry.flip = name == "ring";
    Part made = examples::part_of(name, mesh, symmetry);
    made.box_center_P.setZero();  // that toolkit takes the translation error at the origin
    return made;
  }

  static Pose pose(const nlohmann::json& R, const nlohmann::json& t) {
    Pose X = Pose::Identity();
    for (int i = 0; i < 9; ++i) X.linear()(i / 3, i % 3) = R[static_cast<std::size_t>(i)];
    X.translation() = 1e-3 * Eigen::Vector3d(t[0], t[1], t[2]);
    return X;
  }

  nlohmann::json figures_;
};

TEST_F(BopFigures, AreReproduced) {
  const std::unique_ptr<Metric> add = make_metric("add"), adi = make_metric("add_s"), mssd = make_metric("mssd"),
                                rotation = make_metric("rotation"), translation = make_metric("translation");
  std::size_t index = 0;
  for (const nlohmann::json& c : figures_["cases"]) {
    SCOPED_TRACE("case " + std::to_string(index++));
    const Part with = part(c["object"]);
    Part without = with;  // ADD, ADI, RE and TE of that toolkit know no symmetry
    without.symmetry = Symmetry{};
    const ScoringModel model(without);
    const Pose X_est = pose(c["R_est"], c["t_est"]), X_true = pose(c["R_gt"], c["t_gt"]);
    EXPECT_NEAR(add->error(X_est, X_true, model), 1e-3 * c["add"].get<double>(), 1e-9);
    EXPECT_NEAR(adi->error(X_est, X_true, model), 1e-3 * c["adi"].get<double>(), 1e-9);
    EXPECT_NEAR(rotation->error(X_est, X_true, model), c["re"].get<double>() * kDegree, 1e-7);
    EXPECT_NEAR(translation->error(X_est, X_true, model), 1e-3 * c["te"].get<double>(), 1e-9);
    // That toolkit samples a continuous axis at 315 turns: it may lie above the minimum by what half a step can do.
    const double half_step = with.symmetry.axis ? with.diameter / 2 * kPi / 315 : 0;
    const double ours = mssd->error(X_est, X_true, ScoringModel(with)), theirs = 1e-3 * c["mssd"].get<double>();
    EXPECT_LE(ours, theirs + 1e-6 * with.diameter);
    EXPECT_GE(ours, theirs - half_step - 1e-9);
  }
  EXPECT_EQ(index, 240u);
}

}  // namespace
}  // namespace binpick

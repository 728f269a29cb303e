// Estimators in another process: the contract through the protocol, what goes out, and every way the answer can be bad.
#include <gmock/gmock.h>
#include <signal.h>

#include <filesystem>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "perception/frame_request.hpp"
#include "tests/perception/estimator_contract.hpp"
#include "tests/tools/run_program.hpp"

namespace binpick {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// The program itself is the foreign one: what it finds must come through unharmed.
INSTANTIATE_TEST_SUITE_P(Protocol, EstimatorContract,
                         testing::Values(ContractCase{
                             "external", "command: [" BINPICK_PROGRAM ", estimate, --out, estimates.csv]\n"}),
                         [](const auto& held) { return held.param.name; });

const std::string kHead = "part,score,r11,r12,r13,r21,r22,r23,r31,r32,r33,tx,ty,tz\\n";

class External : public testing::Test {
 protected:
  External() : part_(ring_part()) {
    view_.seen = DepthFrame();
    auto& frame = std::get<DepthFrame>(view_.seen);
    frame.camera = {64, 48, 60, 61, 31.5, 23.5};
    frame.depth = Image<float>(64, 48, 0.6f);
    frame.depth(3, 4) = std::numeric_limits<float>::quiet_NaN();
    frame.noise = {0.001, 0.0, 0.004, 1.5};
    view_.bin = BinSpec();
    view_.X_CB = camera_above(0.6).inverse();
  }

  /// The answer of a shell script; `OUT` in it stands for a folder that stays.
  EstimateResult answer(std::string script, const std::string& limit = "60 s") {
    for (std::size_t at; (at = script.find("OUT")) != std::string::npos;) script.replace(at, 3, out_.path());
    const auto estimator = made({"external", "command: [/bin/sh, -c, '" + script + "']\ntime_limit: " + limit + "\n"});
    estimator->validate();
    estimator->prepare({&part_, 1});
    return estimator->estimate(view_, Seed{18446744073709551615u});
  }

  void expect_failure(const std::string& script, const std::string& said, const std::string& limit = "60 s") {
    const EstimateResult result = answer(script + "; pwd > OUT/where", limit);
    EXPECT_EQ(result.status, EstimateStatus::kFailed) << script;
    EXPECT_TRUE(result.estimates.empty());
    EXPECT_THAT(result.message, HasSubstr(said)) << script;
    EXPECT_EQ(result.message.find('\n'), std::string::npos);
  }

  TemporaryFolder out_;
  Part part_;
  SceneView view_;
};

TEST_F(External, AnAnswerComesThroughAndTheFolderGoes) {
  const EstimateResult result =
      answer("pwd > OUT/where; printf \"" + kHead + "0,0.25,1,0,0,0,1,0,0,0,1,0.1,-0.2,0.5\\n\" > estimates.csv");
  ASSERT_EQ(result.status, EstimateStatus::kFound) << result.message;
  ASSERT_EQ(result.estimates.size(), 1u);
  EXPECT_EQ(result.estimates[0].X_CP.translation(), Eigen::Vector3d(0.1, -0.2, 0.5));
  std::string where = read_file(out_.path("where"));
  where.pop_back();
  EXPECT_THAT(where, HasSubstr("/tmp/binpick_frame_"));
  EXPECT_FALSE(fs::exists(where));
}

TEST_F(External, NoRowsIsNothingFound) {
  EXPECT_EQ(answer("printf \"" + kHead + "\" > estimates.csv").status, EstimateStatus::kNothingFound);
}

TEST_F(External, TheFolderHoldsTheWholeRequest) {
  answer("cp -r . OUT/copy");
  const RecordedFrame copy = read_frame_folder(out_.path("copy"));
  const auto& sent = std::get<DepthFrame>(view_.seen);
  const auto& got = std::get<DepthFrame>(copy.view.seen);
  EXPECT_EQ(got.camera.fx, sent.camera.fx);
  EXPECT_EQ(got.camera.cy, sent.camera.cy);
  EXPECT_EQ(got.noise.quadratic, sent.noise.quadratic);
  EXPECT_EQ(got.noise.fattening_px, sent.noise.fattening_px);
  EXPECT_EQ(got.noise.focal_baseline, sent.noise.focal_baseline);
  for (std::size_t i = 0; i < sent.depth.size(); ++i)
    EXPECT_TRUE(got.depth[i] == sent.depth[i] || (std::isnan(got.depth[i]) && std::isnan(sent.depth[i])));
  EXPECT_EQ(copy.request.seed.key, 18446744073709551615u);
  EXPECT_EQ(copy.request.time_limit, 60);
  ASSERT_TRUE(copy.view.bin.has_value());
  EXPECT_EQ(copy.view.bin->inner_size, view_.bin->inner_size);
  EXPECT_LT((copy.view.X_CB.matrix() - view_.X_CB.matrix()).norm(), 1e-12);
  ASSERT_EQ(copy.request.parts.size(), 1u);
  const Part part = load_part(copy.request.parts[0]);
  EXPECT_EQ(part.name, part_.name);
  EXPECT_NEAR(part.diameter, part_.diameter, 1e-6);
  EXPECT_NEAR(part.mass.mass, part_.mass.mass, 1e-9);
  EXPECT_TRUE(part.symmetry.axis.has_value());
  EXPECT_EQ(part.symmetry.finite.size(), part_.symmetry.finite.size());
}

TEST_F(External, SymmetriesArriveAsTheyWere) {
  for (const char* yaml :
       {"type: none", "type: cyclic\norder: 5\naxis: [0, 1, 0]\npoint: [0.01, 0, 0.02]",
        "type: dihedral\norder: 2\naxis: [0, 0, 1]\nperpendicular: [1, 0, 0]\npoint: [0.01, 0.02, 0.03]",
        "type: dihedral\norder: 24\naxis: [1, 0, 0]\nperpendicular: [0, 0, 1]",
        "type: revolution\naxis: [0, 0, 1]\nflip: true\npoint: [0, 0.01, 0.04]", "type: revolution\naxis: [1, 0, 0]",
        "type: sphere\npoint: [0.01, 0, 0]"}) {
    SymmetrySpec spec;
    read_yaml_text(yaml, "test", "/", [&](ConfigVisitor& v) { spec.visit(v); });
    part_.symmetry = make_symmetry(spec);
    fs::remove_all(out_.path("copy"));
    answer("cp -r . OUT/copy");
    const Symmetry got = make_symmetry(read_frame_folder(out_.path("copy")).request.parts[0].symmetry);
    EXPECT_EQ(got.finite.size(), part_.symmetry.finite.size()) << yaml;
    EXPECT_EQ(got.axis.has_value(), part_.symmetry.axis.has_value()) << yaml;
    for (const Pose& S : sampled_group(part_.symmetry, 4)) {  // each is a member of what arrived
      const Pose near = nearest_equivalent(Pose::Identity(), S, got);
      if (!got.center_P) {
        EXPECT_LT((near.matrix() - S.matrix()).norm(), 1e-6) << yaml;
      }
    }
  }
}

TEST_F(External, EveryBadAnswerIsAFailureInOneLine) {
  expect_failure("exit 3", "ended with code 3");
  expect_failure("echo broken >&2; exit 1", "ended with code 1: broken");
  expect_failure("kill -11 $$", "ended with code 139");
  expect_failure("true", "estimates.csv");
  expect_failure("mkdir estimates.csv", "estimates.csv");
  expect_failure("printf \"" + kHead + "0,0.5,1,0,0,0,1,0,0,0,1,0,0,nan\\n\" > estimates.csv", "estimates.csv:2: tz: ");
  expect_failure("printf \"" + kHead + "0,0.5,1,0,0,0,1,0,0,0,2,0,0,1\\n\" > estimates.csv", "not a rotation");
  expect_failure("printf \"" + kHead + "1,0.5,1,0,0,0,1,0,0,0,1,0,0,1\\n\" > estimates.csv", "part 1");
  expect_failure("sleep 1000", "not done within 0.3 s", "300 ms");
}

TEST_F(External, OneThatCannotBeStartedFails) {
  const auto estimator = made({"external", "command: [no_such_program_of_ours]\n"});
  estimator->prepare({&part_, 1});
  const EstimateResult result = estimator->estimate(view_, Seed{1});
  EXPECT_EQ(result.status, EstimateStatus::kFailed);
  EXPECT_THAT(result.message, HasSubstr("no_such_program_of_ours: cannot be started"));
}

TEST_F(External, WithoutACommandIsNoEstimator) {
  EXPECT_THROW(make_estimator("external")->validate(), SpecError);
  EXPECT_THROW(made({"external", "command: [x]\ntime_limit: 0\n"})->validate(), SpecError);
  EXPECT_THROW(made({"external", "command: x\n"}), SpecError);
}

// The example of the documentation, on a frame with one ring lying alone: within the slab it takes for the top.
TEST(ExternalExample, FindsTheRingOnTop) {
  const Part part = ring_part();
  HeapOptions options;
  options.count = 1;
  options.upright_share = 0;
  const auto estimator =
      made({"external", "command: [/usr/bin/python3, " BINPICK_SOURCE_DIR "/docs/examples/external_estimator.py]\n"});
  estimator->prepare({&part, 1});
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Instance ring;
    ring.X_WP.translation() = Eigen::Vector3d(0.02 * static_cast<double>(seed), -0.03, 0.008);
    const HeapScene scene = photograph(part, {ring}, options, Seed{seed}, camera_above(0.6));
    const EstimateResult found = estimator->estimate(scene.view, Seed{seed});
    ASSERT_EQ(found.status, EstimateStatus::kFound) << found.message;
    const Eigen::Vector3d truth = scene.X_WC.inverse() * ring.X_WP.translation();
    EXPECT_LT((found.estimates[0].X_CP.translation() - truth).norm(), 0.006) << "seed " << seed;
    EXPECT_GT(std::abs(found.estimates[0].X_CP.linear().col(2).z()), 0.999);
  }
}

}  // namespace
}  // namespace binpick

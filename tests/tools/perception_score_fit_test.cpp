// The fit of the score's weights, on answers drawn from a known law.
#include "tools/bench/perception_score_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"
#include "core/file_io.hpp"

namespace binpick {
namespace {

std::vector<ScoreSample> drawn(const ScoreTerms& law, int count, Seed seed) {
  std::vector<ScoreSample> samples(static_cast<std::size_t>(count));
  Rng rng = seed.rng();
  for (ScoreSample& s : samples) {
    s.part = rng.uniform() < 0.5 ? "a" : "b";
    s.features[0] = 1;
    for (std::size_t k = 1; k < kScoreFeatures; ++k) s.features[k] = rng.normal(0.3 * static_cast<double>(k % 4), 1);
    s.features[kScoreFeatures - 1] -= 1.6;  // about the usual noise, where the products are apart from the features
    s.right = rng.uniform() < probability(law, s);
  }
  return samples;
}

TEST(ScoreFit, FindsTheLawThatMadeTheAnswers) {
  ScoreTerms law{};
  law[0] = -0.5, law[1] = 2, law[3] = -1.5, law[5] = 0.7;
  law[kScoreFeatures] = 0.8;  // the first feature times the noise
  const auto samples = drawn(law, 20000, Seed{1});
  const ScoreTerms found = fit_weights(samples, 1);
  for (std::size_t k = 0; k < kScoreTerms; ++k) EXPECT_NEAR(found[k], law[k], 0.12) << k;
}

TEST(ScoreFit, StaysFiniteWhereTheAnswersCanBeSeparated) {
  std::vector<ScoreSample> samples = drawn({}, 200, Seed{2});
  for (ScoreSample& s : samples) s.right = s.features[1] > 0.3;
  for (const double w : fit_weights(samples, 1)) EXPECT_TRUE(std::isfinite(w));
}

TEST(ScoreFit, LeavesFlaggedPosesOut) {
  ScoreTerms law{};
  law[1] = 2;
  std::vector<ScoreSample> samples = drawn(law, 500, Seed{3}), more = samples;
  ScoreSample flagged = samples[0];
  flagged.ambiguous = true;
  flagged.right = !flagged.right;
  more.insert(more.end(), 500, flagged);
  EXPECT_EQ(fit_weights(more, 1), fit_weights(samples, 1));
}

TEST(ScoreFit, ABadFileIsNamedWithItsLine) {
  const std::string path = ::testing::TempDir() + "score_fit_test.csv";
  write_file(path, "part,sensor,seed,right,ambiguous\nplate,ideal,1,1,0,1,2\n");
  try {
    read_features(path);
    FAIL();
  } catch (const SpecError& e) {
    EXPECT_NE(std::string(e.what()).find(path + ":2"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace binpick

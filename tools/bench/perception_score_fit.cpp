#include "tools/bench/perception_score_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <sstream>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "tools/bench/perception_calibration.hpp"

namespace binpick {
namespace {

constexpr int kSteps = 40;
constexpr double kScores[] = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9};

using Weights = Eigen::Matrix<double, static_cast<int>(kScoreTerms), 1>;
using Hessian = Eigen::Matrix<double, static_cast<int>(kScoreTerms), static_cast<int>(kScoreTerms)>;

Weights vector_of(const ScoreTerms& t) { return Eigen::Map<const Weights>(t.data()); }
Weights terms_of(const ScoreSample& s) { return vector_of(score_terms(s.features)); }

std::vector<ScoreSample> clear_ones(std::span<const ScoreSample> samples) {
  std::vector<ScoreSample> out;
  for (const ScoreSample& s : samples)
    if (!s.ambiguous) out.push_back(s);
  return out;
}

/// Standard deviation of each feature; the constant's is 1.
Weights spreads(std::span<const ScoreSample> samples) {
  Weights mean = Weights::Zero(), square = Weights::Zero();
  for (const ScoreSample& s : samples) mean += terms_of(s);
  mean /= static_cast<double>(samples.size());
  for (const ScoreSample& s : samples) square += (terms_of(s) - mean).cwiseAbs2();
  Weights spread = (square / static_cast<double>(samples.size())).cwiseSqrt().cwiseMax(1e-9);
  spread[0] = 1;
  return spread;
}

double log_loss(const ScoreTerms& weights, std::span<const ScoreSample> samples) {
  double sum = 0;
  for (const ScoreSample& s : samples) {
    const double p = std::clamp(probability(weights, s), 1e-6, 1 - 1e-6);
    sum -= std::log(s.right ? p : 1 - p);
  }
  return sum / static_cast<double>(std::max<std::size_t>(1, samples.size()));
}

double error_of(const ScoreTerms& weights, std::span<const ScoreSample> samples) {
  std::vector<ScoredEstimate> scored;
  for (const ScoreSample& s : samples) scored.push_back({probability(weights, s), s.right, s.ambiguous, 0, 0, 0});
  return calibration_error(reliability(scored, 10));
}

/// The part's name without the size that --part-scale added: sizes of one shape are left out together.
std::string shape_of(const std::string& part) { return part.substr(0, part.find(" x ")); }

std::string left_out(std::span<const ScoreSample> samples, double ridge, double wrong_weight) {
  std::set<std::string> parts;
  for (const ScoreSample& s : samples) parts.insert(shape_of(s.part));
  std::string text;
  for (const std::string& part : parts) {
    std::vector<ScoreSample> rest, out;
    for (const ScoreSample& s : samples) (shape_of(s.part) == part ? out : rest).push_back(s);
    if (rest.empty()) continue;
    const ScoreTerms weights = fit_weights(rest, ridge, wrong_weight);
    char line[160];
    std::snprintf(line, sizeof line, "  %-20s %6zu poses, %5.1f %% right: log loss %.3f, calibration error %.3f\n",
                  part.c_str(), out.size(),
                  100.0 * static_cast<double>(std::count_if(out.begin(), out.end(), [](auto& s) { return s.right; })) /
                      static_cast<double>(out.size()),
                  log_loss(weights, out), error_of(weights, out));
    text += line;
  }
  return text;
}

}  // namespace

std::string features_csv(std::span<const PerceptionRow> rows) {
  std::ostringstream out;
  out << "part,sensor,seed,right,ambiguous";
  for (const std::string& name : score_feature_names()) out << "," << name;
  out << "\n";
  out.precision(9);
  for (const PerceptionRow& row : rows)
    for (const ScoredFeatures& f : row.features) {
      out << row.part << "," << row.sensor << "," << f.seed << "," << f.scored.right << "," << f.scored.ambiguous;
      for (const double x : f.features) out << "," << x;
      out << "\n";
    }
  return out.str();
}

std::vector<ScoreSample> read_features(const std::string& path) {
  std::istringstream file(read_file(path));
  std::vector<ScoreSample> samples;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    if (number == 1) continue;
    std::istringstream cells(line);
    ScoreSample s;
    std::string seed, right, ambiguous, cell;
    bool good = std::getline(cells, s.part, ',') && std::getline(cells, s.sensor, ',') &&
                std::getline(cells, seed, ',') && std::getline(cells, right, ',') &&
                std::getline(cells, ambiguous, ',');
    s.right = right == "1";
    s.ambiguous = ambiguous == "1";
    for (double& x : s.features) {
      good = good && std::getline(cells, cell, ',');
      std::istringstream value(cell);
      good = good && (value >> x) && std::isfinite(x);
    }
    if (!good)
      throw SpecError(path + ":" + std::to_string(number) + ": expected part,sensor,seed,right,ambiguous and " +
                      std::to_string(kScoreFeatures) + " numbers");
    samples.push_back(s);
  }
  if (samples.empty()) throw SpecError(path + ": no estimate in it");
  return samples;
}

double probability(const ScoreTerms& weights, const ScoreSample& sample) {
  return 1 / (1 + std::exp(-vector_of(weights).dot(terms_of(sample))));
}

ScoreTerms fit_weights(std::span<const ScoreSample> all, double ridge, double wrong_weight) {
  const std::vector<ScoreSample> samples = clear_ones(all);
  const Weights spread = spreads(samples);
  Weights w = Weights::Zero();  // of the features divided by their spreads
  for (int step = 0; step < kSteps; ++step) {
    Weights gradient = ridge * w;
    Hessian hessian = ridge * Hessian::Identity();
    gradient[0] = 0;
    hessian(0, 0) = 1e-9;
    for (const ScoreSample& s : samples) {
      const Weights x = terms_of(s).cwiseQuotient(spread);
      const double p = 1 / (1 + std::exp(-w.dot(x)));
      const double counts = s.right ? 1 : wrong_weight;
      gradient += counts * (p - (s.right ? 1 : 0)) * x;
      hessian += counts * std::max(p * (1 - p), 1e-6) * x * x.transpose();
    }
    w -= hessian.ldlt().solve(gradient);
  }
  ScoreTerms out;
  Eigen::Map<Weights>(out.data()) = w.cwiseQuotient(spread);
  return out;
}

std::vector<Threshold> thresholds(const ScoreTerms& weights, std::span<const ScoreSample> samples) {
  std::vector<Threshold> out;
  for (const double score : kScores) {
    Threshold t;
    t.score = score;
    for (const ScoreSample& s : samples) {
      const bool kept = probability(weights, s) >= score;
      t.right += s.right;
      t.kept += kept;
      t.kept_right += kept && s.right;
    }
    out.push_back(t);
  }
  return out;
}

std::string fit_report(std::span<const ScoreSample> all, double ridge, double wrong_weight) {
  const std::vector<ScoreSample> samples = clear_ones(all);
  if (samples.empty()) throw SpecError("no unambiguous estimate to fit to");
  const ScoreTerms weights = fit_weights(samples, ridge, wrong_weight);
  std::ostringstream out;
  char line[200];
  out << "constexpr ScoreTerms kWeights = {";
  for (std::size_t k = 0; k < kScoreTerms; ++k) {
    std::snprintf(line, sizeof line, "%s%.5g", k > 0 ? ", " : "", weights[k]);
    out << line;
  }
  std::snprintf(line, sizeof line,
                "};\n%zu poses, %zu of them flagged and not used; log loss %.4f, calibration error %.4f\n", all.size(),
                all.size() - samples.size(), log_loss(weights, samples), error_of(weights, samples));
  out << line << "score >=   kept   right of them   right ones kept\n";
  for (const Threshold& t : thresholds(weights, samples)) {
    std::snprintf(line, sizeof line, "  %.1f    %6zu      %6.2f %%        %6.2f %%\n", t.score, t.kept,
                  100.0 * static_cast<double>(t.kept_right) / static_cast<double>(std::max<std::size_t>(1, t.kept)),
                  100.0 * static_cast<double>(t.kept_right) / static_cast<double>(std::max<std::size_t>(1, t.right)));
    out << line;
  }
  out << "one shape left out, then judged:\n" << left_out(samples, ridge, wrong_weight);
  return out.str();
}

}  // namespace binpick

#include "perception/ppf_pipeline.hpp"

#include <algorithm>
#include <chrono>
#include <memory>

#include "core/check.hpp"
#include "perception/large_planes.hpp"
#include "perception/part_search.hpp"
#include "perception/symmetry_covariance.hpp"
#include "perception/why_nothing.hpp"

namespace binpick {
namespace {

constexpr int kRim = 2;           // px about an explained pixel that count as explained, too
constexpr int kShares = 8;        // of the references, when few poses are enough
constexpr std::size_t kWave = 4;  // hypotheses refined at a time then
constexpr double kTrusted = 0.5;  // probability from which a pose may explain what lies about another

class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

PoseEstimate to_estimate(const Candidate& c, const PreparedPart& part) {
  PoseEstimate e;
  e.part = c.part;
  e.X_CP = c.fit.X_CP;
  e.score = c.score;
  e.ambiguous = c.ambiguous;
  e.fit_rms = c.fit.rms;
  const int judged = c.check.inliers + c.check.through + c.check.off + c.check.unknown;
  e.inlier_fraction = judged > 0 ? static_cast<double>(c.check.inliers) / judged : 0;
  e.covariance = c.fit.covariance + unknowable(part.twists);
  return e;
}

void add_explained(const Candidate& c, int by, std::vector<std::uint8_t>& times) {
  for (const std::uint32_t i : c.check.explained) times[i] = static_cast<std::uint8_t>(times[i] + by);
}

/// Of every pixel, how many of the counted poses explain it.
std::vector<std::uint8_t> times_explained(const Scene& scene, const std::vector<Candidate>& poses,
                                          const std::vector<char>& counted) {
  std::vector<std::uint8_t> times(scene.depth.size(), 0);
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (counted[i]) add_explained(poses[i], 1, times);
  return times;
}

/// Probability that a pose or its twin is right: one of two twins is as good as the pair of them.
double either(const Candidate& c) { return (c.ambiguous ? 2 : 1) * c.score; }

/// The scene without the pixels that sure poses explain.
Scene unexplained(const Scene& scene, const std::vector<Candidate>& standing, double sure_quality) {
  Scene rest = scene;
  const int width = scene.depth.width();
  for (const Candidate& c : standing) {
    if (c.check.quality() < sure_quality) continue;
    for (const std::uint32_t i : c.check.explained) {
      const int u = static_cast<int>(i) % width, v = static_cast<int>(i) / width;
      for (int b = -kRim; b <= kRim; ++b)
        for (int a = -kRim; a <= kRim; ++a)
          if (rest.wanted.contains(u + a, v + b)) rest.wanted(u + a, v + b) = 0;
    }
  }
  return rest;
}

}  // namespace

/// One search for every kind of part.
std::vector<Candidate> PpfEstimator::search(const Scene& scene, StageTimes& wall) const {
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const PreparedPart& part = parts_[i];
    Stopwatch stage;
    const ScenePoints points = scene_points(scene, part, settings_);
    wall.preprocess += stage.lap();
    std::vector<PoseHypothesis> poses = voted_poses(points, part, settings_);
    wall.voting += stage.lap();
    poses = verified_poses(scene, part, poses, settings_);
    wall.verification += stage.lap();
    for (Candidate& c : refined_poses(scene, part, poses, settings_)) {
      c.part = i;
      candidates.push_back(std::move(c));
    }
    wall.icp += stage.lap();
  }
  return candidates;
}

/// Every pose against what the view might take for it. True when one was changed.
bool PpfEstimator::settle(const Scene& scene, std::vector<Candidate>& standing) const {
  bool changed = false;
  std::vector<std::uint8_t> taken = times_explained(scene, standing, std::vector<char>(standing.size(), 1));
  for (Candidate& c : standing) {
    if (c.settled) continue;
    const PreparedPart& part = parts_[c.part];
    add_explained(c, -1, taken);
    changed |=
        settle_rivals(scene, part.surface, part.overlaps, {settings_.rivals, settings_.icp, settings_.check}, taken, c);
    add_explained(c, 1, taken);
    c.settled = true;
  }
  return changed;
}

/// What can stand together of the candidates, each tried against its rivals.
std::vector<Candidate> PpfEstimator::stand(const Scene& scene, std::vector<Candidate> candidates) const {
  std::vector<const SurfaceModel*> models;
  for (const PreparedPart& p : parts_) models.push_back(&p.surface);
  candidates = resolve_conflicts(std::move(candidates), models, scene, settings_.accept);
  if (settle(scene, candidates)) candidates = resolve_conflicts(std::move(candidates), models, scene, settings_.accept);
  return candidates;
}

std::vector<Candidate> PpfEstimator::all_poses(const Scene& scene, StageTimes& wall) const {
  std::vector<Candidate> standing;
  for (int round = 0; round < settings_.search.rounds; ++round) {
    const std::size_t before = standing.size();
    const Scene rest = unexplained(scene, standing, settings_.accept.sure_quality);
    for (Candidate& c : search(rest, wall)) standing.push_back(std::move(c));
    Stopwatch stage;
    standing = stand(scene, std::move(standing));
    wall.verification += stage.lap();
    if (standing.size() == before) break;  // nothing new to look past
  }
  return standing;
}

bool PpfEstimator::enough(const std::vector<Candidate>& standing) const {
  const auto sure = std::count_if(standing.begin(), standing.end(), [&](const Candidate& c) {
    return !c.ambiguous && c.check.score() >= settings_.search.sure;
  });
  return sure >= settings_.search.enough;
}

/// A few hypotheses at a time, best first, until enough poses stand. True when they do.
bool PpfEstimator::refine_in_waves(const Scene& scene, std::size_t part, const std::vector<PoseHypothesis>& poses,
                                   std::vector<Candidate>& standing) const {
  for (std::size_t k = 0; k < poses.size(); k += kWave) {
    const std::size_t end = std::min(poses.size(), k + kWave);
    const std::vector<PoseHypothesis> wave(poses.begin() + static_cast<std::ptrdiff_t>(k),
                                           poses.begin() + static_cast<std::ptrdiff_t>(end));
    const std::size_t before = standing.size();
    for (Candidate& c : refined_poses(scene, parts_[part], wave, settings_)) {
      c.part = part;
      standing.push_back(std::move(c));
    }
    if (standing.size() == before) continue;
    standing = stand(scene, std::move(standing));
    if (enough(standing)) return true;
  }
  return false;
}

std::vector<Candidate> PpfEstimator::first_poses(const Scene& scene, StageTimes& wall) const {
  Stopwatch stage;
  std::vector<ScenePoints> points;
  for (const PreparedPart& part : parts_) points.push_back(scene_points(scene, part, settings_));
  wall.preprocess += stage.lap();
  std::vector<Candidate> standing;
  for (int share = 0; share < kShares; ++share)
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      std::vector<PoseHypothesis> poses = voted_poses(points[i], parts_[i], settings_, {1, share, kShares});
      wall.voting += stage.lap();
      poses = verified_poses(scene, parts_[i], poses, settings_);
      wall.verification += stage.lap();
      const bool done = refine_in_waves(scene, i, poses, standing);
      wall.icp += stage.lap();
      if (done) return standing;
    }
  return standing;
}

/// What speaks for each pose. Only poses that are likelier right than not, themselves, may explain what lies beside and
/// upon another one: who leaned on a doubtful one is asked again.
void PpfEstimator::judge(const Scene& scene, std::vector<Candidate>& standing) const {
  std::vector<char> trusted(standing.size(), 1);
  for (bool changed = true; changed;) {
    changed = false;
    std::vector<std::uint8_t> taken = times_explained(scene, standing, trusted);
    for (std::size_t i = 0; i < standing.size(); ++i) {
      Candidate& c = standing[i];
      const PreparedPart& part = parts_[c.part];
      if (trusted[i]) add_explained(c, -1, taken);
      c.evidence = gather_evidence(scene, part.surface, c.fit.X_CP, taken, settings_.check);
      if (trusted[i]) add_explained(c, 1, taken);
      c.score = calibrated_score(score_features(scene, part.surface, c, part.twists), c.ambiguous);
    }
    for (std::size_t i = 0; i < standing.size(); ++i) {
      const Candidate& c = standing[i];
      const bool doubtful = either(c) < kTrusted || c.evidence.rims.leak_side > settings_.accept.largest_side_leak;
      changed |= trusted[i] && doubtful;
      trusted[i] &= !doubtful;
    }
  }
}

/// Best first: what the view cannot tell from a twin comes last. Without what is less likely than asked for, and
/// without pieces of something larger, whose surface goes on at one side and nobody explains it.
std::vector<Candidate> PpfEstimator::scored(const Scene& scene, std::vector<Candidate> standing) const {
  judge(scene, standing);
  std::erase_if(standing, [&](const Candidate& c) {
    return either(c) < settings_.accept.least_score || c.evidence.rims.leak_side > settings_.accept.largest_side_leak;
  });
  std::stable_sort(standing.begin(), standing.end(), [](const Candidate& a, const Candidate& b) {
    return a.ambiguous != b.ambiguous ? b.ambiguous : a.score > b.score;
  });
  return standing;
}

/// Takes back the poses of parts of which the view shows nothing but doubtful ones. Says so when none is left.
std::string PpfEstimator::take_back(std::vector<Candidate>& poses) const {
  std::vector<double> absent(parts_.size(), 1);  // the probability that none of a part's poses is right
  for (const Candidate& c : poses) absent[c.part] *= 1 - std::min(1.0, either(c));
  const std::size_t before = poses.size();
  std::erase_if(poses, [&](const Candidate& c) { return 1 - absent[c.part] < settings_.accept.least_presence; });
  if (before == 0 || !poses.empty()) return "";
  return "nothing but " + std::to_string(before) +
         " doubtful pose(s): too little to say that a wanted part is there (accept.least_presence)";
}

void PpfEstimator::prepare(std::span<const Part> parts) { prepare_with(parts, DiskCache::from_environment()); }

void PpfEstimator::prepare_with(std::span<const Part> parts, const DiskCache& cache) {
  parts_.clear();
  for (const Part& part : parts) parts_.push_back(prepare_part(part, settings_, cache));
}

EstimateResult PpfEstimator::estimate(const SceneView& view, Seed) const { return estimate_with(view, nullptr); }

EstimateResult PpfEstimator::estimate_with(const SceneView& view, std::vector<ScoreFeatures>* features) const {
  BP_CHECK(!parts_.empty(), "prepare() comes first");
  EstimateResult result;
  Stopwatch total, stage;
  double thinnest = parts_.front().thinnest;
  double largest = 0;
  for (const PreparedPart& p : parts_) {
    thinnest = std::min(thinnest, p.thinnest);
    largest = std::max(largest, p.diameter);
  }
  Scene scene = make_scene(view, settings_.preprocess, settings_.normals, thinnest, largest);
  if (!scene.bin && settings_.preprocess.large_planes) unmark_large_planes(scene, largest);
  result.wall.preprocess = stage.lap();
  std::vector<Candidate> standing =
      settings_.search.enough > 0 ? first_poses(scene, result.wall) : all_poses(scene, result.wall);
  standing = scored(scene, std::move(standing));
  result.message = take_back(standing);
  for (const Candidate& c : standing) {
    result.estimates.push_back(to_estimate(c, parts_[c.part]));
    if (features) features->push_back(score_features(scene, parts_[c.part].surface, c, parts_[c.part].twists));
  }
  result.status = result.estimates.empty() ? EstimateStatus::kNothingFound : EstimateStatus::kFound;
  if (result.estimates.empty() && result.message.empty())
    result.message = why_nothing(scene, parts_, settings_.preprocess.headroom);
  result.wall.total = total.lap();
  return result;
}

}  // namespace binpick

#include "perception/part_refinement.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "core/parallel.hpp"

namespace binpick {
namespace {

constexpr std::size_t kWave = 16;       // poses refined before the next ones are compared with what was accepted
constexpr std::size_t kStretch = 4;     // poses a thread takes at a time
constexpr double kClearlyWorse = 0.85;  // of the coarse score of an accepted pose in the same place
constexpr double kLenient = 0.8;        // of the acceptance limits, for poses that are not fully refined
constexpr double kNested = 0.3;         // share of a pose's surface inside an accepted one

/// body(i) for every i, some at a time: one pose is too little work to hand over to a thread.
void for_each_pose(std::size_t count, int threads, const std::function<void(std::size_t)>& body) {
  parallel_for((count + kStretch - 1) / kStretch, threads, [&](std::size_t stretch) {
    const std::size_t end = std::min(count, (stretch + 1) * kStretch);
    for (std::size_t i = stretch * kStretch; i < end; ++i) body(i);
  });
}

void sort_best_first(std::vector<PoseHypothesis>& poses) {
  std::stable_sort(poses.begin(), poses.end(),
                   [](const PoseHypothesis& a, const PoseHypothesis& b) { return a.votes > b.votes; });
}

/// The best, but not all from the same corner of the heap: so many a region, up to the number that is refined.
std::vector<PoseHypothesis> spread_out(const std::vector<PoseHypothesis>& poses, const PreparedPart& part,
                                       const SearchConfig& search) {
  const double edge = 0.5 * part.diameter;
  std::map<std::array<int, 3>, int> used;
  std::vector<PoseHypothesis> kept;
  for (const PoseHypothesis& pose : poses) {
    const Eigen::Array3d c = (pose.X_CP * part.center_P).array() / edge;
    const std::array<int, 3> region = {static_cast<int>(std::floor(c.x())), static_cast<int>(std::floor(c.y())),
                                       static_cast<int>(std::floor(c.z()))};
    if (++used[region] <= search.regional) kept.push_back(pose);
    if (kept.size() == static_cast<std::size_t>(search.refined)) break;
  }
  return kept;
}

/// Those with a score above `least`; the score is kept as the votes.
std::vector<PoseHypothesis> above(const std::vector<PoseHypothesis>& poses, double least) {
  std::vector<PoseHypothesis> kept;
  std::copy_if(poses.begin(), poses.end(), std::back_inserter(kept),
               [&](const PoseHypothesis& pose) { return pose.votes > least; });
  return kept;
}

/// One pose of each place, best first.
std::vector<PoseHypothesis> distinct_poses(std::vector<PoseHypothesis> poses, const PreparedPart& part,
                                           const PpfSettings& settings) {
  sort_best_first(poses);
  std::vector<PoseHypothesis> distinct;
  for (const PoseHypothesis& pose : poses) {
    const bool known = std::any_of(distinct.begin(), distinct.end(), [&](const PoseHypothesis& d) {
      return same_pose(d.X_CP, pose.X_CP, part.symmetry, same_place(part, settings.search, 0.5));
    });
    if (!known) distinct.push_back(pose);
    if (distinct.size() == static_cast<std::size_t>(settings.search.finished)) break;
  }
  return distinct;
}

/// Coarse ICP, then one pose of each place, best first.
std::vector<PoseHypothesis> coarsely_refined(const Scene& scene, const PreparedPart& part,
                                             const std::vector<PoseHypothesis>& poses, const PpfSettings& settings) {
  std::vector<PoseHypothesis> moved(poses.size());
  for_each_pose(poses.size(), scene.threads, [&](std::size_t i) {
    const IcpResult fit = refine_pose(scene, part.surface, poses[i].X_CP, settings.icp, IcpStage::kCoarse);
    moved[i] = {fit.X_CP, -2};
    if (fit.points < 6 || !fits_bin(scene, part.surface, fit.X_CP, settings.check)) return;
    moved[i].votes = check_rays(scene, part.surface, fit.X_CP, settings.check).score();
  });
  moved = above(moved, settings.search.least_coarse);
  return distinct_poses(std::move(moved), part, settings);
}

/// ICP with the silhouette, and what the drawn part says to it; false when the pose is refused.
bool finish(const Scene& scene, const PreparedPart& part, const Pose& X_CP, const PpfSettings& settings, IcpStage stage,
            Candidate& out) {
  out.fit = refine_pose(scene, part.surface, X_CP, settings.icp, stage);
  const double z = (out.fit.X_CP * part.center_P).z();
  if (out.fit.points < 6 || out.fit.mean_deviation > accepted_deviation(scene, z, settings.icp)) return false;
  if (!fits_bin(scene, part.surface, out.fit.X_CP, settings.check)) return false;
  out.check = check_view(scene, part.surface, out.fit.X_CP, settings.check);
  return accepted(out.check, settings.accept);
}

/// What a pose has to show that is not fully refined yet.
PpfSettings lenient(PpfSettings settings) {
  settings.icp.accept *= 1.5;
  settings.accept.least_quality *= kLenient;
  settings.accept.least_explained *= kLenient;
  settings.accept.least_pixels = static_cast<int>(settings.accept.least_pixels * kLenient);
  settings.accept.largest_leak = 1 - kLenient * (1 - settings.accept.largest_leak);
  return settings;
}

struct Accepted {
  Pose X_CP;
  double coarse_score = 0;
};

/// Does a pose lie inside accepted ones that fit clearly better? Then it need not be finished.
bool outdone(const Scene& scene, const PreparedPart& part, const PoseHypothesis& pose,
             const std::vector<Accepted>& accepted) {
  return std::any_of(accepted.begin(), accepted.end(), [&](const Accepted& a) {
    return pose.votes < kClearlyWorse * a.coarse_score &&
           overlap(part.surface, a.X_CP, part.surface, pose.X_CP, overlap_slack(scene, pose.X_CP)) > kNested;
  });
}

/// Quickly refined poses that pass leniently and are outdone by none.
std::vector<PoseHypothesis> worth_finishing(const Scene& scene, const PreparedPart& part,
                                            const std::vector<PoseHypothesis>& poses, const PpfSettings& settings) {
  const std::vector<PoseHypothesis> coarse = coarsely_refined(scene, part, poses, settings);
  const PpfSettings rough = lenient(settings);
  std::vector<PoseHypothesis> out;
  std::vector<Accepted> standing;
  for (std::size_t next = 0; next < coarse.size();) {
    std::vector<PoseHypothesis> wave;
    for (; next < coarse.size() && wave.size() < kWave; ++next)
      if (!outdone(scene, part, coarse[next], standing)) wave.push_back(coarse[next]);
    std::vector<Candidate> finished(wave.size());
    std::vector<char> good(wave.size(), 0);
    parallel_for(wave.size(), scene.threads, [&](std::size_t i) {
      good[i] = finish(scene, part, wave[i].X_CP, rough, IcpStage::kQuick, finished[i]);
    });
    for (std::size_t i = 0; i < wave.size(); ++i) {
      if (!good[i]) continue;
      if (finished[i].check.quality() >= settings.accept.sure_quality)
        standing.push_back({finished[i].fit.X_CP, wave[i].votes});
      out.push_back({finished[i].fit.X_CP, finished[i].check.score()});
    }
  }
  return distinct_poses(std::move(out), part, settings);
}

}  // namespace

std::vector<PoseHypothesis> verified_poses(const Scene& scene, const PreparedPart& part,
                                           const std::vector<PoseHypothesis>& poses, const PpfSettings& settings) {
  const CheckConfig& check = settings.check;
  std::optional<VoxelSet> voxels;
  if (check.least_voxel_share > 0) voxels.emplace(scene, check.voxel * part.diameter);
  std::vector<PoseHypothesis> judged(poses.size());
  for_each_pose(poses.size(), scene.threads, [&](std::size_t i) {
    judged[i] = {poses[i].X_CP, -2};
    if (voxels && voxel_share(*voxels, part.surface, poses[i].X_CP, check.points) < check.least_voxel_share) return;
    judged[i].votes = check_rays(scene, part.surface, poses[i].X_CP, check, check.rough).score();
  });
  judged = above(judged, -1.9);
  sort_best_first(judged);
  return spread_out(judged, part, settings.search);
}

std::vector<Candidate> refined_poses(const Scene& scene, const PreparedPart& part,
                                     const std::vector<PoseHypothesis>& poses, const PpfSettings& settings) {
  const std::vector<PoseHypothesis> worth = worth_finishing(scene, part, poses, settings);
  std::vector<Candidate> finished(worth.size());
  std::vector<char> good(worth.size(), 0);
  parallel_for(worth.size(), scene.threads, [&](std::size_t i) {
    good[i] = finish(scene, part, worth[i].X_CP, settings, IcpStage::kFine, finished[i]);
  });
  std::vector<Candidate> out;
  for (std::size_t i = 0; i < worth.size(); ++i)
    if (good[i]) out.push_back(std::move(finished[i]));
  return out;
}

}  // namespace binpick

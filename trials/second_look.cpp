#include "trials/second_look.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/hash.hpp"
#include "perception/fuse_frames.hpp"
#include "robot/collision_check.hpp"
#include "trials/arm_run.hpp"

namespace binpick {
namespace {

constexpr double kOwnMargin = 0.010;    // m, what is seen this near to the robot is the robot
constexpr double kSameSurface = 0.003;  // m, and three sigma of both looks: farther apart is another surface
constexpr double kSummit = 0.03;        // m, below the highest point seen: where to look when nothing was found

bool has(const SecondLookConfig& config, const char* occasion) {
  return std::find(config.when.begin(), config.when.end(), occasion) != config.when.end();
}

Eigen::Vector3d middle_W(const Sight& sight, std::size_t estimate, std::span<const Part> parts) {
  const PoseEstimate& e = sight.found.estimates[estimate];
  return sight.seen.X_WC_believed * e.X_CP * parts[e.part].box_center_P;
}

std::string millimetres(double metres) {
  char text[40];
  std::snprintf(text, sizeof text, "%.1f mm", 1e3 * metres);
  return text;
}

std::string why_poor(const SecondLookConfig& config, const Sight& first, const Cell& cell,
                     std::span<const Part> parts) {
  const PickPlan& plan = *first.plan.plan;
  const PoseEstimate& chosen = first.found.estimates[plan.estimate];
  char text[80];
  std::snprintf(text, sizeof text, "poor fit: score %.3f", chosen.score);
  if (chosen.score < config.score) return text;
  const double deviation = lip_deviation(chosen, first.seen.X_WC_believed, plan, parts[chosen.part], *cell.gripper);
  if (deviation > config.deviation) return "poor fit: the lips' place is known to " + millimetres(deviation);
  return "";
}

/// Middle of what was seen within 30 mm below the highest point.
std::optional<Eigen::Vector3d> summit(const ObstacleMap& heap) {
  double top = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& p : heap.points_W()) top = std::max(top, p.z());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (const Eigen::Vector3d& p : heap.points_W())
    if (p.z() > top - kSummit) sum += p, ++count;
  if (count == 0) return std::nullopt;
  return sum / count;
}

/// What the camera saw without the robot itself.
DepthFrame without_robot(const Cell& cell, const DepthFrame& frame, const Vector6d& q) {
  DepthFrame out = frame;
  std::vector<Eigen::Vector3d> points_W;
  std::vector<std::size_t> pixels;
  for (int v = 0; v < frame.depth.height(); ++v)
    for (int u = 0; u < frame.depth.width(); ++u) {
      if (!(frame.depth(u, v) > 0)) continue;
      points_W.push_back(frame.X_WC * frame.camera.unproject(u, v, frame.depth(u, v)));
      pixels.push_back(static_cast<std::size_t>(v) * static_cast<std::size_t>(frame.depth.width()) +
                       static_cast<std::size_t>(u));
    }
  const std::vector<char> own = CollisionCheck(cell, 0).near_robot(points_W, q, kOwnMargin);
  for (std::size_t i = 0; i < own.size(); ++i)
    if (own[i]) out.depth[pixels[i]] = std::numeric_limits<float>::quiet_NaN();
  return out;
}

}  // namespace

std::string why_look_again(const SecondLookConfig& config, const Sight& first, const Cell& cell,
                           std::span<const Part> parts, std::span<const Eigen::Vector3d> failed_W) {
  if (first.found.status == EstimateStatus::kFailed) return "";
  if (first.found.estimates.empty()) return has(config, "no_plan") ? "nothing was found" : "";
  if (!first.plan.plan) return has(config, "no_plan") ? "no candidate survived" : "";
  if (has(config, "failed")) {
    const Part& part = parts[first.found.estimates[first.plan.plan->estimate].part];
    const Eigen::Vector3d middle = middle_W(first, first.plan.plan->estimate, parts);
    for (const Eigen::Vector3d& p_W : failed_W)
      if ((middle - p_W).norm() < part.diameter / 4) return "a pick of it has failed";
  }
  return has(config, "poor_fit") ? why_poor(config, first, cell, parts) : "";
}

std::optional<LookRequest> look_request(const Scenario& s, const Sight& first, std::span<const Part> parts,
                                        const ObstacleMap& heap) {
  LookRequest request;
  request.from = s.second_look.from;
  double largest = 0;
  for (const Part& part : parts) largest = std::max(largest, part.diameter);
  request.distance = std::max(s.second_look.distance, s.sensor->z_min() + largest / 2);  // nearer it sees nothing
  request.tilt = s.second_look.tilt;
  request.clearance = s.planning.clearance;
  if (first.plan.plan) {
    request.aim_W = middle_W(first, first.plan.plan->estimate, parts);
    request.normal_W = -first.plan.plan->X_WG.linear().col(2);
  } else if (!first.plan.rejected.empty()) {
    request.aim_W = middle_W(first, first.plan.rejected.front().estimate, parts);
    request.normal_W = -first.plan.rejected.front().X_WG.linear().col(2);
  } else if (!first.found.estimates.empty()) {
    request.aim_W = middle_W(first, 0, parts);
  } else {
    const std::optional<Eigen::Vector3d> top_W = summit(heap);
    if (!top_W) return std::nullopt;
    request.aim_W = *top_W;
  }
  return request;
}

void add_collisions(const std::map<std::string, int>& collisions, double depth, PickRecord& record) {
  for (const auto& [name, count] : collisions) record.collisions[name] += count;
  record.collision_depth = std::max(record.collision_depth, depth);
}

bool follow_look(const LookRun& run, const JointTrajectory& path, PickRecord& record) {
  run.cell_world.world().freeze_sleeping();
  ArmRun arm(run.cell_world, run.s.execution);
  const bool arrived = arm.follow(path, ArmRun::Watch::kCollisions);
  if (!arrived) arm.retreat(path);
  run.cell_world.world().end_freezing();
  record.look_time += arm.motion_time();
  record.motion_time += arm.motion_time();
  record.sim_time += arm.motion_time();
  add_collisions(arm.collisions(), arm.collision_depth(), record);
  if (!arrived) record.second_look += "; " + arm.blocked()->reason;
  return arrived;
}

namespace {

/// The truth of the first look, with what both looks showed of each part.
void see_more(GroundTruth& truth, const Capture& again) {
  for (GroundTruth::Instance& instance : truth.instances) {
    const Visibility& now = again.visibility[instance.body];
    if (now.fraction() <= instance.visible_fraction) continue;
    instance.visible_fraction = now.fraction();
    instance.visible_pixels = now.visible_pixels;
  }
}

/// The frame of the first look without what the second look has measured again, from nearer: where it saw the same
/// surface, or through to something behind it. What the second look could not see stays.
DepthFrame not_seen_again(const DepthFrame& first, const DepthFrame& again) {
  DepthFrame out = first;
  const Pose X_NC = again.X_WC.inverse() * first.X_WC;  // N: the camera of the second look
  for (int v = 0; v < first.depth.height(); ++v)
    for (int u = 0; u < first.depth.width(); ++u) {
      const double z = first.depth(u, v);
      if (!(z > 0)) continue;
      const Eigen::Vector3d p_N = X_NC * first.camera.unproject(u, v, first.depth(u, v));
      if (!(p_N.z() > 0)) continue;
      const Eigen::Vector2d pixel = again.camera.project(p_N);
      const int a = static_cast<int>(std::lround(pixel.x())), b = static_cast<int>(std::lround(pixel.y()));
      if (!again.depth.contains(a, b) || !(again.depth(a, b) > 0)) continue;
      const double allowed = kSameSurface + 3 * (first.noise.sigma(z) + again.noise.sigma(p_N.z()));
      if (p_N.z() < again.depth(a, b) + allowed) out.depth(u, v) = std::numeric_limits<float>::quiet_NaN();
    }
  return out;
}

/// Both looks as one view in the C of the camera where it stands now, and what the estimator makes of it; or of the
/// second frame alone.
Sight second_sight(const LookRun& run, const Sight& first) {
  const Scenario& s = run.s;
  Sight out;
  out.seen = first.seen;
  out.seen.captures.push_back(capture_again(s, run.cell_world, run.context, run.seed, run.pick));
  const Capture& again = out.seen.captures.back();
  std::vector<DepthFrame> frames = {without_robot(s.cell, again.frame, run.cell_world.joints())};
  for (const Capture& capture : first.seen.captures) frames.push_back(not_seen_again(capture.frame, frames.front()));
  out.seen.frame_hash = Hasher().add(first.seen.frame_hash).add(frame_hash(again.frame)).add(again.frame.X_WC).value();
  out.seen.X_WC_believed = again.frame.X_WC;
  out.seen.truth.X_WC = run.cell_world.cell().camera_pose(run.cell_world.joints());
  see_more(out.seen.truth, again);
  SceneView& view = out.seen.view;
  view.X_CB = stored_pose(again.frame.X_WC.inverse() * s.cell.X_WB);
  view.seen = frames.front();
  view.segmentation = nullptr;  // that of the first look
  const SceneView near = view;
  view.seen = fuse_frames(frames, {}, KnownBin{s.cell.bin, s.cell.X_WB});
  view.cloud_noise = again.frame.noise;
  const Seed seed = run.seed.child("estimator", static_cast<std::uint64_t>(run.pick)).child("second look");
  out.found = estimate_view(s, run.context, s.second_look.fuse ? view : near, out.seen.truth, seed);
  return out;
}

StageTimes sum(const StageTimes& a, const StageTimes& b) {
  return {a.preprocess + b.preprocess, a.voting + b.voting, a.verification + b.verification, a.icp + b.icp,
          a.total + b.total};
}

}  // namespace

bool look_again(const LookRun& run, Sight& sight, PickRecord& record) {
  const Scenario& s = run.s;
  const std::string why = why_look_again(s.second_look, sight, s.cell, run.context.parts, run.failed_W);
  if (why.empty()) return false;
  const ObstacleMap heap = heap_without_robot(s.cell, sight.seen.view, sight.seen.X_WC_believed, s.cell.q_look);
  const std::optional<LookRequest> request = look_request(s, sight, run.context.parts, heap);
  if (!request) return false;
  record.second_look = why;
  const std::optional<LookPlan> plan = plan_look(s.cell, *request, heap);
  if (!plan) {
    record.second_look += "; no free pose to look from";
    return false;
  }
  if (!follow_look(run, plan->there, record)) return false;
  record.look_time += s.trial.exposure;
  record.sim_time += s.trial.exposure;
  Sight again = second_sight(run, sight);
  again.found.wall = sum(sight.found.wall, again.found.wall);
  PickStart start = run.start;
  start.q_now = plan->q;
  plan_sight(run.s, run.context, start, again, record);
  sight = std::move(again);
  return true;
}

void return_home(const LookRun& run, PickRecord& record) {
  const Cell& cell = run.s.cell;
  follow_look(run, joint_move(*cell.arm, run.cell_world.joints(), cell.q_look, cell.motion), record);
}

}  // namespace binpick

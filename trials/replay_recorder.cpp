#include "trials/replay_recorder.hpp"

#include <algorithm>
#include <cmath>

namespace binpick {
namespace {

constexpr double kPeriod = 0.02;         // s between samples
constexpr std::size_t kRejections = 60;  // kept of a look
constexpr double kAroundBin = 0.04;      // m, points that far beside and above the bin are kept

void add_link_geometry(const CellWorld& cell_world, ReplayCell& out) {
  const Cell& cell = cell_world.cell();
  const Arm& arm = *cell.arm;
  out.X_WR = cell.X_WR;
  const std::vector<Pose> zero = arm.link_poses(Vector6d::Zero());
  for (Eigen::Index j = 0; j < 6; ++j) {
    Vector6d q = Vector6d::Zero();
    q[j] = 1;
    const std::vector<Pose> turned = arm.link_poses(q);
    const std::size_t before = static_cast<std::size_t>(j), after = before + 1;
    const Pose X_before = zero[before].inverse() * zero[after];
    const Pose turn = X_before.inverse() * (turned[before].inverse() * turned[after]);
    out.joints.push_back({X_before, log_so3(turn.linear()).normalized()});
  }
  out.X_6F = zero.back().inverse() * arm.forward(Vector6d::Zero());
  out.links.assign(zero.size(), {});
}

const char* name_of_fixed(std::int32_t id) { return id == kIdBin ? "bin" : id == kIdTable ? "table" : "tray"; }

/// The cell as the camera would see it, taken apart into what stands, what the arm moves and what the flange carries.
ReplayCell cell_of(const CellWorld& cell_world) {
  ReplayCell out;
  add_link_geometry(cell_world, out);
  const Cell& cell = cell_world.cell();
  const Pose X_FW = (cell.X_WR * cell.arm->forward(cell_world.joints())).inverse();
  std::vector<std::size_t> links;  // those with a shape, in the order in which the scene has them
  for (std::size_t l = 0; l < cell_world.link_bodies.size(); ++l)
    if (cell_world.link_bodies[l] >= 0) links.push_back(l);
  std::size_t next_link = 0;
  bool tool_seen = false;
  for (const RenderItem& item : cell_world.render_scene().items) {
    if (item.id < kIdBin) continue;  // a part
    if (item.id == kIdArm && next_link < links.size()) {
      out.links[links[next_link++]] = *item.mesh_O;
    } else if (item.id == kIdArm || item.id == kIdTool) {
      const char* name = item.id == kIdArm ? "camera" : tool_seen ? "cup" : "tool";
      tool_seen = tool_seen || item.id == kIdTool;
      out.carried.push_back({name, *item.mesh_O, X_FW * item.X_WO});
    } else {
      out.fixed.push_back({name_of_fixed(item.id), *item.mesh_O, item.X_WO});
    }
  }
  for (const Part& part : cell_world.parts()) {
    out.part_names.push_back(part.name);
    out.part_meshes_P.push_back(part.mesh_P);
  }
  return out;
}

bool near_bin(const Cell& cell, const Eigen::Vector3d& p_W) {
  const Eigen::Vector3d p_B = cell.X_WB.inverse() * p_W, half = cell.bin.inner_size / 2;
  return std::abs(p_B.x()) < half.x() + kAroundBin && std::abs(p_B.y()) < half.y() + kAroundBin &&
         p_B.z() > -kAroundBin && p_B.z() < cell.bin.inner_size.z() + kAroundBin;
}

/// Points of all frames of a look around the bin, `count` of them, drawn without touching any of the trial's streams.
std::vector<Eigen::Vector3f> cloud_of(const Cell& cell, const Sight& sight, std::size_t count, Seed seed) {
  std::vector<Eigen::Vector3f> points;
  for (const Capture& capture : sight.seen.captures) {
    const DepthFrame& frame = capture.frame;
    for (int v = 0; v < frame.depth.height(); ++v)
      for (int u = 0; u < frame.depth.width(); ++u) {
        if (!(frame.depth(u, v) > 0)) continue;
        const Eigen::Vector3d p_W = frame.X_WC * frame.camera.unproject(u, v, frame.depth(u, v));
        if (near_bin(cell, p_W)) points.push_back(p_W.cast<float>());
      }
  }
  seed.rng().shuffle(points);
  if (points.size() > count) points.resize(count);
  return points;
}

}  // namespace

std::unique_ptr<StepWatch> ReplayRecorder::watch(CellWorld& cell_world) {
  return std::make_unique<StepWatch>(cell_world.world(), [this, &cell_world] {
    const bool another = static_cast<std::size_t>(cell_world.world().body_count()) != by_body_.size();  // just released
    if (another || cell_world.world().time() >= next_sample_) sample(cell_world);
  });
}

void ReplayRecorder::sample(const CellWorld& cell_world) {
  const World& world = cell_world.world();
  const double now = world.time();
  next_sample_ = now + kPeriod - 1e-9;
  by_body_.resize(static_cast<std::size_t>(world.body_count()));
  for (BodyId id = 0; id < world.body_count(); ++id) {
    if (world.kind(id) != World::BodyKind::kFree || !world.present(id)) continue;
    PoseTrack& track = by_body_[static_cast<std::size_t>(id)];
    const Pose X_WP = world.pose(id);
    const std::size_t n = track.X.size();
    const bool rests = n > 1 && track.X[n - 1].matrix() == X_WP.matrix() && track.X[n - 2].matrix() == X_WP.matrix();
    if (rests) {
      track.times.back() = now;  // still there
      continue;
    }
    track.times.push_back(now);
    track.X.push_back(X_WP);
  }
  if (!arm_here_) return;
  replay_.arm.times.push_back(now);
  replay_.arm.q.push_back(cell_world.joints());
}

void ReplayRecorder::heap_at_rest(const CellWorld& cell_world) {
  heap_bodies_ = cell_world.heap().bodies;
  replay_.part_of_body = cell_world.heap().parts;
  replay_.cell = cell_of(cell_world);
  arm_here_ = true;
  sample(cell_world);
  event(-1, cell_world, "heap at rest");
}

void ReplayRecorder::look(int pick, const CellWorld& cell_world, const Sight& sight, const PickRecord& record) {
  ReplayLook look;
  look.pick = pick;
  look.time = cell_world.world().time();
  look.X_WC = sight.seen.X_WC_believed;
  look.cloud_W = cloud_of(cell_world.cell(), sight, points_, Seed{sight.seen.frame_hash}.child("replay cloud"));
  const std::vector<GroundTruth::Instance>& instances = sight.seen.truth.instances;
  for (const MatchedEstimate& match : record.check.estimates) {
    const PoseEstimate& e = sight.found.estimates[match.estimate];
    const bool known = match.instance && *match.instance < instances.size();
    look.estimates.push_back({e.part, sight.seen.X_WC_believed * e.X_CP, match,
                              known ? static_cast<int>(instances[*match.instance].body) : -1});
  }
  for (const GroundTruth::Instance& instance : instances)
    look.truth.emplace_back(static_cast<int>(instance.body), instance.visible_fraction);
  look.rejected_count = sight.plan.rejected.size();
  for (std::size_t i = 0; i < std::min(kRejections, look.rejected_count); ++i) {
    const RejectedCandidate& r = sight.plan.rejected[i];
    look.rejected.push_back({r.estimate, r.X_WG.translation(), r.X_WG.linear().col(2), r.reason});
  }
  if (sight.plan.plan) look.chosen = sight.plan.plan->estimate;
  replay_.looks.push_back(std::move(look));
  event(pick, cell_world, record.second_look.empty() ? "look" : "look again: " + record.second_look);
}

void ReplayRecorder::event(int pick, const CellWorld& cell_world, const std::string& what) {
  replay_.events.push_back({pick, cell_world.world().time(), what});
}

Replay ReplayRecorder::finish(const TrialRecord& record) {
  for (const BodyId id : heap_bodies_) {
    const auto k = static_cast<std::size_t>(id);
    replay_.bodies.push_back(k < by_body_.size() ? thinned(by_body_[k]) : PoseTrack{});
  }
  for (const PoseTrack& track : by_body_)
    if (!track.times.empty()) replay_.duration = std::max(replay_.duration, track.times.back());
  replay_.arm = thinned(replay_.arm);
  replay_.record = record;
  return std::move(replay_);
}

}  // namespace binpick

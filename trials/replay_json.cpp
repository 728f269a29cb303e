// A replay as the page reads it. Long lists of numbers are base64 of little-endian integers of 16 bits: positions in
// 0.1 mm, quaternions (x y z w) in 1/32767, joints in 0.2 mrad, times in `tick` seconds.
#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "core/hash.hpp"
#include "evaluation/base64.hpp"
#include "trials/replay.hpp"

namespace binpick {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kPositionStep = 1e-4;  // m
constexpr double kJointStep = 2e-4;     // rad
constexpr double kTick = 0.02;          // s, unless the trial is too long for it
constexpr int kLargest = 32767;

/// Integers of 16 bits, to be written as base64.
class Words {
 public:
  void add(double value) {
    const double bounded = std::isfinite(value) ? std::clamp(value, -double(kLargest), double(kLargest)) : 0;
    add_raw(static_cast<std::uint16_t>(static_cast<std::int16_t>(std::lround(bounded))));
  }
  void add_unsigned(double value) { add_raw(static_cast<std::uint16_t>(std::lround(std::clamp(value, 0.0, 65535.0)))); }
  void add(const Eigen::Vector3d& v, double step) {
    for (Eigen::Index i = 0; i < 3; ++i) add(v[i] / step);
  }
  void add(const Pose& X) {
    add(X.translation(), kPositionStep);
    const Eigen::Quaterniond q(X.linear());
    for (const double c : {q.x(), q.y(), q.z(), q.w()}) add(kLargest * c);
  }
  std::string base64() const { return binpick::base64(bytes_); }

 private:
  void add_raw(std::uint16_t word) {
    bytes_ += static_cast<char>(word & 0xff);
    bytes_ += static_cast<char>(word >> 8);
  }
  std::string bytes_;
};

std::string words_of(const Pose& X) {
  Words words;
  words.add(X);
  return words.base64();
}

/// `step`: 1 / a power of ten, so that the decimals end where they should.
double rounded(double value, double step) {
  const double parts = std::round(1 / step);
  return std::isfinite(value) ? std::round(value * parts) / parts : value;
}

std::string times_of(const std::vector<double>& times, double tick) {
  Words words;
  for (const double t : times) words.add_unsigned(t / tick);
  return words.base64();
}

Json track_json(const PoseTrack& track, double tick) {
  Words poses;
  for (const Pose& X : track.X) poses.add(X);
  return {{"t", times_of(track.times, tick)}, {"x", poses.base64()}};
}

Json arm_json(const JointTrack& track, double tick) {
  Words joints;
  for (const Vector6d& q : track.q)
    for (Eigen::Index j = 0; j < 6; ++j) joints.add(q[j] / kJointStep);
  return {{"t", times_of(track.times, tick)}, {"q", joints.base64()}};
}

Json estimate_json(const ReplayEstimate& e) {
  const PoseError& error = e.match.error;
  return {{"part", e.part},
          {"body", e.body},
          {"x", words_of(e.X_WP)},
          {"score", rounded(e.match.score, 1e-4)},
          {"fit_rms", rounded(e.match.fit_rms, 1e-6)},
          {"right", e.match.right},
          {"ignored", e.match.ignored},
          {"mssd", rounded(error.mssd, 1e-6)},
          {"translation", rounded(error.translation, 1e-6)},
          {"rotation", rounded(error.rotation, 1e-5)},
          {"abs_xyz",
           {rounded(error.abs_xyz.x(), 1e-6), rounded(error.abs_xyz.y(), 1e-6), rounded(error.abs_xyz.z(), 1e-6)}}};
}

/// Reasons once, by name; each rejection points at one.
Json rejections_json(const ReplayLook& look) {
  std::map<std::string, std::size_t> known;
  Json reasons = Json::array(), estimates = Json::array(), why = Json::array();
  Words tips;
  for (const ReplayRejection& r : look.rejected) {
    const auto [entry, fresh] = known.emplace(r.reason, known.size());
    if (fresh) reasons.push_back(r.reason);
    why.push_back(entry->second);
    estimates.push_back(r.estimate);
    tips.add(r.tip_W, kPositionStep);
    tips.add(kLargest * r.axis_W, 1);
  }
  return {{"count", look.rejected_count},
          {"reasons", reasons},
          {"why", why},
          {"estimate", estimates},
          {"tip", tips.base64()}};
}

Json look_json(const ReplayLook& look) {
  Words cloud;
  for (const Eigen::Vector3f& p : look.cloud_W) cloud.add(p.cast<double>(), kPositionStep);
  Json truth = Json::array(), estimates = Json::array();
  for (const auto& [body, visible] : look.truth) truth.push_back({body, rounded(visible, 1e-3)});
  for (const ReplayEstimate& e : look.estimates) estimates.push_back(estimate_json(e));
  Json json = {{"pick", look.pick},
               {"t", rounded(look.time, 1e-3)},
               {"camera", words_of(look.X_WC)},
               {"cloud", cloud.base64()},
               {"estimates", estimates},
               {"rejected", rejections_json(look)},
               {"truth", truth},
               {"chosen", nullptr}};
  if (look.chosen) json["chosen"] = *look.chosen;
  return json;
}

Json pick_json(const PickRecord& pick) {
  return {{"outcome", to_string(pick.outcome)},
          {"reason", pick.reason},
          {"visible", pick.check.visible},
          {"found", pick.check.found},
          {"cycle", rounded(pick.sim_time, 1e-3)}};
}

/// Vertices that triangles use, renumbered.
TriangleMesh compacted(const std::vector<float>& positions, const std::vector<unsigned>& indices) {
  TriangleMesh out;
  std::map<unsigned, std::uint32_t> renumbered;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      const unsigned v = indices[i + k];
      const auto [entry, fresh] = renumbered.emplace(v, static_cast<std::uint32_t>(out.vertices.size()));
      if (fresh) out.vertices.emplace_back(positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]);
      triangle[k] = entry->second;
    }
    out.triangles.push_back(triangle);
  }
  return out;
}

/// At most so many triangles: along edges while the form allows it, else as near as clusters of vertices come.
TriangleMesh simplified(const TriangleMesh& mesh, std::size_t triangles) {
  if (mesh.triangles.size() <= triangles) return mesh;
  std::vector<float> positions;
  for (const Eigen::Vector3d& v : mesh.vertices)
    for (Eigen::Index i = 0; i < 3; ++i) positions.push_back(static_cast<float>(v[i]));
  std::vector<unsigned> indices;
  for (const auto& t : mesh.triangles) indices.insert(indices.end(), t.begin(), t.end());
  std::vector<unsigned> fewer(indices.size());
  const std::size_t vertices = mesh.vertices.size(), stride = 3 * sizeof(float);
  std::size_t count = meshopt_simplify(fewer.data(), indices.data(), indices.size(), positions.data(), vertices, stride,
                                       3 * triangles, 0.02f, 0, nullptr);
  if (count > 3 * triangles)
    count = meshopt_simplifySloppy(fewer.data(), indices.data(), indices.size(), positions.data(), vertices, stride,
                                   3 * triangles, 1.0f, nullptr);
  fewer.resize(count);
  return compacted(positions, fewer);
}

Json mesh_json(const TriangleMesh& whole, std::size_t triangles) {
  const TriangleMesh mesh = simplified(whole, triangles);
  double reach = 1e-6;
  for (const Eigen::Vector3d& v : mesh.vertices) reach = std::max(reach, v.cwiseAbs().maxCoeff());
  const double step = reach / kLargest;
  Words vertices, indices;
  for (const Eigen::Vector3d& v : mesh.vertices) vertices.add(v, step);
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t i : triangle) indices.add_unsigned(i);
  return {{"step", step}, {"v", vertices.base64()}, {"i", indices.base64()}};
}

Json items_json(const std::vector<ReplayCell::Item>& items, std::size_t triangles) {
  Json list = Json::array();
  for (const ReplayCell::Item& item : items)
    list.push_back({{"name", item.name}, {"x", words_of(item.X)}, {"mesh", mesh_json(item.mesh, triangles)}});
  return list;
}

std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

}  // namespace

std::string replay_cell_json(const ReplayCell& cell, std::size_t triangles) {
  Json joints = Json::array(), links = Json::array(), parts = Json::array();
  for (const ReplayCell::Joint& joint : cell.joints)
    joints.push_back({{"x", words_of(joint.X_before)}, {"axis", {joint.axis.x(), joint.axis.y(), joint.axis.z()}}});
  for (const TriangleMesh& link : cell.links) links.push_back(mesh_json(link, triangles));
  for (std::size_t p = 0; p < cell.part_names.size(); ++p)
    parts.push_back({{"name", cell.part_names[p]}, {"mesh", mesh_json(cell.part_meshes_P[p], triangles)}});
  return text_of({{"schema", kReplaySchema},
                  {"fixed", items_json(cell.fixed, triangles)},
                  {"carried", items_json(cell.carried, triangles)},
                  {"links", links},
                  {"joints", joints},
                  {"base", words_of(cell.X_WR)},
                  {"flange", words_of(cell.X_6F)},
                  {"parts", parts}});
}

std::string replay_json(const Replay& replay) {
  const double tick = std::max(kTick, replay.duration / 65000);
  Json bodies = Json::array(), looks = Json::array(), events = Json::array(), picks = Json::array();
  for (const PoseTrack& track : replay.bodies) bodies.push_back(track_json(track, tick));
  for (const ReplayLook& look : replay.looks) looks.push_back(look_json(look));
  for (const ReplayEvent& e : replay.events)
    events.push_back({{"pick", e.pick}, {"t", rounded(e.time, 1e-3)}, {"what", e.what}});
  for (const PickRecord& pick : replay.record.picks) picks.push_back(pick_json(pick));
  return text_of({{"schema", kReplaySchema},
                  {"scenario", replay.record.scenario},
                  {"scenario_hash", replay.record.scenario_hash},
                  {"seed", std::to_string(replay.record.seed.key)},
                  {"record_hash", hex(record_hash(replay.record))},
                  {"tick", tick},
                  {"duration", rounded(replay.duration, 1e-3)},
                  {"dropped", replay.record.dropped},
                  {"placed", replay.record.placed},
                  {"part_of_body", replay.part_of_body},
                  {"bodies", bodies},
                  {"arm", arm_json(replay.arm, tick)},
                  {"looks", looks},
                  {"picks", picks},
                  {"events", events}});
}

}  // namespace binpick

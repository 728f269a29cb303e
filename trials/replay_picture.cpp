#include "trials/replay_picture.hpp"

#include <algorithm>

namespace binpick {
namespace {

constexpr Material kMetal{0.6, 0, 0.3}, kDark{0.25, 0, 0.3}, kGrey{0.4, 0, 0.3};

std::shared_ptr<const TriangleMesh> shared(const TriangleMesh& mesh) {
  return std::make_shared<const TriangleMesh>(mesh);
}

std::int32_t id_of(const std::string& name) {
  if (name == "bin") return kIdBin;
  if (name == "table") return kIdTable;
  if (name == "tray") return kIdTray;
  return name == "camera" ? kIdArm : kIdTool;
}

/// Corners of an item's box in W: low, high.
std::pair<Eigen::Vector3d, Eigen::Vector3d> box_of(const ReplayCell& cell, const std::string& name) {
  const double far = std::numeric_limits<double>::infinity();
  Eigen::Vector3d low(far, far, far), high = -low;
  for (const ReplayCell::Item& item : cell.fixed) {
    if (item.name != name) continue;
    for (const Eigen::Vector3d& v : item.mesh.vertices) {
      low = low.cwiseMin(item.X * v);
      high = high.cwiseMax(item.X * v);
    }
  }
  return {low, high};
}

const ReplayLook* look_of(const Replay& replay, int pick) {
  for (const ReplayLook& look : replay.looks)
    if (look.pick == pick) return &look;
  return nullptr;
}

int first_failed(const Replay& replay) {
  const std::vector<PickRecord>& picks = replay.record.picks;
  const auto failed = std::find_if(picks.begin(), picks.end(), [](const PickRecord& pick) {
    return pick.outcome != PickOutcome::kSucceeded && pick.outcome != PickOutcome::kBinEmpty;
  });
  return failed == picks.end() ? 0 : static_cast<int>(failed - picks.begin());
}

}  // namespace

ReplayPicture::ReplayPicture(const Replay& replay, DepthRenderer& renderer) : replay_(replay), renderer_(renderer) {
  for (const ReplayCell::Item& item : replay.cell.fixed) fixed_.push_back(shared(item.mesh));
  for (const ReplayCell::Item& item : replay.cell.carried) carried_.push_back(shared(item.mesh));
  for (const TriangleMesh& link : replay.cell.links) links_.push_back(shared(link));
  for (const TriangleMesh& part : replay.cell.part_meshes_P) parts_.push_back(shared(part));
}

RenderScene ReplayPicture::scene(double time) const {
  RenderScene scene;
  for (std::size_t i = 0; i < replay_.bodies.size(); ++i)
    if (const auto X_WP = pose_at(replay_.bodies[i], time))
      scene.items.push_back({parts_[replay_.part_of_body[i]], *X_WP, static_cast<std::int32_t>(i), kMetal});
  const ReplayCell& cell = replay_.cell;
  for (std::size_t i = 0; i < fixed_.size(); ++i)
    scene.items.push_back({fixed_[i], cell.fixed[i].X, id_of(cell.fixed[i].name), kGrey});
  const auto q = joints_at(replay_.arm, time);
  if (!q) return scene;
  Pose X_WL = cell.X_WR;
  for (std::size_t l = 0; l < links_.size(); ++l) {
    if (l > 0) {
      const ReplayCell::Joint& joint = cell.joints[l - 1];
      X_WL = X_WL * joint.X_before * Eigen::AngleAxisd((*q)[static_cast<Eigen::Index>(l - 1)], joint.axis);
    }
    if (!links_[l]->empty()) scene.items.push_back({links_[l], X_WL, kIdArm, kMetal});
  }
  for (std::size_t i = 0; i < carried_.size(); ++i)
    if (!carried_[i]->empty())
      scene.items.push_back({carried_[i], X_WL * cell.X_6F * cell.carried[i].X, id_of(cell.carried[i].name), kDark});
  return scene;
}

Pose ReplayPicture::eye() const {
  const auto [low, high] = box_of(replay_.cell, "bin");
  const auto [tray_low, tray_high] = box_of(replay_.cell, "tray");
  const Eigen::Vector3d middle = (low + high) / 2, tray = (tray_low + tray_high) / 2;
  Eigen::Vector3d out = middle - replay_.cell.X_WR.translation();
  out.z() = 0;
  out = out.norm() > 1e-3 ? Eigen::Vector3d(out.normalized()) : Eigen::Vector3d::UnitX();
  Eigen::Vector3d aside(-out.y(), out.x(), 0);
  if (aside.dot(tray - middle) > 0) aside = -aside;
  const double away = 2.45 * (high - low).maxCoeff();
  Eigen::Vector3d target = middle + 0.25 * (tray - middle);
  target.z() = middle.z() + 0.04 * away;
  const Eigen::Vector3d eye = target + away * (0.8 * out + 0.25 * aside + Eigen::Vector3d(0, 0, 0.95));
  const Eigen::Vector3d z = (target - eye).normalized(), x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Matrix3d R;
  R << x, z.cross(x), z;
  return pose_from(R, eye);
}

Image<Rgb> ReplayPicture::at(double time, int width, int height) const {
  const double focal = 1.3 * height;  // 42 degrees from top to bottom
  const PinholeCamera camera{width, height, focal, focal, (width - 1) / 2.0, (height - 1) / 2.0};
  return renderer_.picture(scene(time), camera, eye());
}

double telling_time(const Replay& replay, int pick) {
  if (pick < 0) pick = first_failed(replay);
  for (const char* what : {"lifted", "held"})
    for (const ReplayEvent& event : replay.events)
      if (event.pick == pick && event.what == what) return event.time;
  const ReplayLook* look = look_of(replay, pick);
  return look ? look->time : replay.duration;
}

std::pair<double, double> span_of(const Replay& replay, int pick) {
  if (pick < 0) pick = first_failed(replay);
  const ReplayLook* look = look_of(replay, pick);
  if (!look) return {0, replay.duration};
  const ReplayLook* next = look_of(replay, pick + 1);
  return {look->time, next ? next->time : replay.duration};
}

}  // namespace binpick

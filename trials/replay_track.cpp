// Tracks of a replay: sampled, and thinned to what straight lines between the samples cannot say.
#include <algorithm>
#include <cmath>

#include "trials/replay.hpp"

namespace binpick {
namespace {

constexpr double kPosition = 0.5e-3;  // m
constexpr double kAngle = 0.01;       // rad
constexpr double kJoint = 0.002;      // rad

/// The samples to keep: both ends, and wherever the line between two kept ones is farther off than 1, the worst between
/// them (Ramer 1972, Douglas and Peucker 1973). `off(a, b, k)`: how far sample k is off the line from a to b.
template <class Off>
std::vector<std::size_t> kept_samples(std::size_t count, const Off& off) {
  std::vector<char> keep(count, 0);
  if (count > 0) keep.front() = keep.back() = 1;
  std::vector<std::pair<std::size_t, std::size_t>> spans;
  if (count > 2) spans.emplace_back(0, count - 1);
  while (!spans.empty()) {
    const auto [a, b] = spans.back();
    spans.pop_back();
    double worst = 1;
    std::size_t at = 0;
    for (std::size_t k = a + 1; k < b; ++k)
      if (const double distance = off(a, b, k); distance > worst) worst = distance, at = k;
    if (at == 0) continue;
    keep[at] = 1;
    spans.emplace_back(a, at);
    spans.emplace_back(at, b);
  }
  std::vector<std::size_t> kept;
  for (std::size_t k = 0; k < count; ++k)
    if (keep[k]) kept.push_back(k);
  return kept;
}

Pose between(const Pose& a, const Pose& b, double share) {
  const Eigen::Quaterniond turn = Eigen::Quaterniond(a.linear()).slerp(share, Eigen::Quaterniond(b.linear()));
  return pose_from(turn.toRotationMatrix(), a.translation() + share * (b.translation() - a.translation()));
}

double share_of(double from, double to, double t) {
  return to > from ? std::clamp((t - from) / (to - from), 0., 1.) : 0;
}

/// Index of the last time <= t, which must not lie before the first.
std::size_t segment(const std::vector<double>& times, double t) {
  return static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), t) - times.begin()) - 1;
}

}  // namespace

std::optional<Pose> pose_at(const PoseTrack& track, double time) {
  if (track.times.empty() || time < track.times.front()) return std::nullopt;
  const std::size_t k = segment(track.times, time);
  if (k + 1 >= track.times.size()) return track.X.back();
  return between(track.X[k], track.X[k + 1], share_of(track.times[k], track.times[k + 1], time));
}

std::optional<Vector6d> joints_at(const JointTrack& track, double time) {
  if (track.times.empty() || time < track.times.front()) return std::nullopt;
  const std::size_t k = segment(track.times, time);
  if (k + 1 >= track.times.size()) return track.q.back();
  const double share = share_of(track.times[k], track.times[k + 1], time);
  return Vector6d(track.q[k] + share * (track.q[k + 1] - track.q[k]));
}

PoseTrack thinned(const PoseTrack& track) {
  const auto off = [&](std::size_t a, std::size_t b, std::size_t k) {
    const Pose X = between(track.X[a], track.X[b], share_of(track.times[a], track.times[b], track.times[k]));
    return std::max(distance_between(X, track.X[k]) / kPosition,
                    angle_between(X.linear(), track.X[k].linear()) / kAngle);
  };
  PoseTrack out;
  for (const std::size_t k : kept_samples(track.times.size(), off)) {
    out.times.push_back(track.times[k]);
    out.X.push_back(track.X[k]);
  }
  return out;
}

JointTrack thinned(const JointTrack& track) {
  const auto off = [&](std::size_t a, std::size_t b, std::size_t k) {
    const double share = share_of(track.times[a], track.times[b], track.times[k]);
    const Vector6d q = track.q[a] + share * (track.q[b] - track.q[a]);
    return (q - track.q[k]).cwiseAbs().maxCoeff() / kJoint;
  };
  JointTrack out;
  for (const std::size_t k : kept_samples(track.times.size(), off)) {
    out.times.push_back(track.times[k]);
    out.q.push_back(track.q[k]);
  }
  return out;
}

}  // namespace binpick

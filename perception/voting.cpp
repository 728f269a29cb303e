#include "perception/voting.hpp"

#include <algorithm>
#include <numbers>

#include "core/check.hpp"
#include "core/error.hpp"
#include "perception/neighbours.hpp"

namespace binpick {
namespace {

constexpr int kAngles = 32;  // 11.25 degrees, a power of two so that turns / 65536 wrap around by themselves
constexpr int kShift = 11;   // 65536 / 32 = 2^11

struct Peak {
  int cell;
  int votes;
};

/// The accumulator (model reference, alpha) of one scene reference.
class Accumulator {
 public:
  explicit Accumulator(std::size_t references) : votes_(references * kAngles, 0) {}

  void clear() { std::fill(votes_.begin(), votes_.end(), std::uint32_t{0}); }

  void add(std::span<const PairEntry> entries, std::uint16_t scene_alpha) {
    const auto turned = static_cast<std::uint16_t>(scene_alpha + (1 << (kShift - 1)));
    for (const PairEntry e : entries)
      ++votes_[e.reference * kAngles + (static_cast<std::uint16_t>(turned - e.alpha) >> kShift)];
  }

  /// The best cells, none beside a better one of the same model reference; ties go to the lower cell.
  std::vector<Peak> peaks(const VotingConfig& config) const {
    std::vector<Peak> found;
    const auto best = static_cast<int>(*std::max_element(votes_.begin(), votes_.end()));
    if (best < 3) return found;
    const auto least = static_cast<std::uint32_t>(std::max(3, static_cast<int>(config.peak_ratio * best)));
    for (std::size_t c = 0; c < votes_.size(); ++c)
      if (votes_[c] >= least && is_peak(c)) found.push_back({static_cast<int>(c), static_cast<int>(votes_[c])});
    std::stable_sort(found.begin(), found.end(), [](const Peak& a, const Peak& b) { return a.votes > b.votes; });
    if (found.size() > static_cast<std::size_t>(config.peaks)) found.resize(static_cast<std::size_t>(config.peaks));
    return found;
  }

 private:
  bool is_peak(std::size_t c) const {
    const std::size_t row = c - c % kAngles;
    const std::size_t left = row + (c + kAngles - 1) % kAngles, right = row + (c + 1) % kAngles;
    return votes_[c] >= votes_[right] && votes_[c] > votes_[left];
  }
  std::vector<std::uint32_t> votes_;
};

}  // namespace

void VotingConfig::visit(ConfigVisitor& v) {
  v.field("distance_step", distance_step, Unit::kLength, "step of the pair's length (paper: 5 mm); 0: relative_step");
  v.field("relative_step", relative_step, Unit::kNone, "step of the pair's length, of the part's diameter");
  v.field("angle_step", angle_step, Unit::kAngle, "step of the pair's angles (paper: 12 deg)");
  v.field("reference_step", reference_step, "every n-th scene point is a reference");
  v.field("pair_radius", pair_radius, Unit::kNone, "longest pair that votes, of the diameter");
  v.field("largest_cell", largest_cell, "table cells with more entries are skipped");
  v.field("peaks", peaks, "poses that one reference may give");
  v.field("peak_ratio", peak_ratio, Unit::kNone, "least votes of the further ones, of the best");
}

void VotingConfig::validate() const {
  if (!(distance_step == 0 || (distance_step >= 1e-4 && distance_step < 0.5)))
    throw SpecError("voting.distance_step: must be 0 or lie between 0.1 and 500 mm");
  if (!(relative_step >= 0.01 && relative_step <= 0.5))
    throw SpecError("voting.relative_step: must lie between 0.01 and 0.5");
  if (!(angle_step >= 0.05 && angle_step <= 1.6)) throw SpecError("voting.angle_step: must lie between 3 and 90 deg");
  if (reference_step < 1) throw SpecError("voting.reference_step: must be at least 1");
  if (!(pair_radius > 0.05 && pair_radius <= 1)) throw SpecError("voting.pair_radius: must lie between 0.05 and 1");
  if (largest_cell < 1 || peaks < 1) throw SpecError("voting.largest_cell, peaks: must be at least 1");
  if (!(peak_ratio > 0 && peak_ratio <= 1)) throw SpecError("voting.peak_ratio: must lie between 0 and 1");
}

PairQuantiser VotingConfig::quantiser(double diameter) const {
  const double step = distance_step > 0 ? distance_step : relative_step * diameter;
  return {std::min(1.0, pair_radius) * diameter, step, angle_step};
}

Pose pose_from_vote(const OrientedPoint& scene_C, const OrientedPoint& model_P, double alpha) {
  const Eigen::Matrix3d to_scene = frame_with_x(scene_C.normal).transpose().cast<double>();
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(alpha, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const Eigen::Matrix3d R_CP = to_scene * turn * frame_with_x(model_P.normal).cast<double>();
  const Pose X_CP = pose_from(R_CP, scene_C.point.cast<double>() - R_CP * model_P.point.cast<double>());
  return orthonormalised(X_CP);
}

std::vector<PoseHypothesis> vote(const PointCloud& scene_C, const PairTable& table, double diameter,
                                 const VotingConfig& config) {
  BP_CHECK(scene_C.points.empty() || scene_C.has_normals());
  std::vector<PoseHypothesis> found;
  if (scene_C.points.empty() || table.references().empty()) return found;
  std::vector<Eigen::Vector3f> positions;
  for (const Eigen::Vector3d& p : scene_C.points) positions.push_back(p.cast<float>());
  const auto oriented = [&](std::size_t i) { return OrientedPoint{positions[i], scene_C.normals[i].cast<float>()}; };
  const auto radius = static_cast<float>(config.pair_radius * diameter);
  const PointGrid grid(positions, radius / 3);
  Accumulator accumulator(table.references().size());
  for (std::size_t i = 0; i < positions.size(); i += static_cast<std::size_t>(config.reference_step)) {
    accumulator.clear();
    const OrientedPoint reference = oriented(i);
    const Eigen::Matrix3f R = frame_with_x(reference.normal);
    grid.within(reference.point, radius, [&](std::uint32_t j) {
      if (j == i) return;
      const int cell = table.quantiser().cell(pair_feature(reference, oriented(j)));
      if (cell < 0) return;
      const auto entries = table.entries(cell);
      if (entries.empty() || entries.size() > static_cast<std::size_t>(config.largest_cell)) return;
      accumulator.add(entries, alpha_turns(R, positions[j] - reference.point));
    });
    for (const Peak& peak : accumulator.peaks(config)) {
      const double alpha = (peak.cell % kAngles) * (2 * std::numbers::pi / kAngles);
      const OrientedPoint& model = table.references()[static_cast<std::size_t>(peak.cell / kAngles)];
      found.push_back({pose_from_vote(reference, model, alpha), static_cast<double>(peak.votes)});
    }
  }
  return found;
}

}  // namespace binpick

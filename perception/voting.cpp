#include "perception/voting.hpp"

#include <algorithm>
#include <numbers>

#include "core/check.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "perception/point_columns.hpp"
#include "perception/vote_kernel.hpp"

namespace binpick {
namespace {

constexpr std::size_t kChunk = 64;  // scene references that share their buffers

/// A row (model reference) and column (alpha) of the accumulator.
struct Peak {
  std::size_t row;
  int column;
  int votes;
};

/// The best cells of an accumulator, none beside a better one of the same model reference; ties go to the lower cell.
template <class Votes>
std::vector<Peak> peaks_of(const std::vector<Votes>& votes, std::vector<Votes>& maxima, const VotingConfig& config) {
  std::vector<Peak> found;
  const auto best = static_cast<int>(row_maxima(votes.data(), maxima.size(), maxima.data()));
  if (best < 3) return found;
  const auto least = static_cast<Votes>(std::max(3, static_cast<int>(config.peak_ratio * best)));
  for (std::size_t r = 0; r < maxima.size(); ++r) {
    if (maxima[r] < least) continue;
    const Votes* row = votes.data() + r * kAngles;
    for (int c = 0; c < kAngles; ++c)
      if (row[c] >= least && row[c] >= row[(c + 1) % kAngles] && row[c] > row[(c + kAngles - 1) % kAngles])
        found.push_back({r, c, static_cast<int>(row[c])});
  }
  std::stable_sort(found.begin(), found.end(), [](const Peak& a, const Peak& b) { return a.votes > b.votes; });
  if (found.size() > static_cast<std::size_t>(config.peaks)) found.resize(static_cast<std::size_t>(config.peaks));
  return found;
}

/// Entries up to which a cell's votes count in full (symmetric parts have few counters and crowded cells).
std::uint32_t full_cell(const PairTable& table, const VotingConfig& config) {
  const double counters = static_cast<double>(table.references().size()) * kAngles;
  return static_cast<std::uint32_t>(std::max(1.0, config.full_cell * counters));
}

/// Votes of one scene reference after another; owns what that takes.
class Voter {
 public:
  Voter(const PointColumns& scene, const PairTable& table, double radius, const VotingConfig& config)
      : scene_(scene),
        table_(table),
        config_(config),
        radius_(static_cast<float>(radius)),
        limits_{table.quantiser().steps(), radius_ * radius_},
        view_{table.first().data(), table.all_entries().data(), static_cast<std::uint32_t>(config.largest_cell),
              full_cell(table, config)},
        partners_(scene.size() + 8),
        cell_(scene.size() + 8),
        alpha_(scene.size() + 8) {}

  /// `turn` only decides which points stay where a dense neighbourhood is thinned.
  std::vector<Peak> peaks(const OrientedPoint& reference, std::size_t turn) {
    std::size_t count = scene_.gather(reference.point, radius_, partners_);
    const auto most = static_cast<std::size_t>(config_.partners);
    if (most > 0 && count > most) count = partners_.thin(count, (count + most / 2) / most, turn);
    pair_cells(pair_reference(reference), partners_.view(), static_cast<int>(count), limits_, cell_.data(),
               alpha_.data());
    const int pairs = compact_pairs(cell_.data(), alpha_.data(), static_cast<int>(count));
    const bool fits = static_cast<std::uint64_t>(pairs) * table_.most_of_one() <= 65535;
    return fits ? counted(pairs, narrow_, narrow_maxima_) : counted(pairs, wide_, wide_maxima_);
  }

 private:
  template <class Votes>
  std::vector<Peak> counted(int pairs, std::vector<Votes>& votes, std::vector<Votes>& maxima) {
    votes.assign(table_.references().size() * kAngles, Votes{0});
    maxima.resize(table_.references().size());
    cast_votes(view_, {cell_.data(), alpha_.data(), pairs}, votes.data());
    return peaks_of(votes, maxima, config_);
  }

  const PointColumns& scene_;
  const PairTable& table_;
  const VotingConfig& config_;
  float radius_;
  PairLimits limits_;
  TableView view_;
  OrientedColumns partners_;
  std::vector<int> cell_, alpha_;
  std::vector<std::uint16_t> narrow_, narrow_maxima_;
  std::vector<std::uint32_t> wide_, wide_maxima_;
};

}  // namespace

void VotingConfig::visit(ConfigVisitor& v) {
  v.field("distance_step", distance_step, Unit::kLength, "step of the pair's length (paper: 5 mm); 0: relative_step");
  v.field("relative_step", relative_step, Unit::kNone, "step of the pair's length, of the part's diameter");
  v.field("angle_step", angle_step, Unit::kAngle, "step of the pair's angles (paper: 12 deg)");
  v.field("reference_step", reference_step, "every n-th scene point is a reference");
  v.field("pair_radius", pair_radius, Unit::kNone, "longest pair that votes, of the diameter");
  v.field("partners", partners, "about so many of the points around a reference make pairs with it; 0: all");
  v.field("largest_cell", largest_cell, "table cells with more entries are skipped");
  v.field("full_cell", full_cell, Unit::kNone,
          "cells that vote for a larger share of all counters are thinned to it; 1: none are");
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
  if (!(full_cell > 0 && full_cell <= 1)) throw SpecError("voting.full_cell: must lie between 0 and 1");
  if (partners != 0 && partners < 20) throw SpecError("voting.partners: must be 0 or at least 20");
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
                                 const VotingConfig& config, VoteRun run) {
  BP_CHECK(scene_C.points.empty() || scene_C.has_normals());
  std::vector<PoseHypothesis> found;
  if (scene_C.points.empty() || table.references().empty()) return found;
  std::vector<OrientedPoint> points;
  points.reserve(scene_C.size());
  for (std::size_t i = 0; i < scene_C.size(); ++i)
    points.push_back({scene_C.points[i].cast<float>(), scene_C.normals[i].cast<float>()});
  const double radius = config.pair_radius * diameter;
  const PointColumns columns(points, static_cast<float>(radius / 4));
  const auto step = static_cast<std::size_t>(config.reference_step);
  const auto first = static_cast<std::size_t>(run.first), of = static_cast<std::size_t>(run.of);
  const std::size_t all = (points.size() + step - 1) / step, references = all > first ? (all - first - 1) / of + 1 : 0;
  std::vector<std::vector<PoseHypothesis>> parts((references + kChunk - 1) / kChunk);
  parallel_for(parts.size(), run.threads, [&](std::size_t part) {
    Voter voter(columns, table, radius, config);
    for (std::size_t i = part * kChunk; i < std::min(references, (part + 1) * kChunk); ++i) {
      const OrientedPoint& reference = points[(first + i * of) * step];
      for (const Peak& peak : voter.peaks(reference, i))
        parts[part].push_back(
            {pose_from_vote(reference, table.references()[peak.row], peak.column * (2 * std::numbers::pi / kAngles)),
             static_cast<double>(peak.votes)});
    }
  });
  for (const auto& part : parts) found.insert(found.end(), part.begin(), part.end());
  return found;
}

}  // namespace binpick

#include "perception/pair_table.hpp"

#include <algorithm>
#include <limits>

#include "core/check.hpp"
#include "core/error.hpp"
#include "perception/point_columns.hpp"

namespace binpick {
namespace {

constexpr int kTurns = 120;           // samples of a continuous axis: 3 degrees
constexpr float kSameNormal = 0.92f;  // cosine, 23 degrees

std::vector<OrientedPoint> oriented(const PointCloud& cloud) {
  std::vector<OrientedPoint> out(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i)
    out[i] = {cloud.points[i].cast<float>(), cloud.normals[i].cast<float>()};
  return out;
}

/// Indices of points of which no two are carried into each other by the group.
std::vector<std::size_t> reduced(const std::vector<OrientedPoint>& points, const Symmetry& symmetry, double same) {
  std::vector<std::size_t> kept;
  if (symmetry.trivial()) {
    for (std::size_t i = 0; i < points.size(); ++i) kept.push_back(i);
    return kept;
  }
  std::vector<Eigen::Isometry3f> group;
  for (const Pose& S : sampled_group(symmetry, kTurns)) group.push_back(S.cast<float>());
  const float limit = static_cast<float>(same * same);
  const auto known = [&](const OrientedPoint& p) {
    for (const Eigen::Isometry3f& S : group) {
      const Eigen::Vector3f point = S * p.point, normal = S.linear() * p.normal;
      for (const std::size_t k : kept)
        if ((points[k].point - point).squaredNorm() < limit && points[k].normal.dot(normal) > kSameNormal) return true;
    }
    return false;
  };
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!known(points[i])) kept.push_back(i);
  return kept;
}

struct PlacedEntry {
  std::int32_t cell;
  PairEntry entry;
};

}  // namespace

PairTable::PairTable(const PointCloud& model_P, const Symmetry& symmetry, const PairQuantiser& quantiser, double same,
                     std::span<const std::uint64_t> views)
    : quantiser_(quantiser) {
  BP_CHECK(model_P.has_normals());
  BP_CHECK(views.empty() || views.size() == model_P.size());
  const std::vector<OrientedPoint> points = oriented(model_P);
  const std::vector<std::size_t> kept = reduced(points, symmetry, same);
  if (kept.size() > 65535)
    throw SpecError("paper_ppf: the model has " + std::to_string(kept.size()) +
                    " points; at most 65535 fit. Enlarge preprocess.voxel.");
  std::vector<PlacedEntry> placed;
  placed.reserve(kept.size() * points.size());
  first_.assign(static_cast<std::size_t>(quantiser.cells()) + 1, 0);
  const OrientedColumns columns(points);
  const PairLimits limits{quantiser.steps(), std::numeric_limits<float>::max()};
  std::vector<int> cell(points.size()), alpha(points.size());
  for (std::size_t r = 0; r < kept.size(); ++r) {
    references_.push_back(points[kept[r]]);
    pair_cells(pair_reference(references_.back()), columns.view(), static_cast<int>(points.size()), limits, cell.data(),
               alpha.data());
    for (std::size_t j = 0; j < points.size(); ++j) {
      if (cell[j] < 0 || (!views.empty() && (views[kept[r]] & views[j]) == 0)) continue;
      placed.push_back({cell[j], {static_cast<std::uint16_t>(alpha[j]), static_cast<std::uint16_t>(r)}});
      ++first_[static_cast<std::size_t>(cell[j]) + 1];
    }
  }
  for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
  entries_.resize(placed.size());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (const PlacedEntry& p : placed) entries_[next[static_cast<std::size_t>(p.cell)]++] = p.entry;
  count_repeats();
}

void PairTable::write(ByteWriter& out) const {
  out.add(static_cast<std::uint64_t>(references_.size()));
  for (const OrientedPoint& r : references_) out.add(r.point).add(r.normal);
  out.add(first_).add(entries_);
}

PairTable::PairTable(ByteReader& in, const PairQuantiser& quantiser) : quantiser_(quantiser) {
  references_.resize(static_cast<std::size_t>(in.length(6 * sizeof(float))));
  for (OrientedPoint& r : references_) in.get(r.point).get(r.normal);
  in.get(first_).get(entries_);
  if (!in.ok() || !consistent()) {
    in.fail();
    *this = PairTable();
  }
  count_repeats();
}

/// Every look-up ends inside the table.
bool PairTable::consistent() const {
  const bool cells = first_.size() == static_cast<std::size_t>(quantiser_.cells()) + 1 && first_.front() == 0 &&
                     std::is_sorted(first_.begin(), first_.end()) && first_.back() == entries_.size();
  return cells && std::all_of(entries_.begin(), entries_.end(),
                              [&](const PairEntry& e) { return e.reference < references_.size(); });
}

void PairTable::count_repeats() {
  for (std::size_t c = 0; c + 1 < first_.size(); ++c) {
    std::uint32_t run = 0;  // a cell's entries come reference by reference
    for (std::uint32_t k = first_[c]; k < first_[c + 1]; ++k) {
      run = k > first_[c] && entries_[k].reference == entries_[k - 1].reference ? run + 1 : 1;
      most_of_one_ = std::max(most_of_one_, run);
    }
  }
}

}  // namespace binpick

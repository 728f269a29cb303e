// Hough voting (paper 4.1; Drost et al. 2010): every scene point in turn is a reference; each of its neighbours makes a
// pair whose feature finds equal pairs of the model, and every such pair votes for (model reference, angle alpha about
// the normal). A peak is a pose. Votes are integers and ties go to the earlier cell, so the answer is always the same.
#pragma once

#include <vector>

#include "core/config.hpp"
#include "core/point_cloud.hpp"
#include "core/pose.hpp"
#include "perception/pair_table.hpp"

namespace binpick {

struct VotingConfig {
  double distance_step = 0;        ///< m; 0: relative_step x diameter. The paper's is 5 mm
  double relative_step = 0.05;     ///< of the diameter: 5 mm on the paper's 100 mm bearing
  double angle_step = 0.20943951;  ///< rad, 12 degrees (paper 4)
  int reference_step = 4;          ///< every n-th scene point is a reference
  double pair_radius = 0.6;        ///< of the diameter: longest pair that votes
  int partners = 300;              ///< about so many of the points around a reference make pairs with it; 0: all
  int largest_cell = 600;          ///< cells with more entries (coplanar pairs) say little and cost most: skipped
  double full_cell = 0.03;         ///< of all counters: cells that vote for more say little; their votes weigh less
  int peaks = 3;                   ///< poses a reference may give
  double peak_ratio = 0.7;         ///< of its best, for the further ones

  void visit(ConfigVisitor& v);
  void validate() const;
  PairQuantiser quantiser(double diameter) const;
};

struct PoseHypothesis {
  Pose X_CP = Pose::Identity();
  double votes = 0;
};

/// How the references are gone through: every `of`-th, beginning with number `first` (a search may begin with some of
/// them), on so many threads; their number changes no bit.
struct VoteRun {
  int threads = 1;
  int first = 0, of = 1;
};

/// Peaks of the references, in the order of the references. Both clouds carry normals.
std::vector<PoseHypothesis> vote(const PointCloud& scene_C, const PairTable& table, double diameter,
                                 const VotingConfig& config, VoteRun run = {});

/// The pose that lays a model reference and its pair onto a scene reference: alpha = scene angle - model angle (rad).
Pose pose_from_vote(const OrientedPoint& scene_C, const OrientedPoint& model_P, double alpha);

}  // namespace binpick

// A part prepared for the errors of the field: its vertices as its file has them, its symmetries in closed form and as
// the list the BOP toolkit tries, its surface's moments. Frame P, metres.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/part.hpp"
#include "evaluation/bop_symmetry.hpp"
#include "evaluation/metrics_surface.hpp"
#include "evaluation/scoring_model.hpp"

namespace binpick {

/// How a continuous symmetry is tried: to its very minimum, or at the 315 turns of the BOP toolkit. The toolkit's error
/// is the larger one, by at most half a step of the rim: 0.5 % of the diameter.
enum class SymmetrySearch { kExact, kToolkit };

class FieldModel {
 public:
  explicit FieldModel(const Part& part);
  /// With the symmetries as a data set lists them; part.symmetry should be closed_form(listed).
  FieldModel(const Part& part, const BopSymmetries& listed);

  const ScoringModel& scoring() const { return scoring_; }
  const Symmetry& symmetry() const { return scoring_.symmetry(); }
  double diameter() const { return scoring_.diameter(); }
  const SurfaceDistance& surface() const { return surface_; }
  const std::vector<Pose>& toolkit_list() const { return toolkit_list_; }

  /// Every vertex of the mesh, repeated ones too, since means run over them; far ones first, so that a maximum is
  /// reached early.
  const std::vector<Eigen::Vector3d>& vertices_P() const { return vertices_P_; }
  /// Those on the hull, far ones first: MSSD is reached at one of them.
  const std::vector<Eigen::Vector3d>& hull_P() const { return hull_P_; }

 private:
  ScoringModel scoring_;
  SurfaceDistance surface_;
  std::vector<Pose> toolkit_list_;
  std::vector<Eigen::Vector3d> vertices_P_, hull_P_;
};

}  // namespace binpick

// translation [m]: how far the centre of the part's bounding box is from where it truly is.
// The box centre, not the CAD origin: an origin drawn far from the part would turn rotation into translation. The true
// pose is taken at its symmetric twin nearest to the estimate, which matters when the symmetry does not fix the box
// centre.
#include "evaluation/metric.hpp"

namespace binpick {
namespace {

class TranslationMetric : public Metric {
 public:
  double error(const Pose& X_WP_est, const Pose& X_WP_true, const ScoringModel& model) const override {
    const Pose X_WP_twin = nearest_equivalent(X_WP_true, X_WP_est, model.symmetry());
    return (X_WP_est * model.box_center_P() - X_WP_twin * model.box_center_P()).norm();
  }
};

}  // namespace

std::unique_ptr<Metric> make_translation_metric() { return std::make_unique<TranslationMetric>(); }

}  // namespace binpick

#include "core/error.hpp"
#include "core/yaml.hpp"
#include "perception/pose_estimator.hpp"

namespace binpick {

std::unique_ptr<PoseEstimator> make_ppf_estimator();
std::unique_ptr<PoseEstimator> make_paper_ppf_estimator();
std::unique_ptr<PoseEstimator> make_external_estimator();

const std::vector<EstimatorEntry>& estimator_registry() {
  static const std::vector<EstimatorEntry> entries = {
      {"ppf", "point pair features of surfaces and edges, verified by drawing, refined on what is visible",
       make_ppf_estimator},
      {"paper_ppf", "the paper's pipeline: point pair features of the CAD, Hough voting, verification, ICP",
       make_paper_ppf_estimator},
      {"external", "any program: a folder with the frame goes out, a table of poses comes back",
       make_external_estimator},
  };
  return entries;
}

std::vector<std::string> estimator_names() {
  std::vector<std::string> names;
  for (const EstimatorEntry& entry : estimator_registry()) names.push_back(entry.name);
  return names;
}

std::unique_ptr<PoseEstimator> make_estimator(const std::string& name) {
  for (const EstimatorEntry& entry : estimator_registry())
    if (entry.name == name) return entry.make();
  const std::string nearest = nearest_name(name, estimator_names());
  throw SpecError("estimator.type: unknown type '" + name + "'" +
                  (nearest.empty() ? "" : ", did you mean '" + nearest + "'?"));
}

}  // namespace binpick

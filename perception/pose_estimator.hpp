// The interface of the pose estimators: frame + parts -> poses. Works on a real camera; knows no simulator and no truth.
// One .cpp file a variant, one line in perception/registry.cpp; the object is its own configuration (visit).
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/config.hpp"
#include "core/part.hpp"
#include "core/pose_estimate.hpp"
#include "core/random.hpp"

namespace binpick {

class PoseEstimator {
 public:
  virtual ~PoseEstimator() = default;
  virtual void visit(ConfigVisitor& v) = 0;   ///< its parameters
  virtual void validate() const = 0;          ///< throws SpecError
  virtual void prepare(std::span<const Part> parts) = 0;                             ///< once, may be slow
  virtual EstimateResult estimate(const SceneView& view, Seed seed) const = 0;       ///< same input, same answer
  virtual std::size_t table_bytes() const { return 0; }  ///< of the model tables that prepare() made; 0: unknown
};

struct EstimatorEntry {
  std::string name;
  std::string help;
  std::unique_ptr<PoseEstimator> (*make)();
};
const std::vector<EstimatorEntry>& estimator_registry();
std::vector<std::string> estimator_names();
std::unique_ptr<PoseEstimator> make_estimator(const std::string& name);  ///< throws SpecError with the nearest name

}  // namespace binpick

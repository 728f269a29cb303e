// Who takes part in `binpick bench perception`: an estimator of the registry with settings of its own, or the oracle.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "perception/pose_estimator.hpp"
#include "perception/score_calibration.hpp"
#include "trials/observation.hpp"

namespace binpick {

/// As the command line says it.
struct ContenderSpec {
  std::string name;                   ///< shown; empty: the type and its settings
  std::string type = "ppf";           ///< a name of the registry, `oracle`, or a peer's
  std::vector<std::string> settings;  ///< "search.edges=false": dots go into sections; values as YAML has them
  std::string file;                   ///< YAML as in a scene's `estimator:`; its type wins, the settings follow it
};

/// "TYPE" or "TYPE key=value key=value ..", the settings separated by blanks. Throws SpecError.
ContenderSpec parse_contender(const std::string& text);

/// What a contender has cost so far to get ready.
struct Training {
  double ms = 0;       ///< median of the preparations of this one part, computed anew each time
  double load_ms = 0;  ///< the same, read from a cache on disk (core/disk_cache); 0: this estimator keeps nothing there
  std::size_t table_bytes = 0;
};

class Contender {
 public:
  /// Throws SpecError: unknown type, unknown setting, value out of bounds.
  explicit Contender(const ContenderSpec& spec);

  const std::string& name() const { return name_; }
  const std::string& type() const { return type_; }
  bool is_peer() const { return peer_; }
  bool reads_truth() const { return !estimator_; }
  /// All settings as YAML, for the record.
  std::string settings() const;

  /// Times the preparation of each part alone, then prepares all of them for estimate().
  std::vector<Training> prepare(std::span<const Part> parts);
  /// `features`, when asked for: what each score was made of; left empty by estimators that do not say.
  EstimateResult estimate(const Observation& seen, Seed seed, std::vector<ScoreFeatures>* features = nullptr) const;

  /// Asked for one pickable pose only. False: this estimator knows no such question.
  bool can_stop_early() const { return first_ != nullptr; }
  EstimateResult estimate_first(const Observation& seen, Seed seed) const;

 private:
  std::string name_, type_;
  bool peer_ = false;
  std::unique_ptr<PoseEstimator> estimator_, first_;
  OracleConfig oracle_;
  std::vector<Part> parts_;  ///< the oracle's
};

}  // namespace binpick

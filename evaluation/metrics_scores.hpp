// Scores of a data set from the errors of its images, as the BOP challenges define them (docs/metrics.md; read from
// pose_matching.py, score.py, eval_calc_scores.py, eval_bop19_pose.py and eval_bop24_pose.py of the BOP toolkit, MIT):
// average recall of 6D localisation (BOP19), average precision of 6D detection (BOP24, BOP25).
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace binpick {

/// One row an estimate, one column an instance; infinite where their objects differ or the error is beyond every
/// threshold.
class ErrorTable {
 public:
  ErrorTable() = default;
  ErrorTable(std::size_t estimates, std::size_t instances);
  double at(std::size_t estimate, std::size_t instance) const { return values_[estimate * instances_ + instance]; }
  double& at(std::size_t estimate, std::size_t instance) { return values_[estimate * instances_ + instance]; }

 private:
  std::size_t instances_ = 0;
  std::vector<double> values_;
};

struct ImageErrors {
  struct Instance {
    int object = 0;
    double visible = 1;  ///< visible fraction
    bool target = true;  ///< localisation has to find it: among the inst_count most visible ones of its object
  };
  struct Estimate {
    int object = 0;
    double score = 0;
    bool asked = true;  ///< localisation looks at it: among the inst_count best ones of its object in this image
    bool kept = true;   ///< detection looks at it: among the best 100 of the image, and its object is in the image
  };
  std::vector<Instance> instances;
  std::vector<Estimate> estimates;
  ErrorTable mssd;              ///< m
  ErrorTable mssd_diameter;     ///< shares of the object's diameter
  ErrorTable mspd;              ///< px of an image 640 px wide
  ErrorTable surface;           ///< the distance of Bregier et al., shares of the object's limit
  std::vector<ErrorTable> vsd;  ///< one a tau; estimates that localisation does not look at are left out
};

/// What is less visible is no target, neither of localisation nor of detection.
inline constexpr double kLeastVisible = 0.1;
inline constexpr std::size_t kMostPerImage = 100;  ///< estimates that detection looks at (200 for XYZ-IBD)

/// 0.05, 0.10 .. 0.50, as the toolkit's arange gives them.
std::vector<double> bop_thresholds();
/// {first, 2 first, .. 10 first}
std::vector<double> ten_steps_of(double first);

enum class Task { kLocalisation, kDetection };
using Matches = std::vector<std::optional<std::size_t>>;  ///< of each estimate, its instance

/// Estimates by descending score (equal ones in their order) take the free instance of least error, strictly below the
/// threshold: localisation among targets, detection among all.
Matches match_greedily(const ImageErrors& image, const ErrorTable& errors, double threshold, Task task);

using TableOf = std::function<const ErrorTable&(const ImageErrors&)>;

/// Found targets / targets, pooled over images and objects; 0 without any.
double localisation_recall(std::span<const ImageErrors> images, const TableOf& table, double threshold);
/// Mean of it over thresholds.
double average_recall(std::span<const ImageErrors> images, const TableOf& table, const std::vector<double>& thresholds);

/// AP of every object with a target (visible >= 0.1), at each threshold: mean over 101 recalls of the best precision at
/// that recall or a higher one. Estimates matched to a less visible instance are left out.
std::map<int, std::vector<double>> detection_precision(std::span<const ImageErrors> images, const TableOf& table,
                                                       const std::vector<double>& thresholds);
/// Mean over thresholds, then over objects.
double mean_average_precision(const std::map<int, std::vector<double>>& by_object);

/// An estimate that counts, and whether it was right.
struct Judged {
  double score = 0;
  bool right = false;
};
/// `judged` by descending score.
double interpolated_precision(const std::vector<Judged>& judged, std::size_t targets);

/// What detection counts, by descending score, and how many targets there are.
struct Detections {
  std::vector<Judged> judged;
  std::size_t targets = 0;
};
/// Of all objects together.
Detections detections(std::span<const ImageErrors> images, const TableOf& table, double threshold);
/// Of each object that an image holds.
std::map<int, Detections> detections_by_object(std::span<const ImageErrors> images, const TableOf& table,
                                               double threshold);

}  // namespace binpick

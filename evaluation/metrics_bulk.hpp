// Average precision of many parts in bulk, as Bregier et al. define it (ICCV workshops 2017, arXiv 1806.08129) for the
// Sileane and IPA bin-picking data sets. An estimate's nearest instance (of its object, by metrics_surface) makes it
//   wrong    when that instance is farther than the limit (a tenth of the diameter of the smallest ball around the
//            part), or when another estimate that counts is nearer to the instance (a duplicate)
//   right    when the instance is to be found: at least half of it visible
//   neither  when it is not
// and an instance to be found that no right estimate belongs to is missed. Only estimates with a score of at least the
// threshold count. A scene's curve has precision 1 where nothing counts and recall 1 where nothing is to be found; the
// curve of a data set is the mean of its scenes' at equal thresholds, AP = sum of p_i (r_i - r_(i-1)) along it.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "evaluation/metrics_scores.hpp"

namespace binpick {

inline constexpr double kToBeFound = 0.5;  ///< visible fraction; BOP's, where the data sets of bulk state an occlusion
inline constexpr double kBulkLimit = 0.1;  ///< of the diameter of the smallest ball

struct BulkPoint {
  double threshold = 0;  ///< least score; infinite: nothing counts
  double precision = 1, recall = 0;
};

/// One scene at one threshold.
BulkPoint bulk_point(const ImageErrors& scene, double threshold, std::optional<std::size_t> best = std::nullopt);

struct BulkScore {
  std::vector<BulkPoint> curve;  ///< of all scenes, by falling threshold
  double ap = 0;                 ///< of that curve
  double mean_ap = 0;            ///< mean of the scenes' own
  double best_f1 = 0;
  double recall_at_99 = 0;  ///< largest recall with a precision of 0.99 or more
};

/// `best`: only the k best estimates are asked for, so that recall is of min(k, to be found).
BulkScore bulk_score(std::span<const ImageErrors> scenes, std::optional<std::size_t> best = std::nullopt);

}  // namespace binpick

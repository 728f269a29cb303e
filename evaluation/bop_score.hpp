// Scores a results file on a data set, by the BOP challenges' rules (docs/bop.md, docs/metrics.md).
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.hpp"
#include "evaluation/bop_io.hpp"
#include "evaluation/bop_results.hpp"
#include "evaluation/metrics_bulk.hpp"
#include "evaluation/metrics_curves.hpp"
#include "evaluation/metrics_model.hpp"
#include "evaluation/metrics_pair.hpp"
#include "evaluation/metrics_scores.hpp"
#include "evaluation/metrics_visible.hpp"

namespace binpick {

struct BopScoreOptions {
  SymmetrySearch search = SymmetrySearch::kExact;
  VsdSettings vsd;
  bool with_vsd = true;  ///< false: depth images are not read
  std::size_t most_per_image = kMostPerImage;
};

struct ObjectScore {
  std::size_t targets = 0;  ///< instances visible >= 0.1
  double ap_mssd = 0, ap_mspd = 0, ap_mssd_mm = 0;
};

/// Of the estimates that detection matches at MSSD < 0.1 diameter: their errors against the matched instance.
struct MatchedErrors {
  std::vector<PairErrors> pairs;
  std::vector<double> cus;
};

struct BopScore {
  std::size_t images = 0, estimates = 0, targets = 0;  ///< targets: what localisation has to find
  std::size_t elsewhere = 0;     ///< estimates in images that no target names, or of objects that are not in the image
  std::optional<double> ar_vsd;  ///< none where an image has no depth
  double ar_mssd = 0, ar_mspd = 0;
  std::optional<double> ar;  ///< bop19_average_recall, mean of the three
  double ap_mssd = 0;        ///< bop24_mAP_mssd = bop25_mAP
  double ap_mspd = 0;        ///< bop24_mAP_mspd
  double ap_mssd_mm = 0;     ///< bop25_mAP_mm: MSSD at 2, 4 .. 20 mm
  double ap = 0;             ///< bop24_mAP, mean of MSSD and MSPD
  std::map<int, ObjectScore> objects;
  BulkScore bulk;                            ///< Bregier et al.
  std::vector<VisibilityBin> by_visibility;  ///< at MSSD < 0.1 diameter, as the next two
  std::vector<CurvePoint> curve;
  Calibration calibration;
  MatchedErrors matched;
  std::optional<double> time;      ///< s, mean over images; none when an image has none
  std::vector<std::string> notes;  ///< of the data set and of the estimates
};

BopScore score_bop(const BopDataset& dataset, const std::vector<BopEstimate>& estimates, const BopScoreOptions& options,
                   ProgressSink* progress = nullptr);

/// For people: percent, millimetres, degrees.
std::string bop_score_text(const BopScore& score);
/// With the toolkit's names for its scores (0 .. 1); schema 1.
std::string bop_score_json(const BopScore& score);

}  // namespace binpick

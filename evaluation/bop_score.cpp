#include "evaluation/bop_score.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace binpick {
namespace {

constexpr double kRight = 0.1;  // of the diameter, for curves and bins
constexpr double kMillimetre = 1e-3;

using ImageId = std::pair<int, int>;

/// What is asked for in one image.
struct Asked {
  std::map<int, int> counts;  ///< of each object to be localised
  bool detect = false;
};

struct Prepared {
  std::map<int, FieldModel> models;
  std::map<ImageId, Asked> asked;
  std::map<ImageId, std::vector<const BopEstimate*>> estimates;  ///< of an image, by descending score
};

Prepared prepare(const BopDataset& dataset, const std::vector<BopEstimate>& estimates) {
  Prepared prepared;
  for (const auto& [id, object] : dataset.objects) prepared.models.emplace(id, FieldModel(object.part, object.listed));
  for (const BopTarget& target : dataset.localise)
    prepared.asked[{target.scene, target.image}].counts[target.object] = target.count;
  for (const auto& image : dataset.detect) prepared.asked[image].detect = true;
  for (const BopEstimate& estimate : estimates)
    prepared.estimates[{estimate.scene, estimate.image}].push_back(&estimate);
  for (auto& [id, list] : prepared.estimates)
    std::stable_sort(list.begin(), list.end(),
                     [](const BopEstimate* a, const BopEstimate* b) { return a->score > b->score; });
  return prepared;
}

/// The inst_count most visible instances of each object.
void choose_targets(const BopImage& image, std::map<int, int> counts, ImageErrors& errors) {
  std::vector<std::size_t> order(image.instances.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return image.instances[a].visible_fraction > image.instances[b].visible_fraction;
  });
  for (const std::size_t i : order) errors.instances[i].target = counts[image.instances[i].object]-- > 0;
}

/// Who looks at which estimate (they come by descending score).
ImageErrors outline(const BopImage& image, const Asked& asked, const std::vector<const BopEstimate*>& estimates,
                    std::size_t most) {
  ImageErrors errors;
  std::set<int> present;
  for (const BopInstance& instance : image.instances) {
    errors.instances.push_back({instance.object, instance.visible_fraction, false});
    present.insert(instance.object);
  }
  choose_targets(image, asked.counts, errors);
  std::map<int, int> left = asked.counts;
  for (std::size_t k = 0; k < estimates.size(); ++k) {
    const int object = estimates[k]->object;
    const bool known = present.count(object) > 0;
    errors.estimates.push_back(
        {object, estimates[k]->score, known && left[object]-- > 0, known && asked.detect && k < most});
  }
  const std::size_t rows = errors.estimates.size(), columns = errors.instances.size();
  errors.mssd = errors.mssd_diameter = errors.mspd = errors.surface = ErrorTable(rows, columns);
  return errors;
}

/// Fills the tables of one image, but for VSD.
void measure(const BopImage& image, const std::vector<const BopEstimate*>& estimates, const Prepared& prepared,
             SymmetrySearch search, ImageErrors& errors) {
  const double per_640 = 640.0 / image.camera.width;
  for (std::size_t e = 0; e < estimates.size(); ++e) {
    if (!errors.estimates[e].asked && !errors.estimates[e].kept) continue;
    const FieldModel& model = prepared.models.at(estimates[e]->object);
    const double farthest = std::max(0.5 * model.diameter(), 20 * kMillimetre) * (1 + 1e-9);
    EstimateInImage in_image(estimates[e]->X_CO, model, image.camera);
    for (std::size_t i = 0; i < image.instances.size(); ++i) {
      if (image.instances[i].object != estimates[e]->object) continue;
      const Pose &X_CO_est = estimates[e]->X_CO, &X_CO_true = image.instances[i].X_CO;
      errors.mssd.at(e, i) = mssd_error(X_CO_est, X_CO_true, model, search, farthest);
      errors.mssd_diameter.at(e, i) = errors.mssd.at(e, i) / model.diameter();
      errors.mspd.at(e, i) = per_640 * in_image.mspd(X_CO_true, search, 50.1 / per_640);
      errors.surface.at(e, i) =
          model.surface().between(X_CO_est, X_CO_true) / (kBulkLimit * model.surface().ball_diameter());
    }
  }
}

/// Silhouettes of two balls of half the diameter may overlap, as the toolkit tests it.
bool may_overlap(const Pose& X_CO_1, const Pose& X_CO_2, double diameter) {
  const Eigen::Vector3d &a = X_CO_1.translation(), &b = X_CO_2.translation();
  if (a.z() == 0 || b.z() == 0) return false;
  return (a.hnormalized() - b.hnormalized()).norm() < diameter / 2 * (1 / a.z() + 1 / b.z());
}

void measure_vsd(const BopDataset& dataset, const BopImage& image, const std::vector<const BopEstimate*>& estimates,
                 const VsdSettings& settings, ImageErrors& errors) {
  const Image<double> seen = ray_lengths(read_bop_depth(dataset, image), image.camera);
  PatchRenderer renderer(image.camera);
  std::vector<DistancePatch> truths;
  for (const BopInstance& instance : image.instances)
    truths.push_back(renderer.draw(dataset.objects.at(instance.object).part.mesh_P, instance.X_CO));
  errors.vsd.assign(settings.taus.size(), ErrorTable(estimates.size(), image.instances.size()));
  for (std::size_t e = 0; e < estimates.size(); ++e) {
    if (!errors.estimates[e].asked) continue;
    const Part& part = dataset.objects.at(estimates[e]->object).part;
    const DistancePatch est = renderer.draw(part.mesh_P, estimates[e]->X_CO);
    for (std::size_t i = 0; i < image.instances.size(); ++i) {
      if (image.instances[i].object != estimates[e]->object) continue;
      if (!may_overlap(estimates[e]->X_CO, image.instances[i].X_CO, part.diameter)) continue;  // an error of 1
      const std::vector<double> values = vsd_errors(est, truths[i], seen, part.diameter, settings);
      for (std::size_t k = 0; k < values.size(); ++k) errors.vsd[k].at(e, i) = values[k];
    }
  }
}

void measure_matched(const BopDataset& dataset, const BopImage& image, const std::vector<const BopEstimate*>& estimates,
                     const Prepared& prepared, const ImageErrors& errors, SymmetrySearch search,
                     MatchedErrors& matched) {
  PatchRenderer renderer(image.camera);
  const Matches matches = match_greedily(errors, errors.mssd_diameter, kRight, Task::kDetection);
  for (std::size_t e = 0; e < matches.size(); ++e) {
    if (!matches[e] || image.instances[*matches[e]].visible_fraction < kLeastVisible) continue;
    const Pose &X_CO_est = estimates[e]->X_CO, &X_CO_true = image.instances[*matches[e]].X_CO;
    const FieldModel& model = prepared.models.at(estimates[e]->object);
    matched.pairs.push_back(pair_errors(X_CO_est, X_CO_true, model, image.camera, search));
    const TriangleMesh& mesh = dataset.objects.at(estimates[e]->object).part.mesh_P;
    const DistancePatch est = renderer.draw(mesh, X_CO_est);
    matched.cus.push_back(cus_error(est, renderer.draw(mesh, X_CO_true)));
  }
}

/// Mean over images; nothing when one image's time is not known.
std::optional<double> mean_time(const std::vector<BopEstimate>& estimates) {
  std::map<ImageId, double> times;
  for (const BopEstimate& estimate : estimates) {
    if (estimate.time < 0) return std::nullopt;
    times.insert({{estimate.scene, estimate.image}, estimate.time});
  }
  if (times.empty()) return std::nullopt;
  double sum = 0;
  for (const auto& [image, time] : times) sum += time;
  return sum / static_cast<double>(times.size());
}

const ErrorTable& mssd_of(const ImageErrors& image) { return image.mssd; }
const ErrorTable& mssd_diameter_of(const ImageErrors& image) { return image.mssd_diameter; }
const ErrorTable& mspd_of(const ImageErrors& image) { return image.mspd; }

void localisation_scores(const std::vector<ImageErrors>& images, BopScore& score) {
  for (const ImageErrors& image : images)
    for (const auto& instance : image.instances) score.targets += instance.target ? 1 : 0;
  score.ar_mssd = average_recall(images, mssd_diameter_of, bop_thresholds());
  score.ar_mspd = average_recall(images, mspd_of, ten_steps_of(5));
  const bool everywhere = std::all_of(images.begin(), images.end(), [](const auto& i) { return !i.vsd.empty(); });
  if (images.empty() || !everywhere) return;
  const std::size_t taus = images.front().vsd.size();
  double sum = 0;
  for (std::size_t k = 0; k < taus; ++k)
    sum += average_recall(
        images, [k](const ImageErrors& image) -> const ErrorTable& { return image.vsd[k]; }, bop_thresholds());
  score.ar_vsd = sum / static_cast<double>(taus);
  score.ar = (*score.ar_vsd + score.ar_mssd + score.ar_mspd) / 3;
}

/// The score over objects; each object's own goes where `own` says.
double precision_of(const std::vector<ImageErrors>& images, const TableOf& table, const std::vector<double>& thresholds,
                    double ObjectScore::*own, BopScore& score) {
  const std::map<int, std::vector<double>> by_object = detection_precision(images, table, thresholds);
  for (const auto& [object, precisions] : by_object)
    score.objects[object].*own = mean_average_precision({{object, precisions}});
  return mean_average_precision(by_object);
}

void detection_scores(const std::vector<ImageErrors>& images, BopScore& score) {
  score.ap_mssd = precision_of(images, mssd_diameter_of, bop_thresholds(), &ObjectScore::ap_mssd, score);
  score.ap_mspd = precision_of(images, mspd_of, ten_steps_of(5), &ObjectScore::ap_mspd, score);
  score.ap_mssd_mm = precision_of(images, mssd_of, ten_steps_of(2 * kMillimetre), &ObjectScore::ap_mssd_mm, score);
  score.ap = (score.ap_mssd + score.ap_mspd) / 2;
  for (const auto& [object, one] : detections_by_object(images, mssd_diameter_of, kRight))
    if (one.targets > 0) score.objects[object].targets = one.targets;
  score.bulk = bulk_score(images);
  score.by_visibility = recall_by_visibility(images, mssd_diameter_of, kRight, visibility_edges());
  const Detections all = detections(images, mssd_diameter_of, kRight);
  score.curve = precision_recall(all.judged, all.targets);
  score.calibration = score_calibration(all.judged);
}

}  // namespace

BopScore score_bop(const BopDataset& dataset, const std::vector<BopEstimate>& estimates, const BopScoreOptions& options,
                   ProgressSink* progress) {
  const Prepared prepared = prepare(dataset, estimates);
  BopScore score;
  score.notes = dataset.notes;
  score.estimates = estimates.size();
  score.time = mean_time(estimates);
  std::vector<ImageErrors> images;
  std::size_t looked_at = 0;
  for (const BopImage& image : dataset.images) {
    const auto asked = prepared.asked.find({image.scene, image.image});
    if (asked == prepared.asked.end()) continue;
    const auto found = prepared.estimates.find({image.scene, image.image});
    const auto list = found == prepared.estimates.end() ? std::vector<const BopEstimate*>() : found->second;
    ImageErrors errors = outline(image, asked->second, list, options.most_per_image);
    measure(image, list, prepared, options.search, errors);
    if (options.with_vsd && !image.depth_file.empty()) measure_vsd(dataset, image, list, options.vsd, errors);
    measure_matched(dataset, image, list, prepared, errors, options.search, score.matched);
    for (const auto& e : errors.estimates) looked_at += e.asked || e.kept ? 1 : 0;
    images.push_back(std::move(errors));
    if (progress) progress->update(images.size(), dataset.images.size(), "");
  }
  if (progress) progress->finish();
  score.images = images.size();
  score.elsewhere = estimates.size() - looked_at;
  localisation_scores(images, score);
  detection_scores(images, score);
  if (!score.ar_vsd)
    score.notes.push_back(options.with_vsd ? "an image has no depth: no VSD, no AR" : "VSD was not asked for: no AR");
  return score;
}

}  // namespace binpick

#include "trials/dataset_export.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>

#include "core/error.hpp"
#include "core/zbuffer.hpp"
#include "evaluation/bop_io.hpp"
#include "sim/grey_image.hpp"
#include "trials/environment.hpp"
#include "trials/observation.hpp"
#include "trials/render_folder.hpp"
#include "trials/sight.hpp"

namespace binpick {
namespace {

int object_of(std::size_t part) { return static_cast<int>(part) + 1; }

/// O: the centre of the bounding box, axes of P.
Pose frame_O(const Part& part) {
  Pose X_PO = Pose::Identity();
  X_PO.translation() = part.box_center_P;
  return X_PO;
}

/// A trial's first look, made again.
struct FirstLook {
  const Scenario& s;
  TrialContext& context;
  const TrialRecord& record;
  const CellWorld& cell_world;
  const Observation& seen;
  int scene = 0;
};

/// Whether it is the look of the record. After a second look the record holds the hashes of both together.
bool as_recorded(const FirstLook& look) {
  if (look.record.picks.empty() || !look.record.picks.front().second_look.empty()) return true;
  return look.record.picks.front().frame_hash == look.seen.frame_hash;
}

int scene_number(Seed seed) {
  if (seed.key > static_cast<std::uint64_t>(std::numeric_limits<int>::max()))
    throw SpecError("seed " + std::to_string(seed.key) + ": is too large for the number of a scene");
  return static_cast<int>(seed.key);
}

/// A run folder whose trials are begun again.
class Replay {
 public:
  Replay(const std::string& run_folder, std::size_t most) {
    if (!std::filesystem::is_directory(run_folder + "/records"))
      throw SpecError(run_folder + ": is not a run folder: no records/ in it");
    records_ = read_records(run_folder);
    if (records_.empty()) throw SpecError(run_folder + ": holds no records");
    records_.resize(std::min(records_.size(), most));
    scenario_ = read_scenario(run_folder + "/scenario.yaml");
    context_ = make_trial_context(scenario_);
    for (const TrialRecord& record : records_)
      if (record.scenario_hash != context_.hash)
        throw SpecError(run_folder + ": seed " + std::to_string(record.seed.key) + " is of another scenario (" +
                        record.scenario_hash + ") than scenario.yaml (" + context_.hash +
                        "): a file it names has changed");
  }

  const Scenario& scenario() const { return scenario_; }
  const TrialContext& context() const { return context_; }

  /// `use` says whether what it made is what the record holds.
  ReplayedRun run(ProgressSink& progress, const std::function<bool(const FirstLook&)>& use) {
    ReplayedRun run;
    std::size_t done = 0;
    for (const TrialRecord& record : records_) {
      run.same_build = run.same_build && record.build == build_id();
      if (failure_of(record)) {
        run.skipped.push_back(record.seed.key);
      } else {
        look_at(record, use, run);
      }
      progress.update(++done, records_.size(), std::to_string(run.different.size()) + " differ");
    }
    progress.finish();
    return run;
  }

 private:
  void look_at(const TrialRecord& record, const std::function<bool(const FirstLook&)>& use, ReplayedRun& run) {
    const TrueCell built = true_cell(scenario_, context_, record.seed);
    CellWorld cell_world(built.cell, scenario_.physics, context_.parts);
    const DropResult heap = drop_heap(scenario_, context_, record.seed, cell_world);
    if (!heap.settled || !heap.escaped.empty()) {
      run.skipped.push_back(record.seed.key);
      return;
    }
    const Observation seen = observe(scenario_, cell_world, context_, record.seed, 0);
    const FirstLook look{scenario_, context_, record, cell_world, seen, scene_number(record.seed)};
    if (!use(look) || !as_recorded(look)) run.different.push_back(record.seed.key);
    run.seeds.push_back(record.seed.key);
  }

  std::vector<TrialRecord> records_;
  Scenario scenario_;
  TrialContext context_;
};

BopObject object_in_O(const Part& part) {
  BopObject object{part, {}};
  const Pose X_PO = frame_O(part);
  for (Eigen::Vector3d& vertex : object.part.mesh_P.vertices) vertex -= X_PO.translation();
  object.part.symmetry = symmetry_in(part.symmetry, X_PO);
  object.listed = bop_symmetries(object.part.symmetry);
  return object;
}

/// Columns and rows of what is set, and how many pixels are.
struct Outline {
  int u0 = std::numeric_limits<int>::max(), v0 = u0, u1 = -1, v1 = -1, pixels = 0;
  void add(int u, int v) {
    u0 = std::min(u0, u), v0 = std::min(v0, v), u1 = std::max(u1, u), v1 = std::max(v1, v);
    ++pixels;
  }
  std::array<int, 4> box() const {
    if (pixels == 0) return {-1, -1, -1, -1};
    return {u0, v0, u1 - u0 + 1, v1 - v0 + 1};
  }
};

/// Draws silhouettes on a canvas three times as wide and high, so that what lies outside the image counts too.
class Silhouettes {
 public:
  explicit Silhouettes(const PinholeCamera& camera) : camera_(camera), buffer_(three_times(camera)) {}

  void add(const Part& part, std::int32_t id, const Capture& capture, BopInstance& one, BopPictures& pictures) {
    buffer_.clear();
    buffer_.draw(part.mesh_P, one.X_CO * frame_O(part).inverse(), 0);
    Image<std::uint8_t> mask(camera_.width, camera_.height, 0), seen = mask;
    Outline whole, visible;
    const PixelRect& dirty = buffer_.dirty();
    for (int wide_v = dirty.v0; wide_v < dirty.v1; ++wide_v)
      for (int wide_u = dirty.u0; wide_u < dirty.u1; ++wide_u) {
        if (buffer_.result().ids(wide_u, wide_v) != 0) continue;
        const int u = wide_u - camera_.width, v = wide_v - camera_.height;
        whole.add(u, v);
        if (!mask.contains(u, v)) continue;
        mask(u, v) = 255;
        one.px_valid += std::isfinite(capture.frame.depth(u, v)) ? 1 : 0;
        if (capture.exact.ids(u, v) != id) continue;
        seen(u, v) = 255;
        visible.add(u, v);
      }
    one.box = whole.box(), one.box_visible = visible.box();
    one.px_all = whole.pixels, one.px_visible = visible.pixels;
    one.visible_fraction = whole.pixels > 0 ? static_cast<double>(visible.pixels) / whole.pixels : 0;
    pictures.masks.push_back(std::move(mask));
    pictures.visible_masks.push_back(std::move(seen));
  }

 private:
  static PinholeCamera three_times(PinholeCamera camera) {
    camera.cx += camera.width, camera.cy += camera.height;
    camera.width *= 3, camera.height *= 3;
    return camera;
  }
  PinholeCamera camera_;
  ZBuffer buffer_;
};

void write_look(const FirstLook& look, Silhouettes& silhouettes, BopWriter& writer) {
  const Capture& capture = look.seen.captures.front();
  BopImage image;
  BopPictures pictures;
  image.scene = look.scene;
  image.camera = capture.frame.camera;
  image.depth_step = depth_png_step(capture.frame.depth);
  image.X_CW = look.seen.truth.X_WC.inverse();
  pictures.depth = depth_counts(capture.frame.depth, image.depth_step);
  // No lens: BOP's images are those of a pinhole camera.
  pictures.grey = capture_grey(*look.context.renderer, look.cell_world.render_scene(),
                               {image.camera, {}, look.seen.truth.X_WC}, {}, look.record.seed.child("sensor"));
  for (const GroundTruth::Instance& instance : look.seen.truth.instances) {
    const Part& part = look.context.parts[instance.part];
    BopInstance one;
    one.object = object_of(instance.part);
    one.X_CO = *image.X_CW * instance.X_WP * frame_O(part);
    silhouettes.add(part, static_cast<std::int32_t>(instance.body), capture, one, pictures);
    image.instances.push_back(one);
  }
  writer.add_image(image, pictures);
}

std::string dataset_info(const Scenario& s, const TrialContext& context, std::size_t scenes) {
  std::string text = "# " + s.name + "\n\nMade by `binpick bop export`. " + std::to_string(scenes) +
                     " scenes, one image each; a scene's number is the seed of its trial.\nScenario hash " +
                     context.hash + ", sensor " + s.sensor_type +
                     ".\n\n| obj_id | part | diameter mm |\n| --- | --- | --- |\n";
  for (std::size_t k = 0; k < context.parts.size(); ++k)
    text += "| " + std::to_string(object_of(k)) + " | " + context.parts[k].name + " | " +
            std::to_string(1e3 * context.parts[k].diameter) + " |\n";
  return text +
         "\nOrigin of each object: centre of its bounding box. visib_fract: pixels seen in the noise-free picture "
         "/ pixels of the\nwhole silhouette, what lies outside the image included. Depth is the sensor's, with "
         "its noise; 0 is no return.\n";
}

/// Scores of what was found now and then.
bool same_scores(const EstimateResult& found, const TrialRecord& record) {
  if (record.picks.empty() || !record.picks.front().second_look.empty()) return true;
  const std::vector<MatchedEstimate>& then = record.picks.front().check.estimates;
  return std::equal(found.estimates.begin(), found.estimates.end(), then.begin(), then.end(),
                    [](const PoseEstimate& a, const MatchedEstimate& b) { return a.score == b.score; });
}

}  // namespace

ReplayedRun export_dataset(const std::string& run_folder, const std::string& out, std::size_t most,
                           ProgressSink& progress) {
  Replay replay(run_folder, most);
  BopWriter writer(out);
  for (std::size_t k = 0; k < replay.context().parts.size(); ++k)
    writer.add_object(object_of(k), object_in_O(replay.context().parts[k]));
  Silhouettes silhouettes(replay.scenario().cell.camera.intrinsics);
  const ReplayedRun run = replay.run(progress, [&](const FirstLook& look) {
    write_look(look, silhouettes, writer);
    return true;
  });
  writer.finish(dataset_info(replay.scenario(), replay.context(), run.seeds.size()));
  return run;
}

ReplayedRun estimates_of_run(const std::string& run_folder, std::size_t most, ProgressSink& progress,
                             std::vector<BopEstimate>& estimates) {
  Replay replay(run_folder, most);
  return replay.run(progress, [&](const FirstLook& look) {
    const EstimateResult found =
        estimate_view(look.s, look.context, look.seen.view, look.seen.truth, look.record.seed.child("estimator", 0));
    for (const PoseEstimate& estimate : found.estimates)
      estimates.push_back({look.scene, 0, object_of(estimate.part), estimate.score,
                           estimate.X_CP * frame_O(look.context.parts[estimate.part]), found.wall.total});
    return same_scores(found, look.record);
  });
}

}  // namespace binpick

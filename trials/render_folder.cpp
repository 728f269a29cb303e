#include "trials/render_folder.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/file_io.hpp"
#include "core/hash.hpp"
#include "core/yaml.hpp"
#include "perception/cloud_io.hpp"
#include "perception/fuse_frames.hpp"
#include "sim/heap_quality.hpp"
#include "trials/artifacts.hpp"

namespace binpick {
namespace {

struct LegendEntry {
  int value = 0;
  std::string name;
  double visible = 0;
  void visit(ConfigVisitor& v) {
    v.field("value", value, "of the pixels of ids.png");
    v.field("name", name, "part or piece of the cell");
    if (value > 0 && value < kIdBin)
      v.field("visible_fraction", visible, Unit::kNone, "of a part: pixels seen / whole silhouette");
  }
};

// A figure that cannot be told (no part in view) is left out.
struct QualitySection {
  HeapQuality parts, rest;
  double shadow = 0;
  static void visit_one(ConfigVisitor& v, const char* key, HeapQuality& quality) {
    if (quality.pixels == 0) return;
    v.section_with(
        key,
        [&](ConfigVisitor& in) {
          in.field("fill", quality.fill, Unit::kNone, "share of its pixels with a return");
          if (!(quality.fill > 0)) return;
          in.field("bias", quality.bias, Unit::kLength, "median of the error");
          in.field("sigma", quality.sigma, Unit::kLength, "robust standard deviation of the error");
          in.field("inverse_depth_noise", quality.inverse_depth_noise, Unit::kNone,
                   "1/m, the same of 1/z; times f B it is the subpixel noise");
          in.field("gross", quality.gross, Unit::kNone, "share of the returns off by more than 5 mm");
        },
        "errors against the exact frame");
  }
  void visit(ConfigVisitor& v) {
    visit_one(v, "parts", parts);
    visit_one(v, "cell", rest);
    if (std::isfinite(shadow))
      v.field("shadow", shadow, Unit::kNone, "px lost on the left of steps of 100 mm and more, median");
  }
};

struct RenderFile {
  std::string scenario, scenario_hash, seed, sensor, frame_hash;
  bool settled = true;
  PinholeCamera camera;
  Pose X_WC = Pose::Identity(), X_CB = Pose::Identity();
  double step = 1e-4, returns = 0;
  StatedNoise noise;
  QualitySection quality;
  std::vector<LegendEntry> legend;
  void visit(ConfigVisitor& v) {
    v.field("scenario", scenario, "name of the scene");
    v.field("scenario_hash", scenario_hash, "as in the records of a campaign");
    v.field("seed", seed, "of the trial");
    v.field("settled", settled, "the heap came to rest, and no part lies beside the bin");
    v.field("sensor", sensor, "model");
    v.field("frame_hash", frame_hash, "of depth and intrinsics, as in a record's first pick");
    v.section("camera", camera, "intrinsics of all images");
    v.field("X_WC", X_WC, "pose of the camera in the world, frame of cloud.ply");
    v.field("X_CB", X_CB, "pose of the bin in the camera");
    v.field("depth_step", step, Unit::kLength, "metres per count of depth_mm.png; 0 counts: no return");
    v.field("returns", returns, Unit::kNone, "share of pixels with a return");
    v.section_with(
        "stated_noise",
        [&](ConfigVisitor& in) {
          in.field("constant", noise.constant, Unit::kLength, "sigma = constant + linear z + quadratic z^2");
          in.field("linear", noise.linear, Unit::kNone, "m per m");
          in.field("quadratic", noise.quadratic, Unit::kNone, "m per m^2");
        },
        "three of it end the colours of noise.png; 1 mm where none is stated");
    v.section("quality", quality, "depth against the exact frame");
    v.list("legend", legend, "values of ids.png");
  }
};

std::string name_of(std::int32_t id, const CellWorld& cell_world) {
  switch (id) {
    case kIdBin:
      return "bin";
    case kIdTable:
      return "table";
    case kIdTray:
      return "tray";
    case kIdArm:
      return "arm";
    case kIdTool:
      return "tool";
    default:
      return id < kIdBin ? cell_world.part_of(static_cast<std::size_t>(id)).name : "other";
  }
}

std::vector<LegendEntry> legend(const Capture& capture, const CellWorld& cell_world) {
  const Image<std::int32_t>& ids = capture.exact.ids;
  std::set<std::int32_t> seen(ids.begin(), ids.end());
  seen.erase(kIdNothing);
  std::vector<LegendEntry> entries = {{0, "nothing", 0}};
  for (const std::int32_t id : seen) {
    const bool part = id < kIdBin;
    entries.push_back({part ? id + 1 : id, name_of(id, cell_world),
                       part ? capture.visibility[static_cast<std::size_t>(id)].fraction() : 0});
  }
  return entries;
}

double share_of_returns(const Image<float>& depth) {
  const auto found = std::count_if(depth.begin(), depth.end(), [](float z) { return std::isfinite(z); });
  return static_cast<double>(found) / static_cast<double>(depth.size());
}

}  // namespace

double depth_png_step(const Image<float>& depth) {
  double farthest = 0;
  for (const float z : depth)
    if (std::isfinite(z)) farthest = std::max(farthest, static_cast<double>(z));
  for (double decade = 1e-4;; decade *= 10)
    for (const double digit : {1.0, 2.0, 5.0})
      if (farthest <= 65535 * digit * decade) return digit * decade;
}

Image<std::uint16_t> depth_counts(const Image<float>& depth, double step) {
  Image<std::uint16_t> counts(depth.width(), depth.height(), 0);
  for (std::size_t i = 0; i < depth.size(); ++i)
    if (std::isfinite(depth[i])) counts[i] = static_cast<std::uint16_t>(std::lround(depth[i] / step));
  return counts;
}

Image<std::uint16_t> label_counts(const Image<std::int32_t>& ids) {
  Image<std::uint16_t> counts(ids.width(), ids.height(), 0);
  for (std::size_t i = 0; i < ids.size(); ++i)
    if (ids[i] != kIdNothing) counts[i] = static_cast<std::uint16_t>(ids[i] < kIdBin ? ids[i] + 1 : ids[i]);
  return counts;
}

void write_render_folder(const std::string& folder, const Scenario& scenario, const RenderLabels& labels,
                         const Capture& capture, const CellWorld& cell_world, DepthRenderer& renderer) {
  const DepthFrame& frame = capture.frame;
  RenderFile file;
  file.scenario = scenario.name;
  file.scenario_hash = labels.scenario_hash;
  file.seed = std::to_string(labels.seed);
  file.settled = labels.settled;
  file.sensor = scenario.sensor_type;
  file.frame_hash = hex(frame_hash(frame));
  file.camera = frame.camera;
  file.X_WC = frame.X_WC;
  file.X_CB = frame.X_WC.inverse() * scenario.cell.X_WB;
  file.step = depth_png_step(frame.depth);
  file.noise = frame.noise;
  file.returns = share_of_returns(frame.depth);
  file.quality = {heap_quality(frame.depth, capture.exact, true), heap_quality(frame.depth, capture.exact, false),
                  shadow_width(frame.depth, capture.exact)};
  file.legend = legend(capture, cell_world);
  make_folder(folder);
  write_png16(folder + "/depth_mm.png", depth_counts(frame.depth, file.step));
  write_tiff(folder + "/depth.tiff", frame.depth);
  write_png16(folder + "/ids.png", label_counts(capture.exact.ids));
  write_png(folder + "/preview.png", depth_picture(frame));
  write_png(folder + "/noise.png", noise_picture(frame, capture.exact.depth));
  write_png(folder + "/shaded.png", renderer.picture(cell_world.render_scene(), frame.camera, labels.X_WC_true));
  write_cloud_ply(folder + "/cloud.ply", cloud_with_normals(frame, {}),
                  "frame C of the camera (x right, y down, z forward), metres; X_WC stands in render.yaml");
  write_file(folder + "/render.yaml", write_yaml([&](ConfigVisitor& v) { file.visit(v); }));
}

}  // namespace binpick

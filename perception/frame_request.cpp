#include "perception/frame_request.hpp"

#include <cmath>
#include <filesystem>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/image_io.hpp"
#include "core/quantity.hpp"
#include "core/yaml.hpp"
#include "perception/cloud_io.hpp"

namespace binpick {
namespace {

constexpr const char* kCloudFile = "cloud.ply";

struct PartItem {
  PartSpec& spec;
  void visit(ConfigVisitor& v) {
    if (v.reading() && v.is_scalar("part")) {
      std::string path;
      v.path("part", path, "part.yaml");
      spec = read_part_spec(path);
    } else {
      v.section("part", spec, "a path of a part.yaml, or a mapping with its keys");
    }
  }
};

// The seed is a 64-bit key: as text, since a YAML number here is a double or an int.
void visit_seed(ConfigVisitor& v, Seed& seed) {
  std::string text = std::to_string(seed.key);
  v.field("seed", text, "seed of the estimator");
  if (!v.reading()) return;
  try {
    std::size_t used = 0;
    seed.key = std::stoull(text, &used);
    if (used != text.size() || text[0] == '-') throw std::invalid_argument(text);
  } catch (const std::exception&) {
    v.fail("seed", "'" + text + "' is not a whole number");
  }
}

}  // namespace

void visit_noise(ConfigVisitor& v, StatedNoise& noise) {
  v.section_with(
      "noise",
      [&](ConfigVisitor& in) {
        in.field("constant", noise.constant, Unit::kLength, "sigma_z = constant + linear z + quadratic z^2");
        in.field("linear", noise.linear, Unit::kNone, "m per m");
        in.field("quadratic", noise.quadratic, Unit::kNone, "m per m^2; stereo: s / (f B)");
        in.field("fattening_px", noise.fattening_px, Unit::kNone,
                 "how far foreground grows over its outline, in pixels");
        in.field("focal_baseline", noise.focal_baseline, Unit::kNone,
                 "m px, f B of a stereo camera: lets a ripple of its disparity be found; 0: no stereo camera");
      },
      "the noise that the camera's data sheet states");
}

void validate_noise(const StatedNoise& noise) {
  // A fitted parabola may have a negative coefficient; it may not promise negative noise where cameras look.
  for (const double value : {noise.constant, noise.linear, noise.quadratic})
    if (!(std::abs(value) < 1)) throw SpecError("noise: constant, linear and quadratic must lie between -1 and 1");
  for (const double z : {0.3, 0.6, 1.0, 2.0})
    if (!(noise.sigma(z) >= 0)) throw SpecError("noise: constant + linear z + quadratic z^2 must not be negative");
  if (!(noise.fattening_px >= 0 && noise.fattening_px < 50))
    throw SpecError("noise.fattening_px: must lie between 0 and 50 pixels");
  if (!(noise.focal_baseline >= 0 && noise.focal_baseline < 1e5))
    throw SpecError("noise.focal_baseline: must lie between 0 and 1e5 m px");
}

void FrameRequest::visit(ConfigVisitor& v) {
  v.section("camera", camera, "intrinsics of depth.tiff");
  visit_noise(v, noise);
  v.list_with(
      "parts", parts.size(), [&](std::size_t n) { parts.resize(n); },
      [&](std::size_t i, ConfigVisitor& in) { PartItem{parts[i]}.visit(in); }, "[{part: ..}] that may be seen");
  if (v.reading()) has_bin = v.has("bin");
  if (has_bin) {
    v.section("bin", bin, "inner size and walls of the bin, when there is one");
    v.field("X_CB", X_CB, "believed pose of the bin (centre of its inner floor, z up) in the camera frame");
  }
  visit_seed(v, seed);
  v.field("time_limit", time_limit, Unit::kTime, "wall clock that an external estimator has; 0: none stated");
  if (v.reading()) estimator = nullptr;
  v.section_with(
      "estimator",
      [&](ConfigVisitor& in) {
        in.choice("type", estimator_type, estimator_names(), "pose estimator");
        if (!estimator) estimator = make_estimator(estimator_type);
        estimator->visit(in);
      },
      "the pose estimator");
  if (!estimator) estimator = make_estimator(estimator_type);
}

void FrameRequest::validate() const {
  camera.validate();
  validate_noise(noise);
  if (parts.empty()) throw SpecError("parts: at least one part must be named");
  for (const PartSpec& part : parts) part.validate();
  if (has_bin) bin.validate();
  estimator->validate();
}

static DepthFrame read_depth(const std::string& folder, const FrameRequest& request) {
  DepthFrame depth;
  depth.camera = request.camera;
  depth.noise = request.noise;
  depth.depth = read_tiff(folder + "/depth.tiff");
  if (depth.depth.width() != depth.camera.width || depth.depth.height() != depth.camera.height)
    throw AssetError(folder + "/depth.tiff: has " + std::to_string(depth.depth.width()) + " x " +
                     std::to_string(depth.depth.height()) + " pixels, request.yaml says " +
                     std::to_string(depth.camera.width) + " x " + std::to_string(depth.camera.height));
  return depth;
}

RecordedFrame read_frame_folder(const std::string& folder) {
  RecordedFrame frame;
  read_yaml_file(folder + "/request.yaml", [&](ConfigVisitor& v) {
    frame.request.visit(v);
    frame.request.validate();
  });
  frame.request.bin.load();
  if (std::filesystem::exists(folder + "/" + kCloudFile)) {
    frame.view.seen = read_cloud_ply(folder + "/" + kCloudFile);
    frame.view.cloud_noise = frame.request.noise;
  } else {
    frame.view.seen = read_depth(folder, frame.request);
  }
  if (frame.request.has_bin) frame.view.bin = frame.request.bin;
  frame.view.X_CB = frame.request.X_CB;
  return frame;
}

void write_frame_folder(const std::string& folder, const FrameRequest& request, const SceneView& view) {
  make_folder(folder);
  FrameRequest copy = request;
  const auto* frame = std::get_if<DepthFrame>(&view.seen);
  if (frame) copy.camera = frame->camera;
  copy.noise = view.noise();
  copy.has_bin = view.bin.has_value();
  if (view.bin) copy.bin = *view.bin;
  copy.X_CB = view.X_CB;
  write_file(folder + "/request.yaml",
             write_yaml([&](ConfigVisitor& v) { copy.visit(v); }, std::filesystem::absolute(folder).string()));
  if (frame) {
    write_tiff(folder + "/depth.tiff", frame->depth);
  } else {
    write_cloud_ply(folder + "/" + kCloudFile, std::get<PointCloud>(view.seen), "frame C, metres");
  }
}

}  // namespace binpick

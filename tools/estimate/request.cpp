#include "tools/estimate/request.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <thread>

#include "core/error.hpp"
#include "core/image_io.hpp"
#include "core/yaml.hpp"
#include "perception/cloud_io.hpp"
#include "perception/organise_cloud.hpp"
#include "perception/preprocess.hpp"

namespace binpick {
namespace {

std::string extension_of(const std::string& path) { return std::filesystem::path(path).extension().string(); }
bool is_yaml(const std::string& path) { return extension_of(path) == ".yaml" || extension_of(path) == ".yml"; }

/// camera.yaml: intrinsics of a rectified image, the meaning of a PNG's steps, the stated noise.
struct CameraFile {
  PinholeCamera camera;
  double depth_scale = 0.001;
  StatedNoise noise;

  void visit(ConfigVisitor& v) {
    for (const char* key : {"width", "height", "fx", "fy", "cx", "cy"})
      if (v.reading() && !v.has(key)) v.fail(key, "is needed");
    camera.visit(v);
    v.field("depth_scale", depth_scale, Unit::kLength, "depth of one step of a 16-bit PNG; 0 is no return");
    visit_noise(v, noise);
  }
  void validate() const {
    camera.validate();
    validate_noise(noise);
    if (!(depth_scale > 0 && depth_scale <= 0.1)) throw SpecError("depth_scale: must lie between 0 and 100 mm");
  }
};

/// bin.yaml: {bin: {inner_size: ..}, X_CB: {xyz: .., rpy: ..}}.
void read_bin(const std::string& path, FrameRequest& request) {
  read_yaml_file(path, [&](ConfigVisitor& v) {
    for (const char* key : {"bin", "X_CB"})
      if (!v.has(key)) v.fail(key, "is needed");
    v.section("bin", request.bin, "inner size and walls of the bin");
    v.field("X_CB", request.X_CB, "believed pose of the bin (centre of its inner floor, z up) in the camera frame");
    request.bin.validate();
  });
  request.bin.load();
  request.has_bin = true;
}

Image<float> read_depth_image(const std::string& path, double scale) {
  const std::string extension = extension_of(path);
  if (extension == ".tif" || extension == ".tiff") return read_tiff(path);
  if (extension != ".png") throw AssetError(path + ": depth is read from a 16-bit .png or a float .tiff");
  const Image<std::uint16_t> steps = read_png16(path);
  Image<float> depth(steps.width(), steps.height(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < steps.size(); ++i)
    if (steps[i] > 0) depth[i] = static_cast<float>(scale * steps[i]);
  return depth;
}

DepthFrame read_depth_frame(const EstimateOptions& options) {
  if (options.camera.empty()) throw SpecError("--depth needs --camera: the intrinsics of the image");
  CameraFile file;
  read_yaml_file(options.camera, [&](ConfigVisitor& v) {
    file.visit(v);
    file.validate();
  });
  DepthFrame frame;
  frame.camera = file.camera;
  frame.noise = file.noise;
  frame.depth = read_depth_image(options.depth, file.depth_scale);
  const auto size = [](int width, int height) { return std::to_string(width) + " x " + std::to_string(height); };
  if (frame.depth.width() != frame.camera.width || frame.depth.height() != frame.camera.height)
    throw AssetError(options.depth + ": has " + size(frame.depth.width(), frame.depth.height()) + " pixels, " +
                     options.camera + " says " + size(frame.camera.width, frame.camera.height));
  return frame;
}

PartSpec part_spec(const std::string& path, const std::string& unit) {
  if (is_yaml(path)) return read_part_spec(path);
  PartSpec spec;
  spec.name = std::filesystem::path(path).stem().string();
  spec.mesh = std::filesystem::absolute(path).string();
  spec.unit = unit;
  spec.validate();
  return spec;
}

StatedNoise noise_of(const std::vector<double>& values) {
  StatedNoise noise;
  double* const into[] = {&noise.constant, &noise.linear, &noise.quadratic, &noise.fattening_px};
  for (std::size_t i = 0; i < std::min<std::size_t>(values.size(), 4); ++i) *into[i] = values[i];
  validate_noise(noise);
  return noise;
}

void choose_estimator(const std::string& chosen, FrameRequest& request) {
  if (is_yaml(chosen)) {
    read_yaml_file(chosen, [&](ConfigVisitor& v) {
      v.choice("type", request.estimator_type, estimator_names(), "pose estimator");
      request.estimator = make_estimator(request.estimator_type);
      request.estimator->visit(v);
      request.estimator->validate();
    });
    return;
  }
  if (!chosen.empty()) request.estimator_type = chosen;
  request.estimator = make_estimator(request.estimator_type);
  request.estimator->validate();
}

RecordedFrame real_frame(const EstimateOptions& options) {
  if (options.parts.empty()) throw SpecError("--part is needed: what may be seen");
  if (options.depth.empty() == options.cloud.empty()) throw SpecError("either --depth or --cloud is needed");
  RecordedFrame frame;
  for (const std::string& path : options.parts) frame.request.parts.push_back(part_spec(path, options.unit));
  if (!options.bin.empty()) read_bin(options.bin, frame.request);
  if (!options.cloud.empty()) {
    if (!options.camera.empty()) throw SpecError("--camera belongs to --depth: a cloud needs no intrinsics");
    frame.view.seen = read_cloud(options.cloud);
  } else {
    frame.view.seen = read_depth_frame(options);
  }
  if (frame.request.has_bin) frame.view.bin = frame.request.bin;
  frame.view.X_CB = frame.request.X_CB;
  choose_estimator(options.estimator, frame.request);
  return frame;
}

}  // namespace

RecordedFrame read_frame(const EstimateOptions& options) {
  RecordedFrame frame;
  if (options.folder.empty()) {
    frame = real_frame(options);
  } else {
    const bool more = !options.parts.empty() || !options.depth.empty() || !options.cloud.empty() ||
                      !options.camera.empty() || !options.bin.empty();
    if (more) throw SpecError(options.folder + ": a recorded frame brings its own parts, image, camera and bin");
    frame = read_frame_folder(options.folder);
    if (!options.estimator.empty()) choose_estimator(options.estimator, frame.request);
  }
  if (!options.noise.empty()) {
    const StatedNoise noise = noise_of(options.noise);
    if (auto* depth = std::get_if<DepthFrame>(&frame.view.seen)) depth->noise = noise;
    frame.view.cloud_noise = noise;
  }
  if (options.seed) frame.request.seed = Seed{*options.seed};
  frame.view.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  return frame;
}

std::vector<Part> load_parts(const FrameRequest& request) {
  std::vector<Part> parts;
  for (const PartSpec& spec : request.parts) {
    parts.push_back(load_part(spec));
    const double room = request.bin.inner_size.norm();
    if (request.has_bin && parts.back().diameter > room)
      throw AssetError(spec.mesh + ": the part is " + std::to_string(std::lround(1e3 * parts.back().diameter)) +
                       " mm across, the bin's largest diagonal is " + std::to_string(std::lround(1e3 * room)) + " mm");
  }
  return parts;
}

DepthFrame depth_of(const SceneView& view) {
  if (const auto* frame = std::get_if<DepthFrame>(&view.seen)) return *frame;
  Scene scene;
  scene.bin = view.bin;
  scene.X_CB = view.X_CB;
  scene.noise = view.noise();
  organise_cloud(std::get<PointCloud>(view.seen), NormalsConfig(), scene);
  DepthFrame frame;
  frame.camera = scene.camera;
  frame.depth = scene.depth;
  frame.camera.width = scene.depth.width();
  frame.camera.height = scene.depth.height();
  return frame;
}

std::string why_nothing(const SceneView& view) {
  const DepthFrame frame = depth_of(view);
  const auto returns =
      std::count_if(frame.depth.begin(), frame.depth.end(), [](float z) { return std::isfinite(z) && z > 0; });
  if (returns == 0)
    return std::holds_alternative<DepthFrame>(view.seen) ? "the image holds no depth"
                                                         : "the cloud holds no point in front of the camera";
  const Scene scene = make_scene(view, PreprocessConfig(), NormalsConfig(), 0.01);
  if (std::count(scene.wanted.begin(), scene.wanted.end(), 1) == 0)
    return view.bin ? "nothing stands above the floor of the bin" : "nothing lies within the range that is looked at";
  return "no pose of the wanted parts explains what is seen";
}

}  // namespace binpick

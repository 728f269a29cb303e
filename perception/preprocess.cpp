#include "perception/preprocess.hpp"

#include <algorithm>
#include <cmath>

#include "core/check.hpp"
#include "core/error.hpp"
#include "perception/bin_finder.hpp"
#include "perception/bin_mask.hpp"
#include "perception/floor_mask.hpp"
#include "perception/floor_offset.hpp"
#include "perception/large_planes.hpp"
#include "perception/noise_correlation.hpp"
#include "perception/organise_cloud.hpp"
#include "perception/scene_crop.hpp"

namespace binpick {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
constexpr double kNoBias = 1e-7;      // m
constexpr double kAroundBin = 0.015;  // m about the believed bin that stay in the picture: it may be off by so much

void clear_bad_depth(Scene& scene) {
  for (float& z : scene.depth)
    if (!(z > 0) || !std::isfinite(z)) z = kUnknown;
}

/// Error of the inverse depth by the fraction of the disparity, since a sine a pixel is dear.
std::vector<float> ripple_table(const DisparityRipple& ripple) {
  constexpr int kSteps = 512;  // far finer than the noise of a pixel
  std::vector<float> table(kSteps, 0.0f);
  if (ripple.none()) return table;
  for (int k = 0; k < kSteps; ++k)
    table[static_cast<std::size_t>(k)] = static_cast<float>(ripple.at(ripple.fB / (1 + (k + 0.5) / kSteps)));
  return table;
}

void remove_bias(Scene& scene, const LocatedBin& located) {
  const std::vector<float> table = ripple_table(located.ripple);
  const auto steps = static_cast<float>(table.size()), fB = static_cast<float>(located.ripple.fB);
  for (int v = 0; v < scene.depth.height(); ++v)
    for (int u = 0; u < scene.depth.width(); ++u) {
      float& z = scene.depth(u, v);
      if (!(z > 0)) continue;
      const float turns = fB / z, fraction = turns - std::floor(turns);
      const float wave = table[std::min(table.size() - 1, static_cast<std::size_t>(fraction * steps))];
      const float inverse = 1 / z - static_cast<float>(located.bias.at(scene.camera, u, v)) - wave;
      z = inverse > 0 ? 1 / inverse : kUnknown;
    }
}

/// Where the bin stands and what the sensor is off by, from floor and walls; false when too little of them is seen.
bool locate(Scene& scene, const PreprocessConfig& config) {
  if (!config.locate.enabled) return false;
  const LocatedBin located = locate_bin(scene, config.locate);
  if (!located.found) return false;
  scene.X_CB = located.X_CB;
  if (!config.calibrate_floor) return true;
  scene.floor_offset = located.bias.constant;
  remove_bias(scene, located);
  return true;
}

void remove_offset(Scene& scene, double offset) {
  scene.floor_offset = offset;
  if (offset == 0) return;
  const auto off = static_cast<float>(offset);
  for (float& z : scene.depth) {
    const float inverse = 1 / z - off;
    z = inverse > 0 ? 1 / inverse : kUnknown;
  }
}

/// Height above the floor up to which a point counts as floor.
double floor_height(const Scene& scene, const PreprocessConfig& config, double thinnest) {
  const double sigma = scene.noise.sigma(scene.X_CB.translation().z());
  return std::clamp(config.floor_cut * sigma, config.floor_cut_least,
                    std::max({config.floor_cut_least, 0.4 * thinnest, 1.3 * sigma}));
}

/// Pass-through (paper 3.1), less floor and walls.
/// What somebody else says are parts, in place of what the bin's shape says. The scene is a piece of the frame.
void mark_segmented(Scene& scene, const Image<std::uint8_t>& parts, const DepthFrame& frame) {
  BP_CHECK(parts.width() == frame.depth.width() && parts.height() == frame.depth.height(),
           "a segmentation of " << parts.width() << " x " << parts.height() << " pixels");
  const auto left = static_cast<int>(std::lround(frame.camera.cx - scene.camera.cx));
  const auto top = static_cast<int>(std::lround(frame.camera.cy - scene.camera.cy));
  for (int v = 0; v < scene.depth.height(); ++v)
    for (int u = 0; u < scene.depth.width(); ++u)
      scene.wanted(u, v) = parts(left + u, top + v) != 0 && scene.depth(u, v) > 0;
}

void mark_wanted(Scene& scene, const PreprocessConfig& config) {
  if (!scene.bin) {
    for (std::size_t i = 0; i < scene.depth.size(); ++i)
      scene.wanted[i] = scene.depth[i] > config.near && scene.depth[i] < config.far;
    return;
  }
  const auto f = [](double x) { return static_cast<float>(x); };
  const Eigen::Vector3d size = scene.bin->rim_size();
  const BinBox box{f(size.x() / 2 - config.wall_margin), f(size.y() / 2 - config.wall_margin), f(scene.floor_cut),
                   f(size.z() + config.headroom)};
  const BinRays rays = bin_rays(scene.camera, scene.X_CB);
  for (int v = 0; v < scene.depth.height(); ++v)
    mark_inside({&scene.depth(0, v), v, scene.depth.width()}, rays, box, &scene.wanted(0, v));
}

/// Where the noise would hide a part that lies flat, neighbours decide together.
void mark_thin_parts(Scene& scene, const PreprocessConfig& config, double thinnest) {
  if (!scene.bin || !config.thin_parts) return;
  const double sigma = scene.noise.sigma(scene.X_CB.translation().z());
  if (0.5 * thinnest > 3 * sigma) return;
  mark_low_pixels(scene, {0.5 * thinnest, 1.5 * thinnest + 4 * sigma, config.wall_margin});
}

/// The bin, where none is known, as the whole view shows it.
std::optional<FoundBin> look_for_bin(Scene& scene, const PreprocessConfig& config, double largest) {
  if (scene.bin || !config.find_bin || !(largest > 0)) return std::nullopt;
  std::optional<FoundBin> found = find_bin(scene, largest);
  if (found) scene.bin = found->bin, scene.X_CB = found->X_CB;
  return found;
}

/// Its size was measured with the same depth: that says nothing of the sensor's constant bias, nor of one that tilts.
void locate_found(Scene& scene, const FoundBin& found, PreprocessConfig config) {
  if (found.walls() < 2 || found.drafted) return;
  config.locate.bias_sigma = config.locate.tilt_sigma = kNoBias;
  locate(scene, config);
}

void take_frame(const DepthFrame& frame, const PreprocessConfig& config, Scene& scene) {
  const bool crop = scene.bin && !frame.depth.empty();
  DepthFrame part =
      crop ? cropped(frame, pixels_of_bin(frame, *scene.bin, scene.X_CB, kAroundBin, config.headroom)) : frame;
  scene.camera = part.camera;
  scene.depth = std::move(part.depth);
  scene.normals = Image<Eigen::Vector3f>(scene.depth.width(), scene.depth.height(), Eigen::Vector3f::Zero());
}

}  // namespace

void PreprocessConfig::visit(ConfigVisitor& v) {
  v.field("voxel", voxel, Unit::kNone, "edge of the voxel grid, of the part's diameter (paper 3.1)");
  v.field("calibrate_floor", calibrate_floor, "remove the disparity offset that the visible floor shows");
  v.field("largest_offset", largest_offset, Unit::kLength, "largest depth offset at the floor that is believed");
  v.field("floor_cut", floor_cut, Unit::kNone, "floor removed up to this many standard deviations of the depth");
  v.field("floor_cut_least", floor_cut_least, Unit::kLength, "floor removed at least up to this height");
  v.field("thin_parts", thin_parts, "tell parts hardly thicker than the noise from the floor by several pixels");
  v.field("wall_margin", wall_margin, Unit::kLength, "points nearer to a wall are removed");
  v.field("headroom", headroom, Unit::kLength, "height above the rim that is still looked at");
  v.field("find_bin", find_bin, "without a bin: floor and walls of a bin, or a table, are found in the view itself");
  v.field("large_planes", large_planes, "where none is found: planes that reach farther than any part are not parts");
  v.section("locate", locate, "the bin's pose and the sensor's bias from floor and walls in view");
  v.field("near", near, Unit::kLength, "pass-through without a bin: least depth");
  v.field("far", far, Unit::kLength, "pass-through without a bin: largest depth");
}

void PreprocessConfig::validate() const {
  if (!(voxel >= 0.01 && voxel <= 0.2)) throw SpecError("preprocess.voxel: must lie between 0.01 and 0.2");
  if (!(largest_offset > 0 && largest_offset < 0.1))
    throw SpecError("preprocess.largest_offset: must lie between 0 and 100 mm");
  if (!(floor_cut >= 0 && floor_cut <= 20)) throw SpecError("preprocess.floor_cut: must lie between 0 and 20");
  if (!(floor_cut_least >= 0 && floor_cut_least < 0.1))
    throw SpecError("preprocess.floor_cut_least: must lie between 0 and 100 mm");
  if (!(wall_margin >= 0 && wall_margin < 0.1))
    throw SpecError("preprocess.wall_margin: must lie between 0 and 100 mm");
  if (!(headroom >= 0 && headroom < 2)) throw SpecError("preprocess.headroom: must lie between 0 and 2 m");
  locate.validate();
  if (!(near >= 0 && far > near)) throw SpecError("preprocess.near, far: 0 <= near < far is needed");
}

Scene make_scene(const SceneView& view, const PreprocessConfig& config, const NormalsConfig& normals, double thinnest,
                 double largest) {
  Scene scene;
  scene.bin = view.bin;
  scene.X_CB = view.X_CB;
  scene.noise = view.noise();
  scene.threads = view.threads;
  const auto* frame = std::get_if<DepthFrame>(&view.seen);
  if (frame) {
    take_frame(*frame, config, scene);
  } else {
    organise_cloud(std::get<PointCloud>(view.seen), normals, scene);
  }
  const std::optional<FoundBin> found = look_for_bin(scene, config, largest);
  if (found && frame) take_frame(*frame, config, scene);
  scene.wanted = Image<std::uint8_t>(scene.depth.width(), scene.depth.height(), 0);
  clear_bad_depth(scene);
  if (found) {
    locate_found(scene, *found, config);
  } else if (scene.bin && !locate(scene, config) && config.calibrate_floor) {
    remove_offset(scene, floor_offset(scene, config.largest_offset));
  }
  if (scene.bin) scene.floor_cut = floor_height(scene, config, thinnest);
  mark_wanted(scene, config);
  mark_thin_parts(scene, config, thinnest);
  if (scene.bin && scene.bin->shaped()) unmark_bin(scene, config.wall_margin);
  if (found && found->drafted) unmark_faces(scene, *found, config.wall_margin);
  if (frame && view.segmentation) mark_segmented(scene, *view.segmentation, *frame);
  if (frame) {
    estimate_normals(scene, normals);
  } else {
    drop_disagreeing_normals(scene, normals);
  }
  // What stands on a table beside the parts, a wall behind it say.
  if (found && found->walls() == 0 && config.large_planes) unmark_large_planes(scene, largest);
  scene.correlated_px = pixels_per_noise_value(scene);
  return scene;
}

}  // namespace binpick

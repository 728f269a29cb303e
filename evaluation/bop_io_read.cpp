#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <set>

#include "core/image_io.hpp"
#include "core/mesh_io.hpp"
#include "evaluation/bop_io.hpp"
#include "evaluation/bop_json.hpp"
#include "evaluation/bop_layout.hpp"
#include "evaluation/metrics_scores.hpp"

namespace binpick {
namespace {

namespace fs = std::filesystem;

int id_of_key(const std::string& key, const JsonPlace& at) {
  int id = -1;
  const auto [end, problem] = std::from_chars(key.data(), key.data() + key.size(), id);
  if (problem != std::errc() || end != key.data() + key.size() || id < 0) at.fail("'" + key + "' is no id");
  return id;
}

struct Json {
  nlohmann::json value;
  std::string path;
  JsonPlace top() const { return {value, path}; }
};
Json json_of(const BopLayout& layout, const std::string& file) {
  const std::string path = layout.inside(file);
  return {read_json(path), path};
}

BopSymmetries symmetries_of(const JsonPlace& info) {
  BopSymmetries listed;
  if (info.has("symmetries_discrete")) {
    const JsonPlace all = info.at("symmetries_discrete");
    for (std::size_t i = 0; i < all.size(); ++i) {
      const std::vector<double> m = all.at(i).numbers(16);
      const auto S = pose_of_file({m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]},
                                  1e-3 * Eigen::Vector3d(m[3], m[7], m[11]));
      if (!S) all.at(i).fail("is no rotation");
      listed.discrete.push_back(*S);
    }
  }
  if (info.has("symmetries_continuous")) {
    const JsonPlace all = info.at("symmetries_continuous");
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Eigen::Vector3d axis = all.at(i).at("axis").vector();
      if (!(axis.norm() > 1e-9)) all.at(i).fail("axis: must not be zero");
      listed.continuous.push_back({axis.normalized(), 1e-3 * all.at(i).at("offset").vector()});
    }
  }
  return listed;
}

std::map<int, BopObject> objects_of(const BopLayout& layout, const std::vector<BopImage>& images) {
  std::set<int> used;
  for (const BopImage& image : images)
    for (const BopInstance& instance : image.instances) used.insert(instance.object);
  const std::string folder = layout.has("models_eval/models_info.json") ? "models_eval/" : "models/";
  const Json infos = json_of(layout, folder + "models_info.json");
  std::map<int, BopObject> objects;
  for (const int id : used) {
    const JsonPlace info = infos.top().at(std::to_string(id));
    BopObject object;
    object.part.name = "obj_" + six_digits(id);
    object.part.mesh_P = read_mesh(layout.inside(folder + object.part.name + ".ply"));
    object.part.envelope_P = object.part.mesh_P;
    object.part.diameter = 1e-3 * info.at("diameter").number();
    if (!(object.part.diameter > 0)) info.at("diameter").fail("must be positive");
    object.listed = symmetries_of(info);
    object.part.symmetry = closed_form(object.listed);
    objects.emplace(id, std::move(object));
  }
  return objects;
}

std::optional<Pose> world_in_camera(const JsonPlace& camera) {
  for (const std::string prefix : {"cam_", ""}) {
    if (!camera.has(prefix + "R_w2c") || !camera.has(prefix + "t_w2c")) continue;
    const JsonPlace rotation = camera.at(prefix + "R_w2c");
    const auto X_CW = pose_of_file(rotation.numbers(9), 1e-3 * camera.at(prefix + "t_w2c").vector());
    if (!X_CW) rotation.fail("is no rotation");
    return X_CW;
  }
  return std::nullopt;
}

PinholeCamera camera_of(const JsonPlace& place, const PinholeCamera& size) {
  const std::vector<double> K = place.at("cam_K").numbers(9);
  PinholeCamera camera = size;
  camera.fx = K[0], camera.cx = K[2], camera.fy = K[4], camera.cy = K[5];
  if (!(K[0] > 0 && K[4] > 0) || K[1] != 0 || K[3] != 0 || K[6] != 0 || K[7] != 0 || K[8] != 1)
    place.at("cam_K").fail("is not [fx 0 cx  0 fy cy  0 0 1]");
  return camera;
}

/// Width and height: of camera.json, or of the first depth image.
PinholeCamera image_size(const BopLayout& layout, const std::string& depth_file) {
  PinholeCamera size;
  for (const std::string& name : {layout.with_sensor("camera") + ".json", std::string("camera.json")}) {
    if (!layout.has(name)) continue;
    const Json camera = json_of(layout, name);
    if (!camera.top().has("width")) continue;
    size.width = camera.top().at("width").integer(), size.height = camera.top().at("height").integer();
    if (size.width < 1 || size.height < 1 || size.width > 8192 || size.height > 8192)
      camera.top().fail("width, height: must lie in 1 .. 8192");
    return size;
  }
  if (depth_file.empty()) throw AssetError(layout.inside("camera.json") + ": is missing: how large are the images?");
  const Image<std::uint16_t> depth = read_png16(depth_file);
  size.width = depth.width(), size.height = depth.height();
  return size;
}

void read_info(const JsonPlace& info, BopInstance& instance) {
  instance.visible_fraction = info.at("visib_fract").number();
  const auto whole = [&](const char* key, int& value) {
    if (info.has(key)) value = info.at(key).integer();
  };
  whole("px_count_all", instance.px_all);
  whole("px_count_valid", instance.px_valid);
  whole("px_count_visib", instance.px_visible);
  const auto box = [&](const char* key, std::array<int, 4>& values) {
    if (!info.has(key)) return;
    if (info.at(key).size() != 4) info.at(key).fail("is not x, y, width, height");
    for (std::size_t i = 0; i < 4; ++i) values[i] = info.at(key).at(i).integer();
  };
  box("bbox_obj", instance.box);
  box("bbox_visib", instance.box_visible);
}

std::vector<BopInstance> instances_of(const JsonPlace& truths, const JsonPlace& infos) {
  if (truths.size() != infos.size())
    infos.fail("has " + std::to_string(infos.size()) + " entries, scene_gt " + std::to_string(truths.size()));
  std::vector<BopInstance> instances;
  for (std::size_t i = 0; i < truths.size(); ++i) {
    const JsonPlace truth = truths.at(i);
    BopInstance instance;
    instance.object = truth.at("obj_id").integer();
    const auto X_CO = pose_of_file(truth.at("cam_R_m2c").numbers(9), 1e-3 * truth.at("cam_t_m2c").vector());
    if (!X_CO) truth.at("cam_R_m2c").fail("is no rotation");
    instance.X_CO = *X_CO;
    read_info(infos.at(i), instance);
    instances.push_back(instance);
  }
  return instances;
}

std::string depth_file(const BopLayout& layout, int scene, int image) {
  for (const char* extension : {".png", ".tif", ".tiff"}) {
    const std::string file = layout.scene(scene) + layout.with_sensor("depth") + "/" + six_digits(image) + extension;
    if (layout.has(file)) return layout.inside(file);
  }
  return "";
}

std::vector<BopImage> images_of(const BopLayout& layout, const std::vector<std::pair<int, int>>& wanted) {
  std::map<int, std::vector<int>> by_scene;
  for (const auto& [scene, image] : wanted) by_scene[scene].push_back(image);
  std::vector<BopImage> images;
  std::optional<PinholeCamera> size;
  for (const auto& [scene, ids] : by_scene) {
    const auto part = [&](const char* name) {
      return json_of(layout, layout.scene(scene) + layout.with_sensor(name) + ".json");
    };
    const Json cameras = part("scene_camera"), truths = part("scene_gt"), infos = part("scene_gt_info");
    for (const int id : ids) {
      const std::string key = std::to_string(id);
      BopImage image;
      image.scene = scene, image.image = id;
      image.depth_file = depth_file(layout, scene, id);
      if (!size) size = image_size(layout, image.depth_file);
      const JsonPlace camera = cameras.top().at(key);
      image.camera = camera_of(camera, *size);
      image.depth_step = camera.has("depth_scale") ? 1e-3 * camera.at("depth_scale").number() : 1e-3;
      image.X_CW = world_in_camera(camera);
      image.instances = instances_of(truths.top().at(key), infos.top().at(key));
      images.push_back(std::move(image));
    }
  }
  return images;
}

std::vector<BopTarget> targets_of(const BopLayout& layout, const std::string& file, bool with_object) {
  const Json json = json_of(layout, file);
  std::vector<BopTarget> targets;
  for (std::size_t i = 0; i < json.top().size(); ++i) {
    const JsonPlace place = json.top().at(i);
    BopTarget target;
    target.scene = place.at("scene_id").integer(), target.image = place.at("im_id").integer();
    if (with_object) target.object = place.at("obj_id").integer(), target.count = place.at("inst_count").integer();
    if (target.scene < 0 || target.image < 0 || target.count < 0) place.fail("ids and counts are not negative");
    targets.push_back(target);
  }
  return targets;
}

/// Every image of every scene of the split, by number.
std::vector<std::pair<int, int>> all_images(const BopLayout& layout) {
  std::vector<std::pair<int, int>> images;
  for (const auto& entry : fs::directory_iterator(layout.inside(layout.split()))) {
    const std::string name = entry.path().filename().string();
    if (!entry.is_directory() || name.find_first_not_of("0123456789") != std::string::npos || name.size() > 9) continue;
    const int scene = std::stoi(name);
    const Json truths = json_of(layout, layout.scene(scene) + layout.with_sensor("scene_gt") + ".json");
    if (!truths.value.is_object()) truths.top().fail("is not an object");
    for (const auto& item : truths.value.items()) images.emplace_back(scene, id_of_key(item.key(), truths.top()));
  }
  std::sort(images.begin(), images.end());
  return images;
}

void read_targets(const BopLayout& layout, BopDataset& dataset) {
  const bool has_19 = layout.has("test_targets_bop19.json"), has_24 = layout.has("test_targets_bop24.json");
  std::set<std::pair<int, int>> images;
  if (has_19) dataset.localise = targets_of(layout, "test_targets_bop19.json", true);
  for (const BopTarget& target : dataset.localise) images.emplace(target.scene, target.image);
  if (has_24) {
    for (const BopTarget& target : targets_of(layout, "test_targets_bop24.json", false))
      dataset.detect.emplace_back(target.scene, target.image);
  } else {
    dataset.detect.assign(images.begin(), images.end());
    if (!has_19) dataset.detect = all_images(layout);
    dataset.notes.push_back(std::string("no test_targets_bop24.json: detection is asked for in ") +
                            (has_19 ? "the images of test_targets_bop19.json" : "every image of the split"));
  }
  images.insert(dataset.detect.begin(), dataset.detect.end());
  dataset.images = images_of(layout, {images.begin(), images.end()});
  if (has_19) return;
  dataset.localise = localisation_targets(dataset.images);
  dataset.notes.push_back("no test_targets_bop19.json: to be localised is what is visible to a tenth");
}

}  // namespace

std::vector<BopTarget> localisation_targets(const std::vector<BopImage>& images) {
  std::vector<BopTarget> targets;
  for (const BopImage& image : images) {
    std::map<int, int> counts;
    for (const BopInstance& instance : image.instances)
      if (instance.visible_fraction >= kLeastVisible) ++counts[instance.object];
    for (const auto& [object, count] : counts) targets.push_back({image.scene, image.image, object, count});
  }
  return targets;
}

BopDataset read_bop_dataset(const std::string& root, const BopReadOptions& options) {
  const BopLayout layout(root, options.split, options.sensor);
  BopDataset dataset;
  dataset.root = root, dataset.split = layout.split();
  read_targets(layout, dataset);
  dataset.objects = objects_of(layout, dataset.images);
  return dataset;
}

Image<float> read_bop_depth(const BopDataset& dataset, const BopImage& image) {
  if (image.depth_file.empty())
    throw AssetError(dataset.root + ": scene " + std::to_string(image.scene) + ", image " +
                     std::to_string(image.image) + ": has no depth");
  Image<float> depth(image.camera.width, image.camera.height, 0);
  const auto check_size = [&](int width, int height) {
    if (width != depth.width() || height != depth.height())
      throw AssetError(image.depth_file + ": is " + std::to_string(width) + " x " + std::to_string(height) +
                       ", the camera's images are " + std::to_string(depth.width()) + " x " +
                       std::to_string(depth.height()));
  };
  if (image.depth_file.ends_with(".png")) {
    const Image<std::uint16_t> counts = read_png16(image.depth_file);
    check_size(counts.width(), counts.height());
    for (std::size_t i = 0; i < depth.size(); ++i) depth[i] = static_cast<float>(counts[i] * image.depth_step);
    return depth;
  }
  const Image<float> counts = read_tiff(image.depth_file);
  check_size(counts.width(), counts.height());
  for (std::size_t i = 0; i < depth.size(); ++i)
    if (std::isfinite(counts[i]) && counts[i] > 0) depth[i] = static_cast<float>(counts[i] * image.depth_step);
  return depth;
}

}  // namespace binpick

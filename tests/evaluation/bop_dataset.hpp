// A small data set on disk in BOP's format: two images of boxes, discs and balls in the air, depth of what is there.
#pragma once

#include <unistd.h>
#include <cmath>
#include <filesystem>
#include <string>

#include "evaluation/bop_io.hpp"
#include "evaluation/bop_results.hpp"
#include "evaluation/metrics_visible.hpp"
#include "tests/evaluation/example_parts.hpp"

namespace binpick::examples {

/// A folder of this test's own, removed at its end.
class Folder {
 public:
  explicit Folder(const std::string& name) {
    path_ = (std::filesystem::temp_directory_path() / ("binpick_" + name + "_" + std::to_string(getpid()))).string();
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string path(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

inline PinholeCamera small_camera() {
  PinholeCamera camera;
  camera.width = 320, camera.height = 240, camera.fx = camera.fy = 300, camera.cx = 159.5, camera.cy = 119.5;
  return camera;
}

/// Object 1: boxes, 2: discs, 5: balls; six of each kind in image 4 of scene 0, three in image 9 of scene 12. Some hide
/// others.
inline std::vector<BopImage> some_images(const std::vector<std::pair<int, Part>>& objects) {
  std::vector<BopImage> images;
  for (const auto& [scene, number, count] : {std::tuple{0, 4, 6}, std::tuple{12, 9, 3}}) {
    BopImage image;
    image.scene = scene, image.image = number;
    image.camera = small_camera();
    image.depth_step = 1e-4;
    Rng rng = Seed{7}.child("poses", static_cast<std::uint64_t>(scene)).rng();
    for (const auto& [id, part] : objects)
      for (int k = 0; k < count; ++k) {
        BopInstance one;
        one.object = id;
        one.X_CO.linear() = rng.rotation().toRotationMatrix();
        const Eigen::Vector3d middle(rng.uniform(-0.2, 0.2), rng.uniform(-0.15, 0.15), rng.uniform(0.5, 0.6));
        one.X_CO.translation() = middle - one.X_CO.linear() * part.box_center_P;
        image.instances.push_back(one);
      }
    images.push_back(image);
  }
  return images;
}

/// Draws the image and fills in what is visible.
inline BopPictures pictures_of(BopImage& image, const std::vector<std::pair<int, Part>>& objects) {
  const auto part_of_object = [&](int id) -> const Part& {
    return std::find_if(objects.begin(), objects.end(), [&](const auto& o) { return o.first == id; })->second;
  };
  ZBuffer all(image.camera);
  for (std::size_t i = 0; i < image.instances.size(); ++i)
    all.draw(part_of_object(image.instances[i].object).mesh_P, image.instances[i].X_CO, static_cast<int>(i));
  BopPictures pictures;
  pictures.depth = Image<std::uint16_t>(image.camera.width, image.camera.height, 0);
  pictures.grey = Image<std::uint8_t>(image.camera.width, image.camera.height, 100);
  for (std::size_t p = 0; p < pictures.depth.size(); ++p)
    if (std::isfinite(all.result().depth[p]))
      pictures.depth[p] = static_cast<std::uint16_t>(std::lround(all.result().depth[p] / image.depth_step));
  for (std::size_t i = 0; i < image.instances.size(); ++i) {
    BopInstance& one = image.instances[i];
    ZBuffer alone(image.camera);
    alone.draw(part_of_object(one.object).mesh_P, one.X_CO, 0);
    Image<std::uint8_t> mask(image.camera.width, image.camera.height, 0), visible = mask;
    for (std::size_t p = 0; p < mask.size(); ++p) {
      mask[p] = alone.result().ids[p] == 0 ? 255 : 0;
      visible[p] = all.result().ids[p] == static_cast<int>(i) ? 255 : 0;
      one.px_all += mask[p] ? 1 : 0, one.px_visible += visible[p] ? 1 : 0;
    }
    one.visible_fraction = one.px_all > 0 ? double(one.px_visible) / one.px_all : 0;
    pictures.masks.push_back(mask), pictures.visible_masks.push_back(visible);
  }
  return pictures;
}

inline std::vector<std::pair<int, Part>> some_objects() { return {{1, box()}, {2, disc()}, {5, ball()}}; }

/// Writes it; the images come back with what is visible filled in.
inline std::vector<BopImage> write_dataset(const std::string& root) {
  const auto objects = some_objects();
  BopWriter writer(root);
  for (const auto& [id, part] : objects) writer.add_object(id, {part, bop_symmetries(part.symmetry)});
  std::vector<BopImage> images = some_images(objects);
  for (BopImage& image : images) writer.add_image(image, pictures_of(image, objects));
  writer.finish("a test\n");
  return images;
}

/// The truth as estimates, the visible ones first; `change` may move a pose of an object.
template <class Change>
std::vector<BopEstimate> truth_as_estimates(const BopDataset& dataset, const Change& change) {
  std::vector<BopEstimate> estimates;
  for (const BopImage& image : dataset.images)
    for (const BopInstance& one : image.instances)
      estimates.push_back(
          {image.scene, image.image, one.object, one.visible_fraction, change(one.X_CO, one.object), 0.25});
  return estimates;
}

}  // namespace binpick::examples

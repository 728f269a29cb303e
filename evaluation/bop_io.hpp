// Data sets in BOP's scenewise format (docs/bop.md; docs/bop_datasets_format.md of the BOP toolkit): read and written,
// never rendered. On disk millimetres; here metres. Frame O is the object as the data set draws it, C the camera
// (x right, y down, z forward). Whatever is wrong with a file is an AssetError of one line: file, place, what.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/camera.hpp"
#include "core/image.hpp"
#include "core/part.hpp"
#include "evaluation/bop_symmetry.hpp"

namespace binpick {

struct BopObject {
  Part part;  ///< mesh_P in O; diameter as models_info.json states it; symmetry closed_form(listed)
  BopSymmetries listed;
};

struct BopInstance {
  int object = 0;
  Pose X_CO = Pose::Identity();
  // scene_gt_info.json; boxes are x, y, width, height in pixels, -1 where there is nothing
  double visible_fraction = 1;
  int px_all = 0, px_valid = 0, px_visible = 0;
  std::array<int, 4> box = {-1, -1, -1, -1}, box_visible = {-1, -1, -1, -1};
};

struct BopImage {
  int scene = 0, image = 0;
  PinholeCamera camera;
  double depth_step = 0;     ///< m per count of the depth image
  std::optional<Pose> X_CW;  ///< where the world is, when the file says so
  std::vector<BopInstance> instances;
  std::string depth_file;  ///< empty: there is none
};

struct BopTarget {
  int scene = 0, image = 0, object = 0, count = 0;  ///< count: inst_count
};

struct BopDataset {
  std::string root, split;                  ///< split: the folder, e.g. test or test_primesense
  std::map<int, BopObject> objects;         ///< by obj_id; those that an image holds
  std::vector<BopImage> images;             ///< those that a target names, in the order in which it does
  std::vector<BopTarget> localise;          ///< test_targets_bop19.json, or made from visible fractions
  std::vector<std::pair<int, int>> detect;  ///< test_targets_bop24.json, or the images of the others
  std::vector<std::string> notes;           ///< what was not there and what was done instead
};

struct BopReadOptions {
  std::string split;   ///< empty: the only folder that begins with test, or val
  std::string sensor;  ///< suffix of files and folders (scene_gt_SENSOR.json); empty: none
};

/// Files that would lie outside `root` (symbolic links) are refused. Throws AssetError, SpecError.
BopDataset read_bop_dataset(const std::string& root, const BopReadOptions& options = {});

/// z in metres, 0 where there is none. Throws AssetError: no such image, another size than the camera's.
Image<float> read_bop_depth(const BopDataset& dataset, const BopImage& image);

/// What is drawn of one image. Masks, one an instance: 255 where it is.
struct BopPictures {
  Image<std::uint16_t> depth;
  Image<std::uint8_t> grey;
  std::vector<Image<std::uint8_t>> masks, visible_masks;
};

/// Writes a data set piece by piece; nothing is complete before finish(). Throws StorageError.
class BopWriter {
 public:
  /// SpecError when `root` exists and is no empty folder.
  explicit BopWriter(const std::string& root, const std::string& split = "test");

  /// models/ and models_eval/, alike; part.mesh_P is in O.
  void add_object(int id, const BopObject& object);
  void add_image(const BopImage& image, const BopPictures& pictures);
  /// The JSON files, targets (visible fraction >= 0.1) and dataset_info.md.
  void finish(const std::string& dataset_info);

 private:
  std::string root_, split_;
  std::map<int, BopObject> objects_;
  std::map<int, std::vector<BopImage>> scenes_;
};

/// Instances of each object that are visible enough, image by image.
std::vector<BopTarget> localisation_targets(const std::vector<BopImage>& images);

}  // namespace binpick

// Data sets in BOP's format: what is written reads back, what is wrong is refused in one line that names the place.
#include "evaluation/bop_io.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/file_io.hpp"
#include "core/image_io.hpp"
#include "tests/evaluation/bop_dataset.hpp"

namespace binpick {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

class BopFiles : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    original_ = new examples::Folder("bop_original");
    written_ = examples::write_dataset(original_->path("set"));
  }
  static void TearDownTestSuite() { delete original_; }
  BopFiles() : folder_("bop_io"), root_(folder_.path("set")) {
    fs::copy(original_->path("set"), root_, fs::copy_options::recursive);
  }

  std::string refusal(const BopReadOptions& options = {}) const {
    try {
      read_bop_dataset(root_, options);
    } catch (const AssetError& error) {
      return error.what();
    } catch (const SpecError& error) {
      return error.what();
    }
    return "accepted";
  }
  void change(const std::string& file, const std::function<void(nlohmann::json&)>& edit) const {
    nlohmann::json json = nlohmann::json::parse(read_file(root_ + "/" + file));
    edit(json);
    write_file(root_ + "/" + file, json.dump());
  }

  static examples::Folder* original_;
  static std::vector<BopImage> written_;
  examples::Folder folder_;
  std::string root_;
};
examples::Folder* BopFiles::original_ = nullptr;
std::vector<BopImage> BopFiles::written_;

TEST_F(BopFiles, WhatIsWrittenReadsBack) {
  const BopDataset read = read_bop_dataset(root_);
  EXPECT_EQ(read.split, "test");
  EXPECT_TRUE(read.notes.empty());
  ASSERT_EQ(read.images.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    const BopImage &a = written_[k], &b = read.images[k];
    EXPECT_EQ(b.scene, a.scene);
    EXPECT_EQ(b.image, a.image);
    EXPECT_EQ(b.camera.width, 320);
    EXPECT_EQ(b.camera.cy, 119.5);
    EXPECT_DOUBLE_EQ(b.depth_step, 1e-4);
    ASSERT_EQ(b.instances.size(), a.instances.size());
    for (std::size_t i = 0; i < a.instances.size(); ++i) {
      EXPECT_LT((b.instances[i].X_CO.matrix() - a.instances[i].X_CO.matrix()).cwiseAbs().maxCoeff(), 1e-15);
      EXPECT_EQ(b.instances[i].object, a.instances[i].object);
      EXPECT_EQ(b.instances[i].visible_fraction, a.instances[i].visible_fraction);
      EXPECT_EQ(b.instances[i].px_all, a.instances[i].px_all);
    }
  }
  for (const auto& [id, part] : examples::some_objects()) {
    const BopObject& object = read.objects.at(id);
    EXPECT_NEAR(object.part.diameter, part.diameter, 1e-12);
    EXPECT_EQ(object.part.symmetry.axis.has_value(), part.symmetry.axis.has_value() || part.symmetry.center_P);
    EXPECT_EQ(object.part.symmetry.center_P.has_value(), part.symmetry.center_P.has_value());
    if (!part.symmetry.center_P) {
      EXPECT_EQ(object.part.symmetry.finite.size(), part.symmetry.finite.size());
    }
  }
}

TEST_F(BopFiles, DepthReadsBackInMetres) {
  const BopDataset read = read_bop_dataset(root_);
  const Image<float> depth = read_bop_depth(read, read.images[0]);
  ASSERT_EQ(depth.width(), 320);
  std::size_t seen = 0;
  for (const float z : depth) {
    if (z == 0) continue;
    ++seen;
    ASSERT_GT(z, 0.4f);
    ASSERT_LT(z, 0.7f);
  }
  EXPECT_GT(seen, 5000u);
  write_png16(root_ + "/test/000000/depth/000004.png", Image<std::uint16_t>(10, 10, 1));
  EXPECT_THROW(read_bop_depth(read, read.images[0]), AssetError);
}

// Written as the format's document has it (field names, units, order).
TEST_F(BopFiles, TheFilesAreThoseOfTheFormat) {
  const auto json = [&](const std::string& file) { return nlohmann::json::parse(read_file(root_ + "/" + file)); };
  const nlohmann::json truth = json("test/000000/scene_gt.json")["4"][0];
  const Pose& X_CO = written_[0].instances[0].X_CO;
  EXPECT_NEAR(truth["cam_t_m2c"][2].get<double>(), 1e3 * X_CO.translation().z(), 1e-9);
  EXPECT_EQ(truth["cam_R_m2c"][1].get<double>(), X_CO.linear()(0, 1));  // row by row
  const nlohmann::json camera = json("test/000000/scene_camera.json")["4"];
  EXPECT_EQ(camera["cam_K"][2].get<double>(), 159.5);
  EXPECT_NEAR(camera["depth_scale"].get<double>(), 0.1, 1e-12);
  const nlohmann::json info = json("models/models_info.json");
  EXPECT_NEAR(info["1"]["size_x"].get<double>(), 80, 1e-9);
  EXPECT_NEAR(info["1"]["min_x"].get<double>(), 60, 1e-9);
  EXPECT_EQ(info["1"]["symmetries_discrete"].size(), 3u);
  EXPECT_FALSE(info["1"].contains("symmetries_continuous"));
  EXPECT_NEAR(info["2"]["symmetries_continuous"][0]["offset"][0].get<double>(), 20, 1e-9);
  int visible = 0;
  for (const BopInstance& one : written_[1].instances)
    visible += one.object == 1 && one.visible_fraction >= 0.1 ? 1 : 0;
  const nlohmann::json targets = json("test_targets_bop19.json");
  bool found = false;
  for (const nlohmann::json& t : targets)
    if (t["scene_id"] == 12 && t["obj_id"] == 1) found = t["im_id"] == 9 && t["inst_count"] == visible;
  EXPECT_TRUE(found);
  EXPECT_EQ(json("test_targets_bop24.json").size(), 2u);
  EXPECT_THAT(read_file(root_ + "/models/obj_000005.ply"), StartsWith("ply\nformat ascii 1.0\n"));
  EXPECT_TRUE(fs::exists(root_ + "/test/000012/mask_visib/000009_000000.png"));
}

TEST_F(BopFiles, TargetsMayBeMissing) {
  fs::remove(root_ + "/test_targets_bop19.json");
  fs::remove(root_ + "/test_targets_bop24.json");
  const BopDataset read = read_bop_dataset(root_);
  EXPECT_EQ(read.notes.size(), 2u);
  EXPECT_EQ(read.detect.size(), 2u);
  EXPECT_EQ(read.localise.size(), localisation_targets(written_).size());
}

TEST_F(BopFiles, SensorsHaveFilesOfTheirOwn) {
  for (const std::string scene : {"000000/", "000012/"}) {
    for (const char* file : {"scene_gt", "scene_gt_info", "scene_camera"})
      fs::rename(root_ + "/test/" + scene + file + ".json", root_ + "/test/" + scene + file + "_cam2.json");
    fs::rename(root_ + "/test/" + scene + "depth", root_ + "/test/" + scene + "depth_cam2");
  }
  EXPECT_THAT(refusal(), HasSubstr("scene_camera.json"));
  const BopDataset read = read_bop_dataset(root_, {"", "cam2"});
  EXPECT_THAT(read.images[0].depth_file, HasSubstr("depth_cam2/000004.png"));
}

TEST_F(BopFiles, WhatIsWrongIsNamed) {
  const std::string truth = "test/000012/scene_gt.json";
  change(truth, [](auto& json) { json["9"][1]["cam_R_m2c"][4] = "x"; });
  EXPECT_THAT(refusal(), testing::AllOf(HasSubstr(truth), HasSubstr("9[1] cam_R_m2c[4]: is not a number")));
  change(truth, [](auto& json) { json["9"][1]["cam_R_m2c"] = {1, 0, 0, 0, 2, 0, 0, 0, 1}; });
  EXPECT_THAT(refusal(), HasSubstr("9[1] cam_R_m2c: is no rotation"));
  change(truth, [](auto& json) { json["9"][1].erase("cam_R_m2c"); });
  EXPECT_THAT(refusal(), HasSubstr("has no 'cam_R_m2c'"));
  change(truth, [](auto& json) { json["9"].erase(8); });
  EXPECT_THAT(refusal(), HasSubstr("has 9 entries, scene_gt 8"));
  write_file(root_ + "/" + truth, "{\"9\": [");
  EXPECT_THAT(refusal(), HasSubstr(truth + ": is not JSON"));
  fs::remove(root_ + "/" + truth);
  EXPECT_THAT(refusal(), HasSubstr(truth));
}

TEST_F(BopFiles, NoFileMayLieElsewhere) {
  fs::rename(root_ + "/test/000012/scene_gt.json", folder_.path("scene_gt.json"));
  fs::create_symlink(folder_.path("scene_gt.json"), root_ + "/test/000012/scene_gt.json");
  EXPECT_THAT(refusal(), HasSubstr("leads out of"));
  EXPECT_THAT(refusal({"..", ""}), HasSubstr("names, not paths"));
  EXPECT_THAT(refusal({"", "../x"}), HasSubstr("names, not paths"));
}

TEST_F(BopFiles, SplitsAreNamed) {
  fs::create_directories(root_ + "/test_other");
  EXPECT_THAT(refusal(), HasSubstr("several splits, name one: test test_other"));
  EXPECT_EQ(read_bop_dataset(root_, {"test", ""}).images.size(), 2u);
  EXPECT_THAT(refusal({"train", ""}), HasSubstr("has no folder 'train'"));
  EXPECT_THROW(BopWriter writer(root_), SpecError);  // nothing is written over
}

}  // namespace
}  // namespace binpick

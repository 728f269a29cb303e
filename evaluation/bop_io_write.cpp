#include <Eigen/Geometry>
#include <filesystem>

#include "core/check.hpp"
#include "core/image_io.hpp"
#include "core/mesh_properties.hpp"
#include "core/quantity.hpp"
#include "evaluation/bop_io.hpp"
#include "evaluation/bop_json.hpp"
#include "evaluation/bop_layout.hpp"

namespace binpick {
namespace {

namespace fs = std::filesystem;
using OrderedJson = nlohmann::ordered_json;

constexpr double kMillimetres = 1000;  // per metre

OrderedJson rows_of(const Eigen::Matrix3d& R) {
  OrderedJson list = OrderedJson::array();
  for (int i = 0; i < 9; ++i) list.push_back(R(i / 3, i % 3));
  return list;
}

OrderedJson in_mm(const Eigen::Vector3d& p) {
  return {kMillimetres * p.x(), kMillimetres * p.y(), kMillimetres * p.z()};
}

/// One entry a line, as the toolkit writes: large files stay readable.
std::string by_lines(const OrderedJson& json) {
  const bool object = json.is_object();
  std::string text = object ? "{\n" : "[\n";
  std::size_t k = 0;
  for (const auto& item : json.items()) {
    text += object ? "  \"" + item.key() + "\": " : "  ";
    text += item.value().dump() + (++k < json.size() ? ",\n" : "\n");
  }
  return text + (object ? "}\n" : "]\n");
}

/// Mean of the triangles at a vertex, by area.
std::vector<Eigen::Vector3d> normals_of(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3d> normals(mesh.vertices.size(), Eigen::Vector3d::Zero());
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d twice_area =
        (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]);
    for (const std::uint32_t v : t) normals[v] += twice_area;
  }
  for (Eigen::Vector3d& n : normals) n = n.norm() > 0 ? n.normalized() : Eigen::Vector3d::UnitZ();
  return normals;
}

std::string ply_of(const TriangleMesh& mesh) {
  std::string text = "ply\nformat ascii 1.0\ncomment millimetres\nelement vertex " +
                     std::to_string(mesh.vertices.size()) +
                     "\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\n"
                     "property float nz\nelement face " +
                     std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  const std::vector<Eigen::Vector3d> normals = normals_of(mesh);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3d mm = kMillimetres * mesh.vertices[i];
    for (int k = 0; k < 3; ++k) text += format_double(mm[k]) + " ";
    for (int k = 0; k < 3; ++k) text += format_double(normals[i][k]) + (k < 2 ? " " : "\n");
  }
  for (const auto& t : mesh.triangles)
    text += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) + "\n";
  return text;
}

OrderedJson info_of(const BopObject& object) {
  const Eigen::AlignedBox3d box = bounding_box(object.part.mesh_P);
  OrderedJson info;
  info["diameter"] = kMillimetres * object.part.diameter;
  const char* const axes[] = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k) info[std::string("min_") + axes[k]] = kMillimetres * box.min()[k];
  for (int k = 0; k < 3; ++k) info[std::string("size_") + axes[k]] = kMillimetres * box.sizes()[k];
  for (const Pose& S : object.listed.discrete) {
    OrderedJson rows = OrderedJson::array();
    for (int i = 0; i < 16; ++i) rows.push_back(S.matrix()(i / 4, i % 4) * (i % 4 == 3 && i < 12 ? kMillimetres : 1));
    info["symmetries_discrete"].push_back(rows);
  }
  for (const BopSymmetries::Turns& turns : object.listed.continuous)
    info["symmetries_continuous"].push_back(
        {{"axis", {turns.axis.x(), turns.axis.y(), turns.axis.z()}}, {"offset", in_mm(turns.offset)}});
  return info;
}

OrderedJson camera_json(const BopImage& image) {
  const PinholeCamera& c = image.camera;
  OrderedJson json;
  json["cam_K"] = {c.fx, 0.0, c.cx, 0.0, c.fy, c.cy, 0.0, 0.0, 1.0};
  json["depth_scale"] = kMillimetres * image.depth_step;
  if (image.X_CW) {
    json["cam_R_w2c"] = rows_of(image.X_CW->linear());
    json["cam_t_w2c"] = in_mm(image.X_CW->translation());
  }
  return json;
}

/// scene_camera.json, scene_gt.json and scene_gt_info.json.
void write_scene(const std::string& folder, const std::vector<BopImage>& images) {
  OrderedJson cameras = OrderedJson::object(), truths = cameras, infos = cameras;
  for (const BopImage& image : images) {
    const std::string key = std::to_string(image.image);
    cameras[key] = camera_json(image);
    truths[key] = infos[key] = OrderedJson::array();
    for (const BopInstance& one : image.instances) {
      truths[key].push_back({{"cam_R_m2c", rows_of(one.X_CO.linear())},
                             {"cam_t_m2c", in_mm(one.X_CO.translation())},
                             {"obj_id", one.object}});
      infos[key].push_back({{"bbox_obj", one.box},
                            {"bbox_visib", one.box_visible},
                            {"px_count_all", one.px_all},
                            {"px_count_valid", one.px_valid},
                            {"px_count_visib", one.px_visible},
                            {"visib_fract", one.visible_fraction}});
    }
  }
  write_file(folder + "scene_camera.json", by_lines(cameras));
  write_file(folder + "scene_gt.json", by_lines(truths));
  write_file(folder + "scene_gt_info.json", by_lines(infos));
}

}  // namespace

BopWriter::BopWriter(const std::string& root, const std::string& split) : root_(root), split_(split) {
  if (fs::exists(root) && !(fs::is_directory(root) && fs::is_empty(root)))
    throw SpecError(root + ": exists and is no empty folder");
  make_folder(root + "/" + split);
}

void BopWriter::add_object(int id, const BopObject& object) {
  objects_.emplace(id, object);
  for (const char* folder : {"/models", "/models_eval"}) {
    make_folder(root_ + folder);
    write_file(root_ + folder + "/obj_" + six_digits(id) + ".ply", ply_of(object.part.mesh_P));
  }
}

void BopWriter::add_image(const BopImage& image, const BopPictures& pictures) {
  BP_CHECK(pictures.masks.size() == image.instances.size() && pictures.visible_masks.size() == image.instances.size());
  const std::string folder = root_ + "/" + split_ + "/" + six_digits(image.scene) + "/", name = six_digits(image.image);
  for (const char* kind : {"depth", "gray", "mask", "mask_visib"}) make_folder(folder + kind);
  write_png16(folder + "depth/" + name + ".png", pictures.depth);
  write_png8(folder + "gray/" + name + ".png", pictures.grey);
  for (std::size_t i = 0; i < image.instances.size(); ++i) {
    const std::string of_instance = name + "_" + six_digits(static_cast<int>(i)) + ".png";
    write_png8(folder + "mask/" + of_instance, pictures.masks[i]);
    write_png8(folder + "mask_visib/" + of_instance, pictures.visible_masks[i]);
  }
  scenes_[image.scene].push_back(image);
}

void BopWriter::finish(const std::string& dataset_info) {
  OrderedJson infos = OrderedJson::object(), localise = OrderedJson::array(), detect = localise;
  for (const auto& [id, object] : objects_) infos[std::to_string(id)] = info_of(object);
  for (const auto& [scene, images] : scenes_) {
    write_scene(root_ + "/" + split_ + "/" + six_digits(scene) + "/", images);
    for (const BopTarget& t : localisation_targets(images))
      localise.push_back({{"im_id", t.image}, {"inst_count", t.count}, {"obj_id", t.object}, {"scene_id", t.scene}});
    for (const BopImage& image : images) detect.push_back({{"im_id", image.image}, {"scene_id", scene}});
  }
  for (const char* folder : {"/models", "/models_eval"})
    if (!objects_.empty()) write_file(root_ + folder + "/models_info.json", by_lines(infos));
  write_file(root_ + "/test_targets_bop19.json", by_lines(localise));
  write_file(root_ + "/test_targets_bop24.json", by_lines(detect));
  if (!scenes_.empty()) {
    const BopImage& first = scenes_.begin()->second.front();
    const PinholeCamera& c = first.camera;
    const OrderedJson camera = {{"cx", c.cx},      {"cy", c.cy}, {"depth_scale", kMillimetres * first.depth_step},
                                {"fx", c.fx},      {"fy", c.fy}, {"height", c.height},
                                {"width", c.width}};
    write_file(root_ + "/camera.json", camera.dump(2) + "\n");
  }
  write_file(root_ + "/dataset_info.md", dataset_info);
}

}  // namespace binpick

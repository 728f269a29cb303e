// The errors that the BOP toolkit computed for 240 pairs of poses and 12 images (data/bop_metric_cases.json: source and
// units stand in the file), in metres.
#pragma once

#include <cstdint>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/camera.hpp"
#include "evaluation/bop_symmetry.hpp"
#include "tests/evaluation/example_parts.hpp"

namespace binpick::examples {

inline nlohmann::json bop_cases() {
  std::ifstream file(BINPICK_SOURCE_DIR "/tests/evaluation/data/bop_metric_cases.json");
  return nlohmann::json::parse(file);
}

inline Eigen::Vector3d metres(const nlohmann::json& mm) { return 1e-3 * Eigen::Vector3d(mm[0], mm[1], mm[2]); }

inline Pose bop_pose(const nlohmann::json& R, const nlohmann::json& t) {
  Pose X = Pose::Identity();
  for (int i = 0; i < 9; ++i) X.linear()(i / 3, i % 3) = R[static_cast<std::size_t>(i)];
  X.translation() = metres(t);
  return X;
}

inline PinholeCamera bop_camera(const nlohmann::json& K) {
  PinholeCamera camera;
  camera.fx = K[0], camera.cx = K[2], camera.fy = K[4], camera.cy = K[5];
  return camera;
}

inline BopSymmetries bop_listed(const nlohmann::json& object) {
  BopSymmetries listed;
  if (object.contains("symmetries_discrete"))
    for (const auto& m : object["symmetries_discrete"]) {
      Pose S = Pose::Identity();
      for (int i = 0; i < 12; ++i) S.matrix()(i / 4, i % 4) = m[static_cast<std::size_t>(i)];
      S.translation() *= 1e-3;
      listed.discrete.push_back(S);
    }
  if (object.contains("symmetries_continuous"))
    for (const auto& c : object["symmetries_continuous"])
      listed.continuous.push_back({Eigen::Vector3d(c["axis"][0], c["axis"][1], c["axis"][2]), metres(c["offset"])});
  return listed;
}

/// The object's points as a part; its triangles mean nothing.
inline Part bop_part(const nlohmann::json& object, const std::string& name) {
  TriangleMesh mesh;
  for (const auto& p : object["points"]) mesh.vertices.push_back(metres(p));
  for (std::uint32_t i = 0; i + 2 < mesh.vertices.size(); ++i) mesh.triangles.push_back({i, i + 1, i + 2});
  Part part = part_of(name, mesh);
  part.symmetry = closed_form(bop_listed(object));
  return part;
}

}  // namespace binpick::examples

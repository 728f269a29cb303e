// Private to bin_localisation: floor and walls of a bin as faces, and the pixels that look at them. Frame B for the
// faces, metres.
#pragma once

#include <array>
#include <vector>

#include "perception/scene.hpp"

namespace binpick {

constexpr int kFaces = 5;  // floor, walls at -x, +x, -y, +y

struct BinFace {
  Eigen::Vector3d normal_B;  // inwards
  double offset = 0;         // normal . p = offset on the face
  int along = 0, up = 1;     // axes of B that span it
  Eigen::Vector2d low, high;
  int columns = 1, rows = 1, first_cell = 0;
};

/// A pixel on a face, as believed.
struct FaceSample {
  int face = -1, cell = 0;
  double distance = 0;  // m, of the seen point from the face, inwards
  Eigen::Vector3d p_B = Eigen::Vector3d::Zero();
  double per_depth = 0;  // change of the distance with the depth
  double u = 0, v = 0, z = 0;
  int n = 1;  // pixels, of a mean
};

std::array<BinFace, kFaces> faces_of(const BinSpec& bin);

/// One pixel of nine, where its ray meets a face of the bin at X_CB well inside the edges, and the seen point lies
/// within `reach` (m) of it.
std::vector<FaceSample> samples_of(const Scene& scene, const Pose& X_CB, const std::array<BinFace, kFaces>& faces,
                                   double reach);

}  // namespace binpick

// Symmetries as BOP's models_info.json lists them, and ours from them and into them. Frame of the model, metres.
// Definition: docs/bop_datasets_format.md and misc.get_symmetry_transformations of the BOP toolkit (MIT).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/pose.hpp"
#include "core/symmetry.hpp"

namespace binpick {

struct BopSymmetries {
  std::vector<Pose> discrete;  ///< the identity left out
  struct Turns {
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
    Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< m, a point on the axis
  };
  std::vector<Turns> continuous;

  bool none() const { return discrete.empty() && continuous.empty(); }
};

/// The list that the toolkit tries: every turn of every axis (ceil(pi / step) of them, 315 at its own step of 0.01)
/// after every discrete member, identity first. Two axes are not composed, so a sphere's list is short of most of its
/// rotations.
std::vector<Pose> toolkit_group(const BopSymmetries& listed, double step = 0.01);

/// The same group with its axis (or, of two axes that meet, the centre of a sphere) in closed form. A list that fits
/// neither (axes that do not meet, members that move the axis) comes back as the toolkit's finite one.
Symmetry closed_form(const BopSymmetries& listed);

/// What to write into models_info.json. A sphere becomes three axes.
BopSymmetries bop_symmetries(const Symmetry& symmetry);

/// The group of the same part in a frame O shifted within P: S_O = X_PO^-1 S_P X_PO.
Symmetry symmetry_in(const Symmetry& symmetry_P, const Pose& X_PO);

}  // namespace binpick

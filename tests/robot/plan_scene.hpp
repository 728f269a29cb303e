// Shared by the tests of whole plans: parts at known places in a cell's bin.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/zbuffer.hpp"
#include "robot/plan_pick.hpp"
#include "robot_fixture.hpp"

namespace binpick::testing_robot {

/// Parts at known places in the cell's bin, seen without noise, and estimates that are the truth.
struct Scene {
  Cell cell;
  std::vector<Part> parts;
  Pose X_WC;
  SceneView view;
  EstimateResult found;

  Scene(const std::string& cell_name, const std::string& part)
      : cell(cell_named(cell_name)), parts{load_part(read_part_spec(asset("parts/" + part + "/part.yaml")))} {
    X_WC = cell.camera_pose(cell.q_look);
  }

  /// Part at X_BP in the bin; `detected`: is there an estimate of it?
  void add(const Pose& X_BP, bool detected = true, double score = 0.9) {
    poses_.push_back(cell.X_WB * X_BP);
    if (!detected) return;
    PoseEstimate estimate;
    estimate.X_CP = X_WC.inverse() * poses_.back();
    estimate.score = score;
    found.estimates.push_back(estimate);
    found.status = EstimateStatus::kFound;
  }

  PlanResult plan(int placed = 0, PlanningConfig config = {}, std::span<const PlacedPart> in_tray = {}) {
    see();
    return PickPlanner(cell, parts, config).plan(found, view, X_WC, {placed, {}, {}, in_tray});
  }

  void see() {
    DepthFrame frame;
    frame.X_WC = X_WC;
    ZBuffer buffer(frame.camera);
    const Pose X_CW = X_WC.inverse();
    for (const Primitive& wall : cell.bin_W()) buffer.draw(mesh_of(wall), X_CW, 0);
    for (const Primitive& table : cell.table_W()) buffer.draw(mesh_of(table), X_CW, 0);
    for (const Pose& X_WP : poses_) buffer.draw(parts.front().mesh_P, X_CW * X_WP, 1);
    frame.depth = buffer.result().depth;
    for (int v = 0; v < frame.depth.height(); ++v)
      for (int u = 0; u < frame.depth.width(); ++u)
        if (!std::isfinite(frame.depth(u, v))) frame.depth(u, v) = std::numeric_limits<float>::quiet_NaN();
    view.seen = frame;
    view.bin = cell.bin;
    view.X_CB = X_CW * cell.X_WB;
  }

 private:
  std::vector<Pose> poses_;
};

inline Pose flat(double x, double y, double z = 0.008) { return pose_from_xyz_rpy({x, y, z}, {0, 0, 0}); }

}  // namespace binpick::testing_robot

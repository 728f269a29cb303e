// `external`: any program, in any language, run once for every frame (docs/external_protocol.md).
//
//   command      the program and its arguments; items that begin with ./, ../ or / are paths, relative to the file that
//                holds them. The frame's folder is added as the last argument and is the working directory.
//   time_limit   s of the wall clock, 60; then the program and all it has started are killed
//
// The folder is private, new for every frame and removed afterwards. It holds request.yaml (intrinsics, stated noise,
// parts, bin and its believed pose, time limit, seed), depth.tiff (float metres, NaN = no return) or cloud.ply, and the
// parts' meshes; the program writes estimates.csv into it. A program that cannot be started, ends with another code
// than 0, runs out of time or writes a table that cannot be meant has failed: the trial's outcome is EstimatorFailed.
#include <stdlib.h>

#include <Eigen/QR>
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <numbers>

#include "core/check.hpp"
#include "core/child_program.hpp"
#include "core/error.hpp"
#include "core/mesh_io.hpp"
#include "core/quantity.hpp"
#include "perception/estimates_csv.hpp"
#include "perception/frame_request.hpp"

namespace binpick {
namespace {

/// Removed with all it holds.
class PrivateFolder {
 public:
  PrivateFolder() {
    char name[] = "/tmp/binpick_frame_XXXXXX";
    if (!::mkdtemp(name)) throw StorageError(std::string("/tmp: no folder can be made: ") + std::strerror(errno));
    path_ = name;
  }
  ~PrivateFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

Eigen::Vector3d axis_of(const Pose& S) {
  const Eigen::AngleAxisd turn(S.linear());
  return turn.axis();
}

/// A point that every member leaves in place: sum (I - R)'(I - R) p = sum (I - R)' t, the shortest solution.
Eigen::Vector3d fixed_point(const std::vector<Pose>& members) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const Pose& S : members) {
    const Eigen::Matrix3d M = Eigen::Matrix3d::Identity() - S.linear();
    A += M.transpose() * M;
    b += M.transpose() * S.translation();
  }
  Eigen::CompleteOrthogonalDecomposition<Eigen::Matrix3d> solver;
  solver.setThreshold(1e-9);
  solver.compute(A);
  return solver.solve(b);
}

/// The group as part.yaml states it; the rotations of a polyhedron are left to be found from the mesh.
SymmetrySpec symmetry_spec(const Symmetry& symmetry) {
  SymmetrySpec spec;
  if (symmetry.center_P) {
    spec.type = "sphere";
    spec.point = *symmetry.center_P;
    return spec;
  }
  if (symmetry.axis) {
    spec.type = "revolution";
    spec.axis = symmetry.axis->direction_P;
    spec.point = symmetry.axis->point_P;
    spec.flip = symmetry.finite.size() > 1;
    const Eigen::Vector3d d = spec.axis.normalized();  // a half turn across it keeps the centre: d.t = 2 d.p
    if (spec.flip) spec.point += d * (d.dot(symmetry.finite[1].translation()) / 2 - d.dot(spec.point));
    return spec;
  }
  const std::size_t n = symmetry.finite.size();
  if (n == 1) return spec;
  spec.point = fixed_point(symmetry.finite);
  for (std::size_t k = 1; k < n; ++k) {
    const Eigen::Vector3d axis = axis_of(symmetry.finite[k]);
    const auto about =
        static_cast<std::size_t>(std::count_if(symmetry.finite.begin() + 1, symmetry.finite.end(),
                                               [&](const Pose& S) { return axis_of(S).cross(axis).norm() < 1e-6; }));
    if (about + 1 != n && 2 * (about + 1) != n) continue;
    spec.axis = axis;
    spec.order = static_cast<int>(about + 1);
    spec.type = about + 1 == n ? "cyclic" : "dihedral";
    for (std::size_t m = 1; m < n && spec.type == "dihedral"; ++m)
      if (std::abs(axis_of(symmetry.finite[m]).dot(axis)) < 1e-6) spec.perpendicular = axis_of(symmetry.finite[m]);
    return spec;
  }
  spec.type = "auto";
  return spec;
}

class ExternalEstimator : public PoseEstimator {
 public:
  void visit(ConfigVisitor& v) override {
    v.command("command", command_, "program and arguments; the frame's folder is added");
    v.field("time_limit", time_limit_, Unit::kTime, "wall clock for one frame, then the program is killed");
  }

  void validate() const override {
    if (command_.empty() || command_[0].empty())
      throw SpecError("estimator.command: [program, argument, ..] is needed");
    if (!(time_limit_ >= 0.01 && time_limit_ <= 3600))
      throw SpecError("estimator.time_limit: must lie between 10 ms and one hour");
  }

  void prepare(std::span<const Part> parts) override { parts_.assign(parts.begin(), parts.end()); }

  EstimateResult estimate(const SceneView& view, Seed seed) const override {
    BP_CHECK(!parts_.empty(), "prepare() comes first");
    const auto start = std::chrono::steady_clock::now();
    EstimateResult result;
    try {
      result.estimates = ask(view, seed);
      result.status = result.estimates.empty() ? EstimateStatus::kNothingFound : EstimateStatus::kFound;
    } catch (const AssetError& error) {
      result.message = error.what();
    } catch (const StorageError& error) {
      result.message = error.what();
    }
    if (!result.message.empty()) result.status = EstimateStatus::kFailed;
    result.wall.total = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
  }

 private:
  std::vector<PoseEstimate> ask(const SceneView& view, Seed seed) const {
    const PrivateFolder folder;
    write_request(folder.path(), view, seed);
    std::vector<std::string> command = command_;
    command.push_back(folder.path());
    const ProgramEnd end = run_child_program(command, folder.path(), time_limit_);
    const std::string last = last_line(end.said);
    const std::string said = last.empty() ? "" : ": " + last;
    if (end.timed_out) throw AssetError(command_[0] + ": not done within " + format_double(time_limit_) + " s" + said);
    if (end.code != 0) throw AssetError(command_[0] + ": ended with code " + std::to_string(end.code) + said);
    try {
      return read_estimates_csv(folder.path() + "/estimates.csv", parts_);
    } catch (const AssetError& error) {  // the folder's name is another each time, and gone
      std::string message = error.what();
      if (message.rfind(folder.path() + "/", 0) == 0) message.erase(0, folder.path().size() + 1);
      throw AssetError(command_[0] + ": " + message);
    }
  }

  void write_request(const std::string& folder, const SceneView& view, Seed seed) const {
    FrameRequest request;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const Part& part = parts_[i];
      PartSpec spec;
      spec.name = part.name;
      spec.mesh = folder + "/part_" + std::to_string(i) + ".stl";
      spec.density = part.density;
      spec.mass = part.mass.mass;
      spec.surface = part.surface;
      spec.symmetry = symmetry_spec(part.symmetry);
      write_stl(spec.mesh, part.mesh_P);
      request.parts.push_back(spec);
    }
    request.seed = seed;
    request.time_limit = time_limit_;
    request.estimator = make_estimator(request.estimator_type);
    write_frame_folder(folder, request, view);
  }

  std::vector<std::string> command_;
  double time_limit_ = 60;
  std::vector<Part> parts_;
};

}  // namespace

std::unique_ptr<PoseEstimator> make_external_estimator() { return std::make_unique<ExternalEstimator>(); }

}  // namespace binpick

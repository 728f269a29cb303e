#include "tools/bench/metrics_bench.hpp"

#include <cmath>
#include <numbers>

#include "core/mesh_properties.hpp"
#include "core/random.hpp"
#include "evaluation/metrics_pair.hpp"
#include "evaluation/metrics_visible.hpp"
#include "tools/bench/cpu_clock.hpp"

namespace binpick {
namespace {

constexpr double kPi = std::numbers::pi;

/// A ring 70 x 100 x 16 mm of 1,000 vertices: 250 around, four corners of its section.
TriangleMesh ring_mesh() {
  constexpr std::uint32_t kAround = 250;
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < kAround; ++i)
    for (const auto& [r, z] : {std::pair{0.035, -0.008}, {0.05, -0.008}, {0.05, 0.008}, {0.035, 0.008}})
      mesh.vertices.push_back({r * std::cos(2 * kPi * i / kAround), r * std::sin(2 * kPi * i / kAround), z});
  for (std::uint32_t i = 0; i < kAround; ++i)
    for (std::uint32_t k = 0; k < 4; ++k) {
      const std::uint32_t j = (i + 1) % kAround, a = 4 * i + k, b = 4 * i + (k + 1) % 4, c = 4 * j + k,
                          d = 4 * j + (k + 1) % 4;
      mesh.triangles.push_back({a, c, b});
      mesh.triangles.push_back({b, c, d});
    }
  return mesh;
}

Part ring(bool symmetric) {
  Part part;
  part.name = symmetric ? "ring, any turn, flip" : "ring, no symmetry";
  part.mesh_P = ring_mesh();
  part.diameter = mesh_diameter(part.mesh_P);
  SymmetrySpec symmetry;
  symmetry.type = symmetric ? "revolution" : "none";
  symmetry.flip = symmetric;
  part.symmetry = make_symmetry(symmetry);
  return part;
}

struct Poses {
  std::vector<Pose> truth, estimate;
};

/// Truths in view of the camera; estimates off by at most `shift` and `angle`.
Poses random_poses(std::size_t count, double shift, double angle) {
  Poses poses;
  for (std::size_t i = 0; i < count; ++i) {
    Rng rng = Seed{5000}.child("bench metrics").rng().at(i);
    Pose X = Pose::Identity();
    X.linear() = rng.rotation().toRotationMatrix();
    X.translation() = Eigen::Vector3d(rng.uniform(-0.3, 0.3), rng.uniform(-0.15, 0.15), rng.uniform(0.55, 0.75));
    poses.truth.push_back(X);
    X.rotate(Eigen::AngleAxisd(rng.uniform(0, angle), rng.unit_vector()));
    X.translation() += rng.uniform(0, shift) * rng.unit_vector();
    poses.estimate.push_back(X);
  }
  return poses;
}

MetricsRow time_pairs(const Part& part, const Poses& poses, SymmetrySearch search, const std::string& how) {
  const FieldModel model(part);
  const PinholeCamera camera;
  double sum = 0;
  const CpuClock clock;
  for (std::size_t i = 0; i < poses.truth.size(); ++i)
    sum += pair_errors(poses.estimate[i], poses.truth[i], model, camera, search).mssd;
  MetricsRow row{part.name + ", " + how, poses.truth.size(), clock.seconds(), 1};
  if (!std::isfinite(sum)) row.name += " (an infinite error)";
  return row;
}

/// As bop score does it: an image's truths drawn once, each estimate once, then compared with every one it may overlap.
MetricsRow time_vsd(std::size_t drawn) {
  constexpr std::size_t kTruths = 20;
  const Part part = ring(true);
  const PinholeCamera camera;
  const Poses poses = random_poses(drawn, 0.005, 0.1);
  ZBuffer scene(camera);
  for (std::size_t i = 0; i < std::min(kTruths, drawn); ++i) scene.draw(part.mesh_P, poses.truth[i], 0);
  std::size_t compared = 0;
  double sum = 0;
  const CpuClock clock;
  const Image<double> seen = ray_lengths(scene.result().depth, camera);
  PatchRenderer renderer(camera);
  std::vector<DistancePatch> truths;
  for (std::size_t i = 0; i < std::min(kTruths, drawn); ++i)
    truths.push_back(renderer.draw(part.mesh_P, poses.truth[i]));
  for (std::size_t e = 0; e < drawn; ++e) {
    const DistancePatch estimate =
        renderer.draw(part.mesh_P, poses.truth[e % truths.size()] * (poses.truth[e].inverse() * poses.estimate[e]));
    for (const DistancePatch& truth : truths) {
      if (truth.rect.u0 >= estimate.rect.u1 || estimate.rect.u0 >= truth.rect.u1 || truth.rect.v0 >= estimate.rect.v1 ||
          estimate.rect.v0 >= truth.rect.v1)
        continue;
      sum += vsd_errors(estimate, truth, seen, part.diameter, {})[0] + cus_error(estimate, truth);
      ++compared;
    }
  }
  MetricsRow row{"VSD (10 taus) and CUS, " + std::to_string(drawn) + " estimates, 20 truths, 848 x 480", compared,
                 clock.seconds(), 2};
  if (!std::isfinite(sum)) row.name += " (an infinite error)";
  return row;
}

}  // namespace

std::vector<MetricsRow> bench_metrics(std::size_t pairs, std::size_t drawn) {
  const Poses near = random_poses(pairs, 0.005, 0.1), far = random_poses(pairs, 0.05, kPi);
  std::vector<MetricsRow> rows;
  for (const bool symmetric : {false, true}) {
    const Part part = ring(symmetric);
    rows.push_back(time_pairs(part, near, SymmetrySearch::kExact, "near"));
    rows.push_back(time_pairs(part, far, SymmetrySearch::kExact, "far"));
    if (!symmetric) continue;
    rows.push_back(time_pairs(part, near, SymmetrySearch::kToolkit, "near, 315 turns"));
    rows.push_back(time_pairs(part, far, SymmetrySearch::kToolkit, "far, 315 turns"));
  }
  rows.push_back(time_vsd(drawn));
  return rows;
}

}  // namespace binpick

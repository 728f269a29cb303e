// V-B5: which surfaces seal. The seal is judged by rays on the true mesh; what seals is then lifted, so that the
// verdict is the world's, not the judge's alone.

#include <cmath>
#include <numbers>

#include "robot/pick_sites.hpp"
#include "tools/validate/suction_bench.hpp"

namespace binpick {
namespace {

constexpr double kInner = 0.035, kOuter = 0.050, kHeight = 0.016, kAluminium = 2700;  // the paper's bearing

// Rim of the probes minus the pole, m: the sag that the rays see.
double seen_sag(const Part& sphere, const Gripper& tool, double radius) {
  const MeshQuery query(sphere.mesh_P);
  const auto samples = probe_mesh(query, tool, tool_down({0, 0, radius}), 0.02, 0.03);
  return samples.front().hit ? samples.front().point_G.z() : std::nan("");
}

// Does a bellows cup of 20 mm, a little off the pole, seal on the sphere and carry it?
bool carries_sphere(const Part& sphere, double radius, const Gripper& tool, Rng& rng) {
  const double aside = rng.uniform(0, 0.05 * radius), angle = rng.uniform(0, 2 * std::numbers::pi);
  LiftSetting setting;
  setting.press = 0.003;
  LiftBench bench(sphere, Pose(Eigen::Translation3d(0, 0, -radius)), tool,
                  tool_down({aside * std::cos(angle), aside * std::sin(angle), 0}), setting);
  bench.press();
  if (!bench.seal().sealed) return false;
  bench.evacuate();
  bench.raise(0.05);
  bench.wait(0.3);
  return bench.holds_all();
}

void spheres(SuctionBench& bench) {
  const auto tool = suction_tool("cups: [{radius: 10 mm, effective_area_ratio: 0.8, lip_compliance: 0.8 mm}]\n");
  for (const double radius : {0.050, 0.012}) {
    const std::string what = "sphere of radius " + std::to_string(std::lround(1e3 * radius)) + " mm";
    const Part sphere = sphere_part(radius, 0.2);
    const double sag = radius - std::sqrt(radius * radius - 0.010 * 0.010);
    bench.verdicts().push_back(
        {"V-B5", what + ": sag of a 20 mm rim, by rays", seen_sag(sphere, *tool, radius), sag, 0.02 * sag, "m"});
    std::size_t carried = 0;
    bench.each("sphere", [&](Rng& rng) { return carries_sphere(sphere, radius, *tool, rng) ? ++carried, 1.0 : 0.0; });
    bench.share_line({"V-B5", what + ": share sealed and carried", 0, radius > 0.02 ? 1.0 : 0.0, 0, "1"}, carried,
                     static_cast<std::size_t>(bench.draws()));
  }
}

}  // namespace

void check_curvature(SuctionBench& bench) { spheres(bench); }

void check_ring_edge(SuctionBench& bench) {
  constexpr int kPlaces = 100;  // per draw
  const Part ring = ring_part(kInner, kOuter, kHeight, kAluminium);
  const MeshQuery query(ring.mesh_P);
  std::size_t crossing = 0, crossing_sealed = 0, inside = 0, inside_sealed = 0;
  bench.each("ring edge", [&](Rng& rng) {
    for (int i = 0; i < kPlaces; ++i) {
      const double r = rng.uniform(0.003, 0.007), angle = rng.uniform(0, 2 * std::numbers::pi);
      const auto tool = suction_tool("cups: [{radius: " + std::to_string(r) + "}]\n");
      // First a rim that crosses the bore's edge by at least 0.1 mm at its innermost point, then one on the land.
      const double crossed = kInner + rng.uniform(-r + 1e-4, r - 1e-4);
      const double landed = rng.uniform(kInner + r + 1e-4, kOuter - r - 1e-4);
      const auto seals = [&](double rho) {
        const Pose X_PG = tool_down({rho * std::cos(angle), rho * std::sin(angle), kHeight / 2});
        return tool->judge(probe_mesh(query, *tool, X_PG, 0.02, 0.03)).sealed;
      };
      ++crossing, crossing_sealed += seals(crossed) ? 1 : 0;
      ++inside, inside_sealed += seals(landed) ? 1 : 0;
    }
    return 0.0;
  });
  bench.share_line({"V-B5", "ring 70/100: share sealed, rim across the bore's edge", 0, 0, 0, "1"}, crossing_sealed,
                   crossing);
  bench.share_line({"V-B5", "ring 70/100: share sealed, rim on the land", 0, 1, 0, "1"}, inside_sealed, inside);
}

}  // namespace binpick

// V-E4: what must not depend on how the world is set up, and how bodies lie once they rest.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/error.hpp"
#include "tools/validate/physics_bench.hpp"

namespace binpick {
namespace {

constexpr double kRatio = 0.47, kCube = 0.02;  // x/y of the cuboid, m: edge of the cube with its volume
constexpr double kFaceAngle = 0.0174532925;    // rad, 1 degree
constexpr double kHeight = 0.2e-3;             // m
constexpr int kThrows = 2000, kPartThrows = 200;

Eigen::Vector3d edges(double scale) {
  const double y = kCube / std::cbrt(kRatio);
  return scale * Eigen::Vector3d(kRatio * y, y, y);
}

std::size_t on_square_end(const std::vector<Rest>& rests) {
  return static_cast<std::size_t>(std::count_if(
      rests.begin(), rests.end(), [](const Rest& rest) { return std::abs(rest.X_WP.linear()(2, 0)) > 0.70710678; }));
}

/// The cuboid as a primitive box, and as eight boxes that fill it.
Solid as_box(Solid solid) {
  solid.shape.pieces_P.clear();
  solid.shape.solids_P = {Primitive::box(edges(1))};
  return solid;
}

Solid as_pieces(Solid solid) {
  solid.shape.pieces_P.clear();
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    const Pose middle(Eigen::Translation3d(sign.cwiseProduct(edges(0.25))));
    solid.shape.pieces_P.push_back(mesh_of(Primitive::box(edges(0.5), middle)));
  }
  return solid;
}

class Shares {
 public:
  explicit Shares(PhysicsBench& bench) : bench_(bench), total_(bench.count(kThrows)) {}

  double of(const char* what, const Solid& solid, const ThrowSetting& setting) {
    const std::vector<Rest> rests = bench_.throws(what, total_, solid, setting);
    bench_.note(rests);
    return static_cast<double>(on_square_end(rests)) / total_;
  }

  /// A line for p - reference, both of as many throws.
  void compare(const std::string& what, double p, double reference) {
    const double error = std::hypot(share_error(p, total_), share_error(reference, total_));
    Verdict line{"V-E4", "cuboid 0.47: P(square end), " + what, p - reference, 0, 3 * error, "1"};
    line.samples = total_;
    line.low = line.value - 1.96 * error, line.high = line.value + 1.96 * error;
    bench_.add(line);
  }

 private:
  PhysicsBench& bench_;
  int total_;
};

PhysicsConfig fixed_step(PhysicsConfig physics, double step) {
  physics.fine_step = physics.coarse_step = step;
  return physics;
}

/// Rests on a face, and heights of those.
void add_rest_lines(PhysicsBench& bench, const std::string& what, const std::vector<Rest>& rests) {
  std::size_t settled = 0, flat = 0;
  double highest = -1, deepest = -1;
  for (const Rest& rest : rests) {
    if (!rest.at_rest) continue;
    ++settled;
    if (rest.tilt > kFaceAngle) continue;
    ++flat;
    highest = std::max(highest, rest.gap), deepest = std::max(deepest, -rest.gap);
  }
  bench.add(
      share_line({"V-E4", what + ": share at rest", 0, 1, 0, "1", Verdict::Rule::kReport}, settled, rests.size()));
  bench.add(share_line({"V-E4", what + ": of these within 1 deg of a face", 0, 1, 0, "1"}, flat, settled));
  const double off = std::max(highest, deepest);
  bench.add({"V-E4", what + ": largest error of the height on a face", flat > 0 ? off : std::nan(""), kHeight, 0, "m",
             Verdict::Rule::kBelow});
}

std::vector<std::string> part_files(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string file = entry.path().string() + "/part.yaml";
    if (std::filesystem::exists(file)) files.push_back(file);
  }
  if (files.empty()) throw SpecError(folder + ": no parts there; run in the project's folder");
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

void check_invariance(PhysicsBench& bench) {
  const PhysicsSetting& setting = bench.setting();
  const PhysicsConfig& physics = setting.physics;
  const Solid hull = finished(cuboid_part(edges(1)), setting);
  Shares shares(bench);
  const ThrowSetting toss = thrown(physics);
  const double ours = shares.of("hull", hull, toss);
  const double half = shares.of("1/500 s", hull, thrown(fixed_step(physics, 1.0 / 500)));
  const double full = shares.of("1/1000 s", hull, thrown(fixed_step(physics, 1.0 / 1000)));
  shares.compare("step 1/500 s minus 1/1000 s", half, full);
  shares.compare("the World's own step minus 1/1000 s", ours, full);
  const double box = shares.of("box", as_box(hull), toss), pieces = shares.of("pieces", as_pieces(hull), toss);
  shares.compare("box minus hull of 8 corners", box, ours);
  shares.compare("eight pieces minus one hull", pieces, ours);
  // Another unit of length: the sleeping speeds and the speed below which nothing bounces are no lengths of the
  // setting, so the quasi-static throw (no bounce) is compared.
  ThrowSetting tenfold = laid_down(scaled(physics, 10));
  tenfold.scale = 10;
  const double one = shares.of("laid down", hull, laid_down(physics));
  const double ten = shares.of("laid down, tenfold", finished(cuboid_part(edges(10)), setting), tenfold);
  shares.compare("laid down, all lengths tenfold", ten, one);
}

void check_rest(PhysicsBench& bench) {
  add_rest_lines(bench, "cuboids and cylinders", bench.noted());
  for (const std::string& file : part_files(bench.setting().parts)) {
    Solid solid{load_part(read_part_spec(file)), {}};
    solid.shape = bench.setting().shape(solid.part);
    ThrowSetting toss = thrown(bench.setting().physics);
    toss.friction = solid.part.friction, toss.restitution = solid.part.restitution;
    const std::string& name = solid.part.name;
    add_rest_lines(bench, name, bench.throws(name.c_str(), bench.count(kPartThrows), solid, toss));
  }
}

}  // namespace binpick

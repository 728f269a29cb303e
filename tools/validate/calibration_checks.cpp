// V-D1..V-D4. Every draw is a calibration of its own; a root mean square of n draws is known to about 1 / sqrt(2 n).

#include <cmath>
#include <numbers>

#include "tools/validate/calibration_bench.hpp"

namespace binpick {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kCorner = 0.2;  // px

/// A row of the reference's table: standard deviations for corner noise of 0.2 px, and half a digit of their print.
struct Target {
  const char* name;
  MarkerPlate plate;
  double range, tilt, focal;                  // m, rad, px
  double xy, z, out_of_plane, in_plane;       // m, m, rad, rad
  double half_xy, half_z, half_out, half_in;  // rounding
};

std::vector<Target> targets() {
  const MarkerPlate one{1, 0.050, 0}, four{2, 0.040, 0.120};
  const double mm = 1e-3, d = kDegree, h = 0.005;
  return {{"one marker of 50 mm, 0.5 m, frontal", one, 0.5, 0, 920, .08 * mm, .77 * mm, 2.5 * d, .09 * d, h * mm,
           h * mm, .05 * d, h * d},
          {"one marker of 50 mm, 0.5 m, 30 deg", one, 0.5, 30 * d, 920, .06 * mm, 1.07 * mm, .33 * d, .13 * d, h * mm,
           h * mm, h * d, h * d},
          {"four of 40 mm, 0.5 m, frontal", four, 0.5, 0, 920, .04 * mm, .15 * mm, .17 * d, .02 * d, h * mm, h * mm,
           h * d, h * d},
          {"four of 40 mm, 1 m, frontal", four, 1, 0, 920, .07 * mm, .61 * mm, .67 * d, .04 * d, h * mm, h * mm, h * d,
           h * d},
          {"four of 40 mm, 1 m, 30 deg", four, 1, 30 * d, 920, .06 * mm, .84 * mm, .13 * d, .05 * d, h * mm, h * mm,
           h * d, h * d},
          {"four of 40 mm, 1 m, frontal, f 1380", four, 1, 0, 1380, .05 * mm, .41 * mm, .45 * d, .02 * d, h * mm,
           h * mm, h * d, h * d}};
}

struct PoseSpread {
  double xy = 0, z = 0, out_of_plane = 0, in_plane = 0;
};

/// About the true pose, refined from it: the two-fold ambiguity of a frontal plate is another matter.
PoseSpread pose_spread(const Target& target, std::uint64_t first, int draws, double noise) {
  const PinholeCamera camera{1280, 960, target.focal, target.focal, 639.5, 479.5};
  const Pose X_CQ =
      pose_from(Eigen::AngleAxisd(std::numbers::pi - target.tilt, Eigen::Vector3d::UnitX()).toRotationMatrix(),
                {0, 0, target.range});
  const std::vector<SeenCorner> exact = projected_corners(target.plate, X_CQ, camera);
  Eigen::Vector3d shifts = Eigen::Vector3d::Zero(), turns = Eigen::Vector3d::Zero();  // squares
  for (int k = 0; k < draws; ++k) {
    Rng rng = Seed{first + static_cast<std::uint64_t>(k)}.child("plate pose").rng();
    std::vector<SeenCorner> noisy = exact;
    for (SeenCorner& corner : noisy)
      for (int axis = 0; axis < 2; ++axis) corner.pixel[axis] += noise * rng.normal();
    const Pose found = refined_plate_pose(noisy, target.plate, camera, {}, X_CQ);
    shifts += (found.translation() - X_CQ.translation()).cwiseAbs2() / draws;
    turns += log_so3(X_CQ.linear().transpose() * found.linear()).cwiseAbs2() / draws;
  }
  return {std::sqrt((shifts.x() + shifts.y()) / 2), std::sqrt(shifts.z()), std::sqrt((turns.x() + turns.y()) / 2),
          std::sqrt(turns.z())};
}

Verdict line(const char* id, const std::string& what, double value, double expected, double tolerance, const char* unit,
             int samples) {
  Verdict v;
  v.id = id, v.what = what, v.value = value, v.expected = expected, v.tolerance = tolerance, v.unit = unit;
  v.samples = samples;
  const double error = 1.96 * value / std::sqrt(2.0 * samples);
  v.low = value - error, v.high = value + error;
  return v;
}

Verdict report(Verdict v) {
  v.rule = Verdict::Rule::kReport;
  return v;
}

}  // namespace

void check_plate_pose(CalibrationBench& bench) {
  constexpr double kAgree = 0.15;
  constexpr double kSmaller = 10;  // the table is linear in the noise; at 0.2 px itself a frontal tilt is not small
  const int draws = 5 * bench.draws();
  for (const Target& t : targets()) {
    const PoseSpread s = pose_spread(t, bench.first(), draws, kCorner / kSmaller);
    // A short form knows each spread less well: three standard errors more.
    const double share = kAgree + (bench.draws() < CalibrationBench::kFullDraws ? 3 / std::sqrt(2.0 * draws) : 0);
    const auto add = [&](const char* what, double value, double expected, double half, const char* unit) {
      bench.verdicts().push_back(
          line("V-D1", std::string(t.name) + ": " + what, value, expected, share * expected + half, unit, draws));
    };
    add("sideways", kSmaller * s.xy, t.xy, t.half_xy, "m");
    add("depth", kSmaller * s.z, t.z, t.half_z, "m");
    add("tilt", kSmaller * s.out_of_plane, t.out_of_plane, t.half_out, "rad");
    add("in-plane turn", kSmaller * s.in_plane, t.in_plane, t.half_in, "rad");
    const PoseSpread whole = pose_spread(t, bench.first(), draws, kCorner);
    bench.verdicts().push_back(
        report(line("V-D1", std::string(t.name) + ": depth, noise not small", whole.z, 0, 0, "m", draws)));
  }
}

void check_chain(CalibrationBench& bench) {
  const CalibrationErrors full;
  for (const CalibrationMethod method : kCalibrationMethods) {
    const CalibrationError exact = calibration_error(bench.setup(), no_errors(), method, Seed{bench.first()});
    bench.verdicts().push_back(
        line("V-D2", to_string(method) + ", no errors: shift of the camera", exact.shift, 0, 1e-9, "m", 1));
  }
  const double share = 0.2 + (bench.draws() < CalibrationBench::kFullDraws ? 3 / std::sqrt(2.0 * bench.draws()) : 0);
  for (const ErrorSource source : kErrorSources) {
    if (source == ErrorSource::kDepthBias) continue;  // not in the calibration
    const CalibrationErrors one = only(full, source);
    const CalibrationSpread s = bench.spread(one, CalibrationMethod::kChain);
    const PredictedError p = predicted_error(bench.setup(), one, CalibrationMethod::kChain);
    const std::string what = "chain, " + to_string(source) + " alone: ";
    bench.verdicts().push_back(line("V-D2", what + "shift", s.shift, p.shift, share * p.shift, "m", bench.draws()));
    if (p.turn > 1e-6)  // a shift alone turns nothing
      bench.verdicts().push_back(line("V-D2", what + "turn", s.turn, p.turn, share * p.turn, "rad", bench.draws()));
  }
}

void report_pick_error(CalibrationBench& bench) {
  const CalibrationErrors full;
  const CalibrationSpread all = bench.spread(full, CalibrationMethod::kChain);
  bench.verdicts().push_back(
      report(line("V-D3", "chain, all errors: tip at the part", all.tip, 0, 0, "m", bench.draws())));
  bench.verdicts().push_back(
      report(line("V-D3", "chain, all errors: turn of the tip", all.tip_turn, 0, 0, "rad", bench.draws())));
  for (const ErrorSource source : kErrorSources) {
    const double tip = bench.spread(only(full, source), CalibrationMethod::kChain).tip;
    bench.verdicts().push_back(report(line("V-D3", "share of the tip's squared error: " + to_string(source),
                                           tip * tip / (all.tip * all.tip), 0, 0, "1", bench.draws())));
  }
}

void check_hand_eye(CalibrationBench& bench) {
  const CalibrationErrors corners = only({}, ErrorSource::kCorners);
  const std::vector<Vector6d>& all_looks = bench.setup().q_hand_eye;
  for (const CalibrationMethod method : {CalibrationMethod::kPark, CalibrationMethod::kHoraud}) {
    const CalibrationSpread s = bench.spread(corners, method);
    Verdict shift = line("V-D4", to_string(method) + ", 15 poses, 0.2 px: shift", s.shift, 2e-3, 0, "m", bench.draws());
    Verdict turn =
        line("V-D4", to_string(method) + ", 15 poses, 0.2 px: turn", s.turn, 0.5 * kDegree, 0, "rad", bench.draws());
    shift.rule = turn.rule = Verdict::Rule::kBelow;
    bench.verdicts().push_back(shift);
    bench.verdicts().push_back(turn);
  }
  // More looks at the same places: what is left falls with the square root of their number.
  CalibrationSetup four_times = bench.setup();
  for (int k = 0; k < 3; ++k)
    four_times.q_hand_eye.insert(four_times.q_hand_eye.end(), all_looks.begin(), all_looks.end());
  double once = 0, often = 0;
  for (int k = 0; k < bench.draws(); ++k) {
    const Seed seed{bench.first() + static_cast<std::uint64_t>(k)};
    once += std::pow(calibration_error(bench.setup(), corners, CalibrationMethod::kPark, seed).turn, 2);
    often += std::pow(calibration_error(four_times, corners, CalibrationMethod::kPark, seed).turn, 2);
  }
  const double widened = bench.draws() < CalibrationBench::kFullDraws ? 3 / std::sqrt(1.0 * bench.draws()) : 0.1;
  bench.verdicts().push_back(line("V-D4", "park: turn of 15 looks over that of four times as many",
                                  std::sqrt(once / often), 2, 2 * widened, "1", bench.draws()));
}

}  // namespace binpick

// A part on a slab, a suction tool that comes down on it, seals by rays on the part's mesh and moves away: what the
// checks V-B1..V-B5 and the table of cups share. World: z up, the part's contact plane at z = 0; the tool points down.
// Loads are read from the coupling's own reaction in the physics world (sim/hold.hpp).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/part.hpp"
#include "core/random.hpp"
#include "robot/gripper.hpp"
#include "sim/hold.hpp"
#include "tools/validate/verdict.hpp"

namespace binpick {

/// The gripper `suction` with the keys of `yaml` set.
std::unique_ptr<Gripper> suction_tool(const std::string& yaml);

/// Bodies known on paper; frame in the middle of their box.
Part plate_part(double mass, double side, double thickness);
Part sphere_part(double radius, double mass);
Part ring_part(double inner, double outer, double height, double density);

struct LiftSetting {
  double step = 1.0 / 500;  ///< s
  double gravity = 9.81;    ///< m/s^2
  double press = 0.001;     ///< m, how far the plungers are pushed in
  HoldConfig hold;
};

/// Largest reaction of any one cup while it held.
struct CupPeaks {
  double pull = 0, shear = 0, moment = 0, torsion = 0;
};

class LiftBench {
 public:
  /// `X_WG`: the tool at contact. The part's frame stands at `X_WP`, on a slab that just touches it.
  LiftBench(const Part& part, const Pose& X_WP, const Gripper& tool, const Pose& X_WG, const LiftSetting& setting);
  ~LiftBench();

  /// Down onto the part, from 2 mm above contact.
  void press();
  /// The gripper's verdict on the part's mesh under the pressed cups; the cups that seal take hold.
  Contact seal();
  /// Stands still until the vacuum is there (nine time constants).
  void evacuate();
  /// Straight up at a slow, even speed.
  void raise(double height);
  /// Moves along `direction` with acceleration(t) for `duration`, or until a cup lets go. Returns the acceleration that
  /// was there `break_time` before the end: the one that broke the hold.
  double accelerate(const Eigen::Vector3d& direction, const std::function<double(double)>& acceleration,
                    double duration);
  void wait(double duration);

  bool holds_all() const;  ///< every cup that sealed still holds
  const std::vector<CupState>& cups() const { return hold_->cups(); }
  const CupPeaks& peaks() const { return peaks_; }
  void forget_peaks() { peaks_ = {}; }
  /// Mass centre over the lip centre, in the lip's plane (m).
  double lever(std::size_t cup) const;

 private:
  void step_to(const Eigen::Vector3d& shift_W);

  const Part& part_;
  const Gripper& tool_;
  Pose X_WG_;
  LiftSetting setting_;
  World world_;
  BodyId body_ = -1, tool_body_ = -1;
  std::unique_ptr<CupHold> hold_;
  std::vector<bool> sealed_;
  Eigen::Vector3d shift_W_ = Eigen::Vector3d::Zero();  ///< of the tool from contact
  CupPeaks peaks_;
};

/// Tool straight down at p_W.
Pose tool_down(const Eigen::Vector3d& p_W);

class SuctionBench {
 public:
  static constexpr int kFullDraws = 20;

  SuctionBench(std::uint64_t first_seed, int draws) : first_(first_seed), draws_(draws) {}
  int draws() const { return draws_; }
  Rng rng(const char* check, std::size_t draw) const { return Seed{first_ + draw}.child(check).rng(); }
  /// `measure` of every draw.
  std::vector<double> each(const char* check, const std::function<double(Rng&)>& measure) const;

  /// A line for the mean of draws, with its Student interval.
  void mean_line(Verdict line, const std::vector<double>& values);
  /// A line for a share, with its Wilson interval.
  void share_line(Verdict line, std::size_t hits, std::size_t total);
  std::vector<Verdict>& verdicts() { return verdicts_; }

 private:
  std::uint64_t first_;
  int draws_;
  std::vector<Verdict> verdicts_;
};

/// Load at which a cup comes off a plate, the acceleration ramped up to it in `ramp` seconds; NaN when it stays on.
struct PullOff {
  double load = 0;     ///< N, m (g + a)
  double reading = 0;  ///< N, the coupling's largest own pull
};
PullOff measure_pull_off(double diameter, double vacuum, double mass, double ramp);
/// Load (N) that peels a 20 mm cup at 60 kPa, `off` (m) beside the plate's middle.
double measure_peel(double off, double mass, double ramp);

// The checks, each appending its lines.
void check_pull_off(SuctionBench& bench);   ///< V-B1
void check_slip(SuctionBench& bench);       ///< V-B2
void check_lift(SuctionBench& bench);       ///< V-B3
void check_lever_arm(SuctionBench& bench);  ///< V-B4
void check_curvature(SuctionBench& bench);  ///< V-B5
void check_ring_edge(SuctionBench& bench);  ///< V-B5

/// The measured loads beside theory, over cup diameter and lever arm. False when gnuplot is not installed.
bool plot_suction(const std::string& folder);

}  // namespace binpick

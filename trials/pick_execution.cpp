#include "trials/pick_execution.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/error.hpp"
#include "sim/drop.hpp"
#include "trials/arm_run.hpp"
#include "trials/oracle_stages.hpp"

namespace binpick {
namespace {

constexpr double kDwell = 0.02;             // s at contact before the seal is judged: plungers come to rest
constexpr double kVenting = 0.05;           // s from release until the tool leaves
constexpr double kNeighbourMotion = 0.005;  // m
constexpr double kDragged = 0.010;          // m
constexpr double kAtRest = 0.02;            // m/s

const char* name_of(HoldLimit limit) {
  switch (limit) {
    case HoldLimit::kPull:
      return "pull";
    case HoldLimit::kShear:
      return "shear";
    case HoldLimit::kMoment:
      return "moment (peel)";
    case HoldLimit::kTorsion:
      return "torsion";
  }
  return "";
}

/// One execution: the state that its phases share.
class Execution {
 public:
  Execution(CellWorld& cell_world, const PickPlan& plan, const ExecutionConfig& config, const ExecutionHook& hook)
      : cell_(cell_world),
        world_(cell_world.world()),
        hold_(cell_world.hold()),
        plan_(plan),
        config_(config),
        hook_(hook),
        arm_(cell_world, config) {
    HoldConfig hold_config;
    hold_config.break_time = config.ideal_seal ? std::numeric_limits<double>::infinity() : config.break_time;
    cell_.set_hold_config(hold_config);
    for (std::size_t i = 0; i < cell_.heap().bodies.size(); ++i) {
      start_centres_.push_back(cell_.box_center(i));
      start_in_bin_.push_back(cell_.in_bin(i));
    }
  }

  ExecutionResult run() {
    const Vector6d& q_start = plan_.approach.q.front();
    if ((q_start - cell_.joints()).cwiseAbs().maxCoeff() > 1e-6) cell_.jump_to(q_start);
    world_.freeze_sleeping();
    if (approach() && seal() && lift()) {
      place();
      if (!finished_) judge_place();
    }
    come_to_rest();
    count_neighbours();
    result_.vacuum_time = arm_.vacuum_time();
    result_.peak_force = arm_.peak_force();
    result_.swing = arm_.swing();
    result_.hold_use = arm_.hold_use();
    const CellWorld::Touch& contacts = arm_.contacts();
    result_.contact_force = contacts.force;
    result_.contact_depth = contacts.depth;
    result_.collisions = arm_.collisions();
    result_.collision_depth = arm_.collision_depth();
    result_.contact = contacts.force > 0 ? contacts.pushed : contacts.entered;
    return result_;
  }

 private:
  void end(PickOutcome outcome, const std::string& reason) {
    if (finished_) return;  // the first that happens wins
    finished_ = true;
    result_.outcome = outcome;
    result_.reason = reason;
  }

  bool approach() {
    if (arm_.follow(plan_.approach, ArmRun::Watch::kCollisions)) return true;
    end(arm_.blocked()->outcome, "approach: " + arm_.blocked()->reason);
    arm_.retreat(plan_.approach);
    return false;
  }

  /// Asks the gripper about the true surfaces, couples the cups that seal and waits for the vacuum.
  bool seal() {
    arm_.wait(kDwell, true);
    const std::vector<SurfaceSample> samples = cell_.probe_cups();
    Contact contact = cell_.cell().gripper->judge(samples);
    if (config_.ideal_seal) seal_what_touches(cell_, samples, contact);
    if (plan_.site.cup >= 0) contact.sealed = contact.cup_sealed[static_cast<std::size_t>(plan_.site.cup)];
    if (contact.sealed) {
      attach(contact, samples);
      if (build_vacuum()) {
        if (hook_) hook_("held", cell_);
        return true;
      }
    }
    end(PickOutcome::kNoSeal, contact.sealed ? "the vacuum did not build up" : seal_report(contact));
    result_.lifted.reset();
    hold_.release_all();
    arm_.retreat(plan_.approach);
    return false;
  }

  static std::string seal_report(const Contact& contact) {
    std::string report;
    for (std::size_t c = 0; c < contact.why.size(); ++c)
      report +=
          (c ? ", cup " : "cup ") + std::to_string(c) + ": " + (contact.why[c].empty() ? "sealed" : contact.why[c]);
    return report;
  }

  /// Sealed cups take hold; the part that most of them hold is the one that is lifted.
  void attach(const Contact& contact, const std::vector<SurfaceSample>& samples) {
    const std::size_t each = samples.size() / contact.cup_sealed.size();
    std::map<BodyId, int> holds;
    int most = 0;
    for (std::size_t c = 0; c < contact.cup_sealed.size(); ++c) {
      if (!contact.cup_sealed[c]) continue;
      const BodyId body = samples[c * each].body;
      hold_.attach(c, body, contact.cup_vacuum[c]);
      if (++holds[body] > most) most = holds[body], held_body_ = body;
    }
    result_.lifted = cell_.heap_index_of(held_body_);
    arm_.watch_held(held_body_);
  }

  bool build_vacuum() {
    for (double t = 0; t < config_.vacuum_timeout; t += config_.step) {
      arm_.wait(config_.step, true);
      if (!hold_.holds_any()) return false;
      const auto ready = [&](const CupState& cup) { return !cup.part || cup.vacuum_share >= config_.vacuum_share; };
      if (std::all_of(hold_.cups().begin(), hold_.cups().end(), ready)) return true;
    }
    return false;
  }

  bool lift() {
    if (!arm_.follow(plan_.lift, ArmRun::Watch::kHold)) {
      if (arm_.blocked()) end(arm_.blocked()->outcome, "lift: " + arm_.blocked()->reason);
      const HoldLimit limit = last_break();
      const bool sheared = limit == HoldLimit::kShear || limit == HoldLimit::kTorsion;
      end(sheared ? PickOutcome::kSlipped : PickOutcome::kPulledOff, std::string("lift: ") + name_of(limit));
      hold_.release_all();
      arm_.finish(plan_.lift);
      go_back();
      return false;
    }
    for (std::size_t i = 0; i < start_centres_.size(); ++i)
      if (came_along(i)) end(PickOutcome::kDoublePick, "part " + std::to_string(i) + " came out with it");
    if (hook_) hook_("lifted", cell_);
    return true;
  }

  HoldLimit last_break() const {
    for (const CupState& cup : hold_.cups())
      if (cup.broken_by) return *cup.broken_by;
    return HoldLimit::kPull;
  }

  bool came_along(std::size_t i) const {
    if (i == result_.lifted || !start_in_bin_[i]) return false;
    const Eigen::Vector3d centre = cell_.box_center(i);
    const double over_rim = (cell_.cell().X_WB.inverse() * centre).z() - cell_.cell().bin.inner_size.z();
    return over_rim > 0 && (centre - start_centres_[i]).norm() > kNeighbourMotion;
  }

  void place() {
    if (arm_.follow(plan_.place, ArmRun::Watch::kHold)) {
      if (hook_) hook_("released", cell_);
      hold_.release_all();
      arm_.wait(kVenting, true);
    } else {
      if (arm_.blocked()) end(arm_.blocked()->outcome, "transit: " + arm_.blocked()->reason);
      lost_by_ = last_break();
      hold_.release_all();
      arm_.finish(plan_.place);
    }
    const double before = arm_.motion_time();
    arm_.follow(plan_.back, ArmRun::Watch::kNothing);
    arm_.wait(std::max(0.0, config_.settle_time - kVenting - (arm_.motion_time() - before)), false);
  }

  /// From above the bin straight to the end of the cycle.
  void go_back() {
    const Vector6d& q_end = plan_.back.q.back();
    arm_.follow(joint_move(*cell_.cell().arm, cell_.joints(), q_end, cell_.cell().motion), ArmRun::Watch::kNothing);
  }

  void judge_place() {
    const std::size_t i = *result_.lifted;
    if (lost_by_) {
      const bool back_in_bin = cell_.in_bin(i);
      return end(back_in_bin ? PickOutcome::kDroppedInBin : PickOutcome::kLostInTransit,
                 std::string("transit: ") + name_of(*lost_by_));
    }
    if (!cell_.in_tray(i)) return end(PickOutcome::kWrongPlace, "the part does not lie in the tray");
    if (world_.velocity(held_body_).norm() > kAtRest) return end(PickOutcome::kWrongPlace, "the part still moves");
    const Part& part = cell_.part_of(i);
    const Pose X_WP = nearest_equivalent(cell_.part_pose(i), plan_.X_WP_place, part.symmetry);
    const Eigen::Vector3d wanted = plan_.X_WP_place * part.box_center_P;
    result_.place_error = (cell_.box_center(i) - wanted).head<2>().norm();
    result_.place_rotation = angle_between(X_WP.linear(), plan_.X_WP_place.linear());
  }

  /// The heap rests before the next look, and then stays as it is until something touches it.
  void come_to_rest() {
    hold_.release_all();
    SettleConfig rest;
    rest.time_limit = 3;
    double waited = 0;
    settle(world_, rest, &waited);
    result_.motion_time = arm_.motion_time() + waited;
    for (const BodyId body : cell_.heap().bodies) world_.put_to_sleep(body);
    world_.end_freezing();
  }

  void count_neighbours() {
    for (std::size_t i = 0; i < start_centres_.size(); ++i) {
      if (i == result_.lifted || !start_in_bin_[i]) continue;
      const bool moved = (cell_.box_center(i) - start_centres_[i]).norm() > kNeighbourMotion;
      const bool dragged = result_.lifted && arm_.rise(i) > kDragged, in_bin = cell_.in_bin(i);
      result_.neighbours_moved += moved ? 1 : 0;
      result_.neighbours_dragged += dragged ? 1 : 0;
      result_.parts_dropped_back += dragged && in_bin ? 1 : 0;
      result_.parts_lost += !in_bin && !cell_.in_tray(i) ? 1 : 0;
    }
  }

  CellWorld& cell_;
  World& world_;
  CupHold& hold_;
  const PickPlan& plan_;
  const ExecutionConfig& config_;
  const ExecutionHook& hook_;
  ArmRun arm_;
  ExecutionResult result_;
  bool finished_ = false;
  std::optional<HoldLimit> lost_by_;  ///< on the way to the tray
  BodyId held_body_ = -1;
  std::vector<Eigen::Vector3d> start_centres_;
  std::vector<bool> start_in_bin_;
};

}  // namespace

void ExecutionConfig::visit(ConfigVisitor& v) {
  v.field("step", step, Unit::kTime, "step of the world while the arm moves");
  v.field("protective_force", protective_force, Unit::kForce,
          "arm, tool, held part or a plunger at its end: stop beyond");
  v.field("break_time", break_time, Unit::kTime, "how long a limit of a cup must be exceeded to break its hold");
  v.field("vacuum_share", vacuum_share, Unit::kNone, "the lift starts at this share of the full vacuum");
  v.field("vacuum_timeout", vacuum_timeout, Unit::kTime, "longest wait for it");
  v.field("settle_time", settle_time, Unit::kTime, "time after release until the part must rest in the tray");
}

void ExecutionConfig::validate() const {
  const auto require = [](bool good, const char* message) {
    if (!good) throw SpecError(std::string("execution.") + message);
  };
  require(step >= 1e-4 && step <= 1.0 / 200, "step: must lie between 0.1 and 5 ms");
  require(protective_force > 0, "protective_force: must be above 0");
  require(break_time >= 0 && break_time <= 1, "break_time: must lie between 0 and 1 s");
  require(vacuum_share > 0 && vacuum_share < 1, "vacuum_share: must lie between 0 and 1");
  require(vacuum_timeout > 0 && vacuum_timeout <= 60, "vacuum_timeout: must lie between 0 and 60 s");
  require(settle_time >= 0 && settle_time <= 60, "settle_time: must lie between 0 and 60 s");
}

ExecutionResult execute_pick(CellWorld& cell_world, const PickPlan& plan, const ExecutionConfig& config,
                             const ExecutionHook& hook) {
  return Execution(cell_world, plan, config, hook).run();
}

}  // namespace binpick

#include "trials/pick_execution.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/error.hpp"
#include "sim/drop.hpp"

namespace binpick {
namespace {

constexpr double kDwell = 0.02;             // s at contact before the seal is judged: plungers come to rest
constexpr double kVenting = 0.05;           // s from release until the tool leaves
constexpr double kAllowedDepth = 0.002;     // m, arm or tool in something fixed
constexpr double kNeighbourMotion = 0.005;  // m
constexpr double kAtRest = 0.02;            // m/s

JointTrajectory reversed(const JointTrajectory& path) {
  JointTrajectory back;
  for (std::size_t i = path.q.size(); i-- > 0;) {
    back.times.push_back(path.times.back() - path.times[i]);
    back.q.push_back(path.q[i]);
  }
  return back;
}

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
        hook_(hook) {
    HoldConfig hold_config;
    hold_config.break_time = config.break_time;
    cell_.set_hold_config(hold_config);
    for (std::size_t i = 0; i < cell_.heap().bodies.size(); ++i) {
      start_centres_.push_back(cell_.box_center(i));
      start_in_bin_.push_back(cell_.in_bin(i));
    }
  }

  ExecutionResult run() {
    const Vector6d& q_start = plan_.approach.q.front();
    if ((q_start - cell_.joints()).cwiseAbs().maxCoeff() > 1e-6) cell_.jump_to(q_start);
    if (approach() && seal()) {
      lift();
      if (hold_.holds_any()) place();
      if (!finished_) judge_place();
    }
    come_to_rest();
    count_neighbours();
    return result_;
  }

 private:
  enum class Watch { kNothing, kCollisions, kHold };

  void end(PickOutcome outcome, const std::string& reason) {
    if (finished_) return;  // the first that happens wins
    finished_ = true;
    result_.outcome = outcome;
    result_.reason = reason;
  }

  void step(const Vector6d& q) {
    cell_.set_joints(q);
    hold_.step(config_.step);
    for (const CupState& cup : hold_.cups())
      result_.peak_force = std::max({result_.peak_force, std::hypot(cup.pull, cup.shear), cup.press});
    if (result_.lifted && hold_.holds_any()) {
      const Eigen::Matrix3d R_GP = world_.pose(cell_.tool_body).linear().transpose() * held_pose().linear();
      result_.swing = std::max(result_.swing, angle_between(R_GP_attached_, R_GP));
    }
  }

  /// Runs a path; stops early (false) when what is watched happens.
  bool follow(const JointTrajectory& path, Watch watch) {
    const int steps = static_cast<int>(std::ceil(path.duration() / config_.step - 1e-9));
    for (int i = 1; i <= steps; ++i) {
      const double t = std::min(i * config_.step, path.duration());
      step(path.sample(t));
      result_.motion_time += config_.step;
      if (watch != Watch::kNothing && blocked()) {
        reached_ = t;
        return false;
      }
      if (watch == Watch::kHold && !hold_.holds_any()) {
        reached_ = t;
        return false;
      }
    }
    return true;
  }

  void wait(double duration, double& account) {
    for (double t = 0; t < duration; t += config_.step) {
      step(cell_.joints());
      account += config_.step;
    }
  }

  bool blocked() {
    const CellWorld::Touch touch = cell_.arm_contact();
    result_.peak_force = std::max(result_.peak_force, touch.force);
    if (touch.force > config_.protective_force || touch.depth > kAllowedDepth) {
      end(PickOutcome::kPathBlocked, touch.what);
      return true;
    }
    for (const CupState& cup : hold_.cups()) {
      if (cup.part || cup.press <= config_.protective_force) continue;
      end(PickOutcome::kProtectiveStop, "a plunger at its end pressed on something");
      return true;
    }
    return false;
  }

  bool approach() {
    if (follow(plan_.approach, Watch::kCollisions)) return true;
    retreat(plan_.approach, reached_);
    return false;
  }

  /// Back along what was travelled of a path, to where it began.
  void retreat(const JointTrajectory& path, double travelled) {
    JointTrajectory done;
    for (std::size_t i = 0; i < path.q.size() && path.times[i] < travelled; ++i) {
      done.times.push_back(path.times[i]);
      done.q.push_back(path.q[i]);
    }
    done.times.push_back(travelled);
    done.q.push_back(path.sample(travelled));
    follow(reversed(done), Watch::kNothing);
  }

  /// Asks the gripper about the true surfaces, couples the cups that seal and waits for the vacuum.
  bool seal() {
    wait(kDwell, result_.vacuum_time);
    const std::vector<SurfaceSample> samples = cell_.probe_cups();
    const Contact contact = cell_.cell().gripper->judge(samples);
    if (contact.sealed) {
      const std::size_t each = samples.size() / contact.cup_sealed.size();
      for (std::size_t c = 0; c < contact.cup_sealed.size(); ++c)
        if (contact.cup_sealed[c]) hold_.attach(c, samples[c * each].body);
      choose_lifted();
      if (build_vacuum()) {
        if (hook_) hook_("held", cell_);
        return true;
      }
      end(PickOutcome::kNoSeal, "the vacuum did not build up");
    }
    end(PickOutcome::kNoSeal, seal_report(contact));
    result_.lifted.reset();
    hold_.release_all();
    retreat(plan_.approach, plan_.approach.duration());
    return false;
  }

  static std::string seal_report(const Contact& contact) {
    std::string report;
    for (std::size_t c = 0; c < contact.why.size(); ++c)
      report +=
          (c ? ", cup " : "cup ") + std::to_string(c) + ": " + (contact.why[c].empty() ? "sealed" : contact.why[c]);
    return report;
  }

  /// The part that most cups hold.
  void choose_lifted() {
    std::map<BodyId, int> holds;
    for (const CupState& cup : hold_.cups())
      if (cup.part) ++holds[*cup.part];
    int most = 0;
    for (const auto& [body, count] : holds)
      if (count > most) most = count, held_body_ = body;
    result_.lifted = cell_.heap_index_of(held_body_);
    R_GP_attached_ = world_.pose(cell_.tool_body).linear().transpose() * held_pose().linear();
  }

  bool build_vacuum() {
    const double start = result_.vacuum_time;
    while (result_.vacuum_time - start < config_.vacuum_timeout) {
      wait(config_.step, result_.vacuum_time);
      if (!hold_.holds_any()) return false;
      const auto ready = [&](const CupState& cup) { return !cup.part || cup.vacuum_share >= config_.vacuum_share; };
      if (std::all_of(hold_.cups().begin(), hold_.cups().end(), ready)) return true;
    }
    return false;
  }

  void lift() {
    const bool whole = follow(plan_.lift, Watch::kHold);
    if (!whole) {
      if (!finished_) end_lost_in_lift();
      hold_.release_all();
      JointTrajectory rest;
      for (const double t : remaining_times(plan_.lift)) {
        rest.times.push_back(t - reached_);
        rest.q.push_back(plan_.lift.sample(t));
      }
      follow(rest, Watch::kNothing);
      go_back();
      return;
    }
    for (std::size_t i = 0; i < start_centres_.size(); ++i)
      if (came_along(i)) end(PickOutcome::kDoublePick, "part " + std::to_string(i) + " came out with it");
  }

  std::vector<double> remaining_times(const JointTrajectory& path) const {
    std::vector<double> times = {reached_};
    for (const double t : path.times)
      if (t > reached_) times.push_back(t);
    return times;
  }

  void end_lost_in_lift() {
    const HoldLimit limit = last_break();
    const bool sheared = limit == HoldLimit::kShear || limit == HoldLimit::kTorsion;
    end(sheared ? PickOutcome::kSlipped : PickOutcome::kPulledOff, std::string("lift: ") + name_of(limit));
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
    if (!follow(plan_.place, Watch::kHold)) {
      lost_in_transit_ = !finished_;
      lost_by_ = last_break();
      hold_.release_all();
      JointTrajectory rest;
      for (const double t : remaining_times(plan_.place)) {
        rest.times.push_back(t - reached_);
        rest.q.push_back(plan_.place.sample(t));
      }
      follow(rest, Watch::kNothing);
    } else {
      if (hook_) hook_("released", cell_);
      hold_.release_all();
      wait(kVenting, result_.vacuum_time);
    }
    const double before = result_.motion_time;
    follow(plan_.back, Watch::kNothing);
    wait(std::max(0.0, config_.settle_time - kVenting - (result_.motion_time - before)), result_.motion_time);
  }

  /// From above the bin straight to the end of the cycle.
  void go_back() {
    const Vector6d& q_end = plan_.back.q.back();
    follow(joint_move(*cell_.cell().arm, cell_.joints(), q_end, cell_.cell().motion), Watch::kNothing);
  }

  void judge_place() {
    const std::size_t i = *result_.lifted;
    if (lost_in_transit_) {
      if (cell_.in_bin(i)) return end(PickOutcome::kDroppedInBin, std::string("transit: ") + name_of(lost_by_));
      return end(PickOutcome::kLostInTransit, std::string("transit: ") + name_of(lost_by_));
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
    result_.motion_time += waited;
    for (const BodyId body : cell_.heap().bodies) world_.put_to_sleep(body);
  }

  void count_neighbours() {
    for (std::size_t i = 0; i < start_centres_.size(); ++i)
      if (i != result_.lifted && start_in_bin_[i] &&
          (cell_.box_center(i) - start_centres_[i]).norm() > kNeighbourMotion)
        ++result_.neighbours_moved;
  }

  Pose held_pose() const { return world_.pose(held_body_); }

  CellWorld& cell_;
  World& world_;
  CupHold& hold_;
  const PickPlan& plan_;
  const ExecutionConfig& config_;
  const ExecutionHook& hook_;
  ExecutionResult result_;
  bool finished_ = false;
  bool lost_in_transit_ = false;
  HoldLimit lost_by_ = HoldLimit::kPull;
  double reached_ = 0;  ///< s along the path that was stopped
  BodyId held_body_ = -1;
  Eigen::Matrix3d R_GP_attached_ = Eigen::Matrix3d::Identity();
  std::vector<Eigen::Vector3d> start_centres_;
  std::vector<bool> start_in_bin_;
};

}  // namespace

void ExecutionConfig::visit(ConfigVisitor& v) {
  v.field("step", step, Unit::kTime, "step of the world while the arm moves");
  v.field("protective_force", protective_force, Unit::kForce, "arm or tool against anything but the lips stops beyond");
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

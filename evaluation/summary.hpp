// A campaign in one object: rates with intervals, errors, stage times. summary.json is the stable surface of
// ARCHITECTURE section 14. Picks of one pile are not independent: intervals are cluster bootstraps over piles. What no
// record tells (the rate of nothing, the median of nothing) is NaN here and null in JSON.
#pragma once

#include <array>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/part.hpp"
#include "evaluation/statistics.hpp"
#include "evaluation/trial_record.hpp"

namespace binpick {

struct Rate {
  std::size_t hits = 0;
  std::size_t total = 0;
  double rate = 0;    ///< NaN when total is 0
  Interval interval;  ///< 95 %
};

struct StageSummary {
  double median = 0;  ///< s
  double p95 = 0;     ///< s
  double mean = 0;    ///< s
};

/// The heaps before the first pick: what stands behind every other figure.
struct HeapSummary {
  std::size_t settled = 0;     ///< at rest, with every part inside the bin
  double moved_share = 0;      ///< of their parts, those that moved more than 0.1 mm when they were kept awake
  double largest_motion = 0;   ///< m, of such a part
  double penetration_p99 = 0;  ///< m, of true solids: 95 % of these heaps have a smaller p99
  double penetration_max = 0;  ///< m
};

/// What arm, tool and camera met of bin, tray and table, from the physics world's own contacts in every step.
struct CollisionSummary {
  std::size_t executed = 0;                    ///< picks in which the arm moved
  std::size_t collided = 0;                    ///< of them, those with a contact of arm, tool or camera
  std::size_t lips = 0;                        ///< of them, those in which a lip touched bin, tray or table
  double depth = 0;                            ///< m, deepest of arm, tool and camera
  std::map<std::string, std::size_t> by_name;  ///< "tool in the bin" -> contacts that began
};

struct CampaignSummary {
  std::string scenario;
  std::size_t trials = 0;
  std::size_t failed = 0;  ///< of them, those that are no measurement: in no rate below
  std::map<std::string, std::vector<std::uint64_t>> failure_seeds;  ///< by the failure's name
  std::vector<std::uint64_t> repeated_seeds;                        ///< of trials that took a second attempt
  Rate cleared;                                                     ///< parts at rest in the tray / dropped
  Rate picks;                     ///< succeeded / attempted: every pick record but BinEmpty, whatever ended it
  Rate recall;                    ///< found / visible >= 0.5, over every look
  Rate precision;                 ///< right / counted
  Rate recall_first_look;         ///< the full heap only
  Rate recall_tight, recall_2mm;  ///< at 0.05 diameter and at 2 mm
  std::map<std::string, StageSummary> stages;  ///< preprocess, voting, verification, icp, estimate_total, plan (wall)
  std::size_t measured = 0;                    ///< right estimates behind the errors below
  double translation_median = 0, translation_p95 = 0;  ///< m
  double rotation_median = 0, rotation_p95 = 0;        ///< rad
  Eigen::Vector3d mean_abs_xyz = Eigen::Vector3d::Zero(), mean_abs_rpy = Eigen::Vector3d::Zero();
  HeapSummary heaps;
  CollisionSummary collisions;
  double cycle_median = 0;  ///< s simulated, succeeded picks
  double motion_mean = 0;   ///< s simulated, succeeded picks (paper's "moving robot")
  double simulated_picks_per_hour = 0, throughput_per_hour = 0;  ///< 0: unknown
  std::map<std::string, std::size_t> outcomes;
  std::map<std::string, std::vector<std::uint64_t>> outcome_seeds;  ///< the failure list: which seeds to replay
  std::string records_hash;
};

/// Independent of the records' order. `campaign_wall_seconds` <= 0: unknown.
CampaignSummary summarise(std::span<const TrialRecord> records, double campaign_wall_seconds);
std::string summary_json(const CampaignSummary& summary);

}  // namespace binpick

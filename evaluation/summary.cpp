#include "evaluation/summary.hpp"

#include <algorithm>
#include <functional>
#include <limits>

#include "core/hash.hpp"
#include "evaluation/pile_figures.hpp"

namespace binpick {
namespace {

using Records = std::vector<const TrialRecord*>;

Records sorted_by_seed(std::span<const TrialRecord> records) {
  Records sorted;
  for (const TrialRecord& record : records) sorted.push_back(&record);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const TrialRecord* a, const TrialRecord* b) { return a->seed.key < b->seed.key; });
  return sorted;
}

struct Count {
  std::size_t hits = 0, total = 0;
  Count& operator+=(const Count& other) {
    hits += other.hits;
    total += other.total;
    return *this;
  }
};

Rate rate_of(const Records& records, const char* name, const std::function<Count(const TrialRecord&)>& count) {
  Count sum;
  std::vector<ClusterCount> piles;
  for (const TrialRecord* record : records) {
    const Count pile = count(*record);
    sum += pile;
    piles.push_back({static_cast<double>(pile.hits), static_cast<double>(pile.total)});
  }
  Rate rate;
  rate.hits = sum.hits;
  rate.total = sum.total;
  rate.rate = sum.total == 0 ? std::numeric_limits<double>::quiet_NaN()
                             : static_cast<double>(sum.hits) / static_cast<double>(sum.total);
  rate.interval = cluster_bootstrap(piles, Seed{}.child("summary").child(name));
  return rate;
}

/// A count summed over the looks of a trial.
std::function<Count(const TrialRecord&)> over_looks(const std::function<Count(const PoseCheck&)>& count) {
  return [count](const TrialRecord& record) {
    Count sum;
    for (const PickRecord& pick : record.picks) sum += count(pick.check);
    return sum;
  };
}

/// The counts that a comparison uses too.
std::function<Count(const TrialRecord&)> whole(ClusterCount (*count)(const TrialRecord&)) {
  return [count](const TrialRecord& record) {
    const ClusterCount pile = count(record);
    return Count{static_cast<std::size_t>(pile.hits), static_cast<std::size_t>(pile.total)};
  };
}

void add_rates(const Records& records, CampaignSummary& summary) {
  summary.cleared = rate_of(records, "cleared", [](const TrialRecord& record) {
    return Count{static_cast<std::size_t>(record.placed), static_cast<std::size_t>(record.dropped)};
  });
  summary.picks = rate_of(records, "picks", whole(count_picks));
  using Check = const PoseCheck&;
  summary.recall = rate_of(records, "recall", over_looks([](Check c) { return Count{c.found, c.visible}; }));
  summary.precision = rate_of(records, "precision", over_looks([](Check c) { return Count{c.right, c.counted}; }));
  summary.recall_first_look = rate_of(records, "recall_first_look", whole(count_first_look));
  summary.recall_tight = rate_of(records, "recall_tight", over_looks([](Check c) {
                                   return Count{c.found_tight, c.visible};
                                 }));
  summary.recall_2mm = rate_of(records, "recall_2mm", over_looks([](Check c) {
                                 return Count{c.found_2mm, c.visible};
                               }));
}

void add_errors(const Records& records, CampaignSummary& summary) {
  std::vector<double> translations, rotations;
  Eigen::Vector3d xyz = Eigen::Vector3d::Zero(), rpy = Eigen::Vector3d::Zero();
  for (const TrialRecord* record : records) {
    for (const PickRecord& pick : record->picks) {
      for (const MatchedEstimate& estimate : pick.check.estimates) {
        if (!estimate.right || estimate.ignored) continue;
        translations.push_back(estimate.error.translation);
        rotations.push_back(estimate.error.rotation);
        xyz += estimate.error.abs_xyz;
        rpy += estimate.error.abs_rpy;
      }
    }
  }
  summary.measured = translations.size();
  summary.translation_median = quantile(translations, 0.5);
  summary.translation_p95 = quantile(translations, 0.95);
  summary.rotation_median = quantile(rotations, 0.5);
  summary.rotation_p95 = quantile(rotations, 0.95);
  const double count = static_cast<double>(translations.size());  // 0 / 0 is the NaN that is meant
  summary.mean_abs_xyz = xyz / count;
  summary.mean_abs_rpy = rpy / count;
}

/// Wall times of the looks that reached the stage at all.
void add_stages(const Records& records, CampaignSummary& summary) {
  std::map<std::string, std::vector<double>> seconds = {
      {"preprocess", {}}, {"voting", {}}, {"verification", {}}, {"icp", {}}, {"estimate_total", {}}, {"plan", {}}};
  for (const TrialRecord* record : records) {
    for (const PickRecord& pick : record->picks) {
      if (pick.plan_wall > 0) seconds["plan"].push_back(pick.plan_wall);
      if (!(pick.wall.total > 0)) continue;
      seconds["preprocess"].push_back(pick.wall.preprocess);
      seconds["voting"].push_back(pick.wall.voting);
      seconds["verification"].push_back(pick.wall.verification);
      seconds["icp"].push_back(pick.wall.icp);
      seconds["estimate_total"].push_back(pick.wall.total);
    }
  }
  for (const auto& [stage, values] : seconds) {
    summary.stages[stage] = {quantile(values, 0.5), quantile(values, 0.95), mean(values)};
  }
}

void add_cycle(const Records& records, double campaign_wall_seconds, CampaignSummary& summary) {
  std::vector<double> cycles, motions;
  for (const TrialRecord* record : records) {
    for (const PickRecord& pick : record->picks) {
      if (pick.outcome != PickOutcome::kSucceeded) continue;
      cycles.push_back(pick.sim_time);
      motions.push_back(pick.motion_time);
    }
  }
  summary.cycle_median = quantile(cycles, 0.5);
  summary.motion_mean = mean(motions);
  summary.simulated_picks_per_hour = summary.cycle_median > 0 ? 3600 / summary.cycle_median : 0;
  summary.throughput_per_hour =
      campaign_wall_seconds > 0 ? 3600 * static_cast<double>(summary.picks.total) / campaign_wall_seconds : 0;
}

void add_outcomes(const Records& records, CampaignSummary& summary) {
  for (const TrialRecord* record : records) {
    for (const PickRecord& pick : record->picks) {
      const std::string name = to_string(pick.outcome);
      ++summary.outcomes[name];
      if (pick.outcome == PickOutcome::kSucceeded || pick.outcome == PickOutcome::kBinEmpty) continue;
      std::vector<std::uint64_t>& seeds = summary.outcome_seeds[name];
      if (seeds.empty() || seeds.back() != record->seed.key) seeds.push_back(record->seed.key);
    }
  }
}

void add_failures(const Records& records, CampaignSummary& summary) {
  for (const TrialRecord* record : records) {
    if (record->attempts > 1) summary.repeated_seeds.push_back(record->seed.key);
    const std::optional<TrialFailure> failure = failure_of(*record);
    if (!failure) continue;
    summary.failure_seeds[to_string(*failure)].push_back(record->seed.key);
    ++summary.failed;
  }
}

/// Over (seed, hash) in the order of the seeds: independent of the files and workers that the records come from.
std::string records_hash(const Records& sorted) {
  Hasher hasher;
  for (const TrialRecord* record : sorted) hasher.add(record->seed.key).add(record_hash(*record));
  return hex(hasher.value());
}

// Of settled heaps: the others are not picked from.
HeapSummary heap_summary(const Records& records) {
  HeapSummary heaps;
  std::vector<double> shares, depths;
  for (const TrialRecord* record : records) {
    if (!record->settled || record->escaped > 0) continue;
    ++heaps.settled;
    shares.push_back(record->woken_share);
    depths.push_back(record->penetration_p99);
    heaps.largest_motion = std::max(heaps.largest_motion, record->woken_motion);
    heaps.penetration_max = std::max(heaps.penetration_max, record->penetration_max);
  }
  if (shares.empty()) return heaps;
  heaps.moved_share = mean(shares);
  heaps.penetration_p99 = quantile(depths, 0.95);
  return heaps;
}

CollisionSummary collision_summary(const Records& records) {
  CollisionSummary out;
  for (const TrialRecord* record : records) {
    for (const PickRecord& pick : record->picks) {
      if (pick.motion_time <= 0) continue;
      ++out.executed;
      bool arm = false, lip = false;
      for (const auto& [name, count] : pick.collisions) {
        (name.rfind("lip", 0) == 0 ? lip : arm) = true;
        out.by_name[name] += static_cast<std::size_t>(count);
      }
      out.collided += arm ? 1 : 0;
      out.lips += lip ? 1 : 0;
      out.depth = std::max(out.depth, pick.collision_depth);
    }
  }
  return out;
}

}  // namespace

CampaignSummary summarise(std::span<const TrialRecord> records, double campaign_wall_seconds) {
  const Records all = sorted_by_seed(records);
  CampaignSummary summary;
  summary.scenario = all.empty() ? "" : all.front()->scenario;
  summary.trials = all.size();
  summary.records_hash = records_hash(all);
  add_failures(all, summary);
  Records sorted;  // what is a measurement
  for (const TrialRecord* record : all)
    if (!failure_of(*record)) sorted.push_back(record);
  add_rates(sorted, summary);
  add_errors(sorted, summary);
  add_stages(sorted, summary);
  add_cycle(sorted, campaign_wall_seconds, summary);
  add_outcomes(sorted, summary);
  summary.heaps = heap_summary(sorted);
  summary.collisions = collision_summary(sorted);
  return summary;
}

}  // namespace binpick

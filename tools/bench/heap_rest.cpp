#include "tools/bench/heap_rest.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/isolated.hpp"
#include "core/parallel.hpp"
#include "sim/bin_pieces.hpp"
#include "tools/bench/cpu_clock.hpp"
#include "trials/observation.hpp"

namespace binpick {

// Between a process of its own and this one.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(HeapRest, seed, hash, parts, outside, moved, settle_time, settle_cpu, check_cpu,
                                   energy, motion, penetrations, damped, unsettled)

namespace {

constexpr unsigned kLongest = 600;  // s of processor time of a heap

/// What a worker of a campaign keeps from trial to trial, as far as heaps need it.
class HeapMaker {
 public:
  explicit HeapMaker(const HeapRestConfig& config) : s_(read_scenario(config.scene, {"ideal"})) {
    if (config.parts > 0) {
      s_.parts.resize(1);
      s_.parts.front().count = config.parts;
      s_.drop.fill = 0;
    }
    prepare_bin(s_.cell.bin);
    for (const PartEntry& entry : s_.parts) {
      context_.parts.push_back(load_part(entry.spec));
      context_.shapes.push_back(collision_shape(context_.parts.back()));
      context_.probes.push_back(probe_of(context_.parts.back()));
    }
    context_.counts = dropped_counts(s_, context_.parts);
  }

  /// As drop_heap() does it, with a look at the clock in between.
  HeapRest make(std::uint64_t number) const {
    const Seed seed = Seed{number}.child("drop");
    const BinSpec& bin = s_.cell.bin;
    CellWorld cell_world(s_.cell, s_.physics, context_.parts);
    World& world = cell_world.world();
    const double start = thread_cpu_seconds();
    DropResult drop = drop_parts(world, drop_order(s_, context_, seed), bin, s_.cell.X_WB, s_.drop, s_.settle, seed);
    HeapRest heap;
    heap.settle_cpu = thread_cpu_seconds() - start;
    check_rest(world, bin, s_.cell.X_WB, context_.probes, s_.settle, drop);
    heap.check_cpu = thread_cpu_seconds() - start - heap.settle_cpu;
    cell_world.set_heap(drop);
    heap.seed = number;
    heap.hash = world.state_hash();
    fill(heap, drop);
    return heap;
  }

 private:
  static void fill(HeapRest& heap, const DropResult& drop) {
    heap.parts = static_cast<int>(drop.bodies.size());
    heap.outside = static_cast<int>(drop.escaped.size());
    heap.moved = static_cast<int>(std::lround(drop.woken.moved_share * heap.parts));
    heap.settle_time = drop.settle_time;
    heap.energy = drop.woken.energy;
    heap.motion = drop.woken.largest_motion;
    heap.penetrations = drop.penetrations;
    heap.damped = drop.damped;
    heap.unsettled = drop.unsettled;
  }

  Scenario s_;
  TrialContext context_;
};

HeapRest in_own_process(const HeapMaker& maker, std::uint64_t seed) {
  const auto bytes = run_isolated([&] { return nlohmann::json(maker.make(seed)).dump(); }, kLongest);
  if (!bytes) throw std::runtime_error("seed " + std::to_string(seed) + ": the process of the heap ended early");
  return nlohmann::json::parse(*bytes).get<HeapRest>();
}

}  // namespace

std::vector<HeapRest> rest_of_heaps(const HeapRestConfig& config) {
  const HeapMaker maker(config);
  std::vector<HeapRest> heaps(config.last_seed - config.first_seed);
  parallel_for(heaps.size(), config.workers, [&](std::size_t i) {
    const std::uint64_t seed = config.first_seed + i;
    heaps[i] = config.fresh ? in_own_process(maker, seed) : maker.make(seed);
  });
  return heaps;
}

}  // namespace binpick

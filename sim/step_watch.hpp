// Being told of every step of a World, to look on: for replays and pictures. Whoever is told may read the world and
// nothing else, so that watching changes no bit of it.
#pragma once

#include <functional>
#include <memory>

#include "sim/world.hpp"

namespace binpick {

/// `told` is called after every step until this is destroyed, which must be before the world is. One watch at a time.
class StepWatch {
 public:
  StepWatch(World& world, std::function<void()> told);
  ~StepWatch();
  StepWatch(const StepWatch&) = delete;
  StepWatch& operator=(const StepWatch&) = delete;

 private:
  struct Observer;
  World* world_;
  std::unique_ptr<Observer> observer_;
};

}  // namespace binpick

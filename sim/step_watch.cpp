#include "sim/step_watch.hpp"

#include "core/check.hpp"
#include "sim/world_impl.hpp"

namespace binpick {

struct StepWatch::Observer : World::Impl::Observer {
  explicit Observer(std::function<void()> callee) : told(std::move(callee)) {}
  void joined(const World::Impl::Body&) override {}
  void left(const World::Impl::Body&) override {}
  void before_step(double, int) override {}
  void after_step() override { told(); }
  std::function<void()> told;
};

StepWatch::StepWatch(World& world, std::function<void()> told)
    : world_(&world), observer_(std::make_unique<Observer>(std::move(told))) {
  BP_CHECK(world.impl().observer == nullptr, "a World is watched twice");
  world.impl().observer = observer_.get();
}

StepWatch::~StepWatch() { world_->impl().observer = nullptr; }

}  // namespace binpick

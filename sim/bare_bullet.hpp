// The heap of a World once more in bare Bullet: the same hulls, margins, masses and settings, the same bodies released
// at the same steps with the same states, stepped by a btDiscreteDynamicsWorld with nothing of ours around it but
// rolling friction once a pair (heap_dynamics.hpp), without which it would be another heap. For benches: what does our
// World cost on top? Both worlds take their steps in turn, so that a busy machine slows both. It lives here and not
// beside the bench because only sim may see Bullet and what is inside a World.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

#include "sim/world.hpp"

namespace binpick {

class BareBullet {
 public:
  /// From now on every step of `world`, still empty, is taken by the bare world too. The World must outlive this object
  /// and must neither freeze parts nor move bodies meanwhile. `cpu_now`: processor time of this thread, s.
  BareBullet(World& world, std::function<double()> cpu_now);
  ~BareBullet();
  BareBullet(const BareBullet&) = delete;
  BareBullet& operator=(const BareBullet&) = delete;

  struct Report {
    std::size_t steps = 0;
    double simulated = 0;       ///< s
    double ours = 0;            ///< CPU s since the start, all that was done between the steps included
    double bare = 0;            ///< CPU s of the bare world's steps alone
    std::size_t different = 0;  ///< steps after which a pose or velocity had other bits than ours
  };
  Report report() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace binpick

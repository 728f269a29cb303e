// Private to sim: collision detection that leaves alone what does not move.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <unordered_map>

namespace binpick {

/// In a heap most pairs of touching bodies hardly move against each other from step to step, yet the search for the
/// closest points of their pieces takes half the time. Here a pair is searched again only when it has moved by more
/// than `tolerance` since; in between its contact points are carried along with the bodies. A pair that has just
/// stopped is searched a few times more, since every search adds one point to a face that rests on another.
class QuietPairs : public btCollisionDispatcher {
 public:
  explicit QuietPairs(btCollisionConfiguration* configuration);

  /// m, of any point of the smaller body of a pair; 0, as at first: every pair is searched in every step.
  void set_tolerance(btScalar tolerance) { tolerance_ = tolerance; }
  btScalar tolerance() const { return tolerance_; }
  long searched() const { return searched_; }  ///< pairs, in all steps so far

 private:
  struct Seen {
    btTransform X_01;     ///< of the second body in the first, at the last search but those of a pair at rest
    btScalar radius = 0;  ///< m, of the smaller body
    int searches = 0;     ///< since then
    bool round = false;   ///< one of them has more than faces: always searched
  };
  static void process(btBroadphasePair& pair, btCollisionDispatcher& dispatcher, const btDispatcherInfo& info);
  bool quiet(const btBroadphasePair& pair);
  void carry_points(const btBroadphasePair& pair);

  btScalar tolerance_ = 0;
  long searched_ = 0;
  std::unordered_map<long long, Seen> seen_;  ///< by user index of the bodies; only looked up
  btManifoldArray manifolds_;
};

}  // namespace binpick

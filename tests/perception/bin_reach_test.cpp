// A ripple that moves samples across the edge of what the localisation looks at. Runs under the sanitizers: beyond the
// edge the cells' histograms end.
#include <gtest/gtest.h>

#include "perception/bin_localisation.hpp"
#include "tests/perception/scene_maker.hpp"

namespace binpick {
namespace {

using namespace testing_scene;

TEST(BinReach, SamplesThatARippleMovesBeyondItAreLeftOut) {
  HeapOptions options;
  options.noise = false;
  const HeapScene made = photograph(ring_part(), {}, options, Seed{8}, camera_above(0.75));
  Scene scene;
  scene.bin = made.view.bin;
  scene.camera = made.frame.camera;
  scene.depth = made.frame.depth;
  scene.noise = made.frame.noise;
  scene.X_CB = made.view.X_CB;
  scene.noise.focal_baseline = scene.camera.fx * 0.018;  // short: a tenth of a pixel is 4 mm
  const double fB = scene.noise.focal_baseline;
  BinLocalisationConfig config;
  Rng rng = Seed{8}.child("clutter").rng();
  // Clutter of every height within the reach, and a wave over all of it.
  for (float& z : scene.depth) {
    const double true_z = z - (rng.uniform() < 0.4 ? config.reach * (2 * rng.uniform() - 1) : 0);
    z = static_cast<float>(fB / (fB / true_z + 0.1 * std::sin(2 * std::numbers::pi * fB / true_z)));
  }
  const LocatedBin found = locate_bin(scene, config);
  ASSERT_TRUE(found.found);
  EXPECT_FALSE(found.ripple.none());
  EXPECT_LT((found.X_CB.translation() - made.view.X_CB.translation()).norm(), 0.005);
}

}  // namespace
}  // namespace binpick

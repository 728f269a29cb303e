// Settings of the ways in which a heap is made besides rain: dumped out of a tote, shaken after it came to rest.
#pragma once

#include "core/config.hpp"

namespace binpick {

/// A tote over the bin that turns about the axis through its middle: the parts fall together, in a stream over its rim.
struct DumpConfig {
  double tilt_time = 2.0;   ///< s from upright to the end
  double tilt_angle = 2.6;  ///< rad (149 deg): steep enough for everything to slide out
  void visit(ConfigVisitor& v);
  void validate() const;
};

/// The bin on a vibrating table, seen from the table: in its frame every part feels -a(t), a = (2 pi frequency)^2 *
/// amplitude * sin(2 pi frequency t), along a line whose direction in the plane is drawn for each heap.
struct ShakeConfig {
  double amplitude = 1e-3;  ///< m, half the way from end to end
  double frequency = 25;    ///< Hz; with the amplitude: 24.7 m/s^2, two and a half times gravity
  double duration = 1.0;    ///< s, of which the first and the last tenth swell and fade
  double steepness = 0.8;   ///< rad, of the line over the horizontal: pi / 2 shakes up and down only
  void visit(ConfigVisitor& v);
  void validate() const;
};

}  // namespace binpick

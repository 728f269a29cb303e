// Private to sim: what the noise terms do to whole rows of floats. Compiled for wide registers, hence free of Eigen.
#pragma once

namespace binpick {

/// out = scale * a.
void scale_row(float* out, const float* a, float scale, int count);
/// out += scale * a.
void add_row(float* out, const float* a, float scale, int count);
/// out += scale * (a + b).
void add_pair(float* out, const float* a, const float* b, float scale, int count);
/// out[i] = median of the 3 x 3 values around i, for 1 <= i < count - 1; NaN where one of them is NaN.
void median_row(float* out, const float* above, const float* here, const float* below, int count);
/// out[i] = largest of a[i - radius] .. a[i + radius], cut to the row; a NaN counts as nothing (0).
void largest_beside(float* out, const float* a, int radius, int count);
/// out = the larger of both.
void largest_of(float* out, const float* a, int count);

}  // namespace binpick

#include "evaluation/metrics_visible.hpp"

#include <algorithm>
#include <cmath>

namespace binpick {
namespace {

PixelRect around(const PixelRect& a, const PixelRect& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.u0, b.u0), std::min(a.v0, b.v0), std::max(a.u1, b.u1), std::max(a.v1, b.v1)};
}

double ray_factor(const PinholeCamera& camera, int u, int v) { return camera.ray(u, v).norm(); }

/// Visible as far as the image tells: nothing measured there, or nothing much nearer.
bool passes(double distance, double seen, double delta) {
  return distance > 0 && (seen == 0 || distance - seen <= delta);
}

}  // namespace

Image<double> ray_lengths(const Image<float>& depth, const PinholeCamera& camera) {
  Image<double> lengths(depth.width(), depth.height(), 0);
  for (int v = 0; v < depth.height(); ++v)
    for (int u = 0; u < depth.width(); ++u)
      if (std::isfinite(depth(u, v)) && depth(u, v) > 0) lengths(u, v) = depth(u, v) * ray_factor(camera, u, v);
  return lengths;
}

DistancePatch PatchRenderer::draw(const TriangleMesh& mesh_P, const Pose& X_CP) {
  buffer_.clear();
  buffer_.draw(mesh_P, X_CP, 0);
  DistancePatch patch;
  if (buffer_.dirty().empty()) return patch;
  patch.rect = buffer_.dirty();
  patch.distance.reserve(static_cast<std::size_t>(patch.rect.width()) * static_cast<std::size_t>(patch.rect.height()));
  for (int v = patch.rect.v0; v < patch.rect.v1; ++v)
    for (int u = patch.rect.u0; u < patch.rect.u1; ++u) {
      const float z = buffer_.result().depth(u, v);
      patch.distance.push_back(std::isfinite(z) ? z * ray_factor(buffer_.camera(), u, v) : 0);
    }
  return patch;
}

std::vector<double> vsd_errors(const DistancePatch& est, const DistancePatch& truth, const Image<double>& seen,
                               double diameter, const VsdSettings& settings) {
  const PixelRect both = around(est.rect, truth.rect);
  std::vector<std::size_t> wrong(settings.taus.size(), 0);
  std::size_t visible = 0, shared = 0;
  for (int v = both.v0; v < both.v1; ++v)
    for (int u = both.u0; u < both.u1; ++u) {
      const double d_est = est.at(u, v), d_true = truth.at(u, v);
      if (d_est == 0 && d_true == 0) continue;
      const bool true_seen = passes(d_true, seen(u, v), settings.delta);
      const bool est_seen = passes(d_est, seen(u, v), settings.delta) || (true_seen && d_est > 0);
      if (!true_seen && !est_seen) continue;
      ++visible;
      if (!true_seen || !est_seen) continue;
      ++shared;
      const double off = std::abs(d_true - d_est) / diameter;
      for (std::size_t k = 0; k < wrong.size(); ++k) wrong[k] += off >= settings.taus[k] ? 1 : 0;
    }
  std::vector<double> errors(wrong.size(), 1);
  if (visible == 0) return errors;
  for (std::size_t k = 0; k < wrong.size(); ++k)
    errors[k] = static_cast<double>(wrong[k] + visible - shared) / static_cast<double>(visible);
  return errors;
}

double cus_error(const DistancePatch& est, const DistancePatch& truth) {
  const PixelRect both = around(est.rect, truth.rect);
  std::size_t either = 0, shared = 0;
  for (int v = both.v0; v < both.v1; ++v)
    for (int u = both.u0; u < both.u1; ++u) {
      const bool in_est = est.at(u, v) > 0, in_truth = truth.at(u, v) > 0;
      either += in_est || in_truth ? 1 : 0;
      shared += in_est && in_truth ? 1 : 0;
    }
  return either == 0 ? 1 : 1 - static_cast<double>(shared) / static_cast<double>(either);
}

}  // namespace binpick

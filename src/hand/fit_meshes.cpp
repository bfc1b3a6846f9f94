// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "hand/fit_point.h"

namespace phalanx {
namespace {

/// Distances from a digit's first joint [m]. Within kJointZone the palm is scaled by one ratio in all
/// directions. Beyond kPalmZone it is scaled as a whole.
constexpr double kJointZone = 0.010;
constexpr double kPalmZone = 0.035;
/// Largest end slope of the cubic in mean slopes. Up to three, the cubic is monotonic.
constexpr double kSteepest = 2.5;

/// Returns 0 below 0, 1 above 1, and a smooth rise between.
double smooth_step(double x) noexcept {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

double breadth_at(const SegmentFit& fit, double t) noexcept {
  if (t < 0.5) return fit.breadth_base + (fit.breadth_middle - fit.breadth_base) * smooth_step(2.0 * t);
  return fit.breadth_middle + (fit.breadth_end - fit.breadth_middle) * smooth_step(2.0 * t - 1.0);
}

/// Maps the share t of a bone, in lengths of the base hand's bone: 0 to 0, 1 to `length`.
double along(double t, double length, double slope_base, double slope_end) noexcept {
  if (t <= 0.0) return slope_base * t;
  if (t >= 1.0) return length + slope_end * (t - 1.0);
  const double u = 1.0 - t;
  return length * t * t * (3.0 - 2.0 * t) + slope_base * t * u * u - slope_end * t * t * u;
}

Vec3 point_of_segment(const Vec3& p, double bone, const SegmentFit& fit, bool distal) noexcept {
  const double steepest = kSteepest * fit.length;
  const double slope_base = std::min(fit.breadth_base, steepest);
  // Beyond a distal bone the soft tip scales with the bone's length.
  const double slope_end = distal ? fit.length : std::min(fit.breadth_end, steepest);
  const double t = -p.z() / bone;
  const double breadth = breadth_at(fit, t);
  return {breadth * p.x(), breadth * p.y(), -bone * along(t, fit.length, slope_base, slope_end)};
}

/// Returns the weighted mean height of the digits' first joints for a point. Each weight is the inverse
/// fourth power of the distance, so that at a joint the result is that joint's height.
/// @param nearest  set to the distance of the nearest joint [m]
double joint_height(const HandParameters& base, const Vec3& p, double& nearest) noexcept {
  double sum = 0.0;
  double weights = 0.0;
  double nearest_squared = std::numeric_limits<double>::infinity();
  for (const DigitParameters& digit : base.digits) {
    const double squared = std::max((p - digit.base).squaredNorm(), 1e-12);
    nearest_squared = std::min(nearest_squared, squared);
    const double weight = 1.0 / (squared * squared);
    sum += weight * digit.base.z();
    weights += weight;
  }
  nearest = std::sqrt(nearest_squared);
  return sum / weights;
}

Vec3 point_of_palm(const Vec3& p, const HandParameters& base, const HandFit& fit) noexcept {
  double nearest = 0.0;
  const double height = joint_height(base, p, nearest);
  const double share = 1.0 - smooth_step((nearest - kJointZone) / (kPalmZone - kJointZone));
  const double z = fit.palm_length * p.z() + (fit.palm_breadth - fit.palm_length) * share * (p.z() - height);
  return {fit.palm_breadth * p.x(), fit.palm_breadth * p.y(), z};
}

}  // namespace

Vec3 fitted_point(const HandParameters& base, const HandFit& fit, int segment, const Vec3& p_S) noexcept {
  if (segment == kPalm) return point_of_palm(p_S, base, fit);
  return point_of_segment(p_S, segment_length(base, segment), fit.segment[static_cast<std::size_t>(segment)],
                          segment % kSegmentsPerDigit == kSegmentsPerDigit - 1);
}

SegmentMeshes fitted_meshes(const HandParameters& base, const HandFit& fit, SegmentMeshes meshes) {
  for (int s = 0; s < kSegments; ++s) {
    for (Vec3& v : meshes[static_cast<std::size_t>(s)].vertices) v = fitted_point(base, fit, s, v);
  }
  return meshes;
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "peer_clearance.h"

#include <algorithm>
#include <limits>

#include "peer_motion.h"

namespace phalanx::bench {
namespace {

/// A capped distance is asked for this much more than is needed now [m], so that the answer lasts for some
/// ticks: of 0, 0.5, 1, 2, 4 and 8 mm this made pruned FCL fastest.
constexpr double kAhead = 0.5e-3;

Vec3 least_corner(const TriangleMesh& mesh) {
  Vec3 least = Vec3::Constant(std::numeric_limits<double>::infinity());
  for (const Vec3& v : mesh.vertices) least = least.cwiseMin(v);
  return least;
}

Vec3 greatest_corner(const TriangleMesh& mesh) {
  Vec3 greatest = Vec3::Constant(-std::numeric_limits<double>::infinity());
  for (const Vec3& v : mesh.vertices) greatest = greatest.cwiseMax(v);
  return greatest;
}

}  // namespace

Clearance::Clearance(const HandModel& hand, const TriangleMesh& object, DistanceEngine& engine,
                     Pruning pruning)
    : hand_(hand),
      engine_(engine),
      pruning_(pruning),
      object_min_(least_corner(object)),
      object_max_(greatest_corner(object)) {
  for (int s = 0; s < kSegments; ++s) {
    Sphere& sphere = sphere_[idx(s)];
    sphere.centre = 0.5 * (least_corner(hand.mesh(s)) + greatest_corner(hand.mesh(s)));
    for (const Vec3& v : hand.mesh(s).vertices)
      sphere.radius = std::max(sphere.radius, (v - sphere.centre).norm());
  }
}

void Clearance::forget() { known_.fill(Known{}); }

double Clearance::root_bound(int segment, const Pose& X_WS) const {
  const Vec3 centre = X_WS * sphere_[idx(segment)].centre;
  const Vec3 outside = (object_min_ - centre).cwiseMax(centre - object_max_).cwiseMax(0.0);
  return outside.norm() - sphere_[idx(segment)].radius - 1e-12;
}

double Clearance::of(int digit, int k, const DigitAngles& angle, const Pose& X_WS, double needed) {
  const int segment = segment_index(digit, k);
  if (pruning_ == Pruning::kNone) {
    ++questions_;
    return engine_.nearest(segment, X_WS, std::numeric_limits<double>::infinity()).distance;
  }
  Known& known = known_[idx(segment)];
  const double moved = travel(hand_, digit, k, known.angle, angle);
  if (known.bound - moved > needed) return known.bound - moved;
  if (known.exact && moved == 0.0) return known.bound;
  const double root = root_bound(segment, X_WS);
  if (root > needed) {
    known = {angle, root, false};
    return root;
  }
  ++questions_;
  const double cap = needed + kAhead;
  const Nearest nearest = engine_.nearest(segment, X_WS, cap);
  known = {angle, nearest.distance, nearest.distance < cap};
  return nearest.distance;
}

}  // namespace phalanx::bench

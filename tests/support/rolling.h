// SPDX-License-Identifier: Apache-2.0
// The finger as the ideal tapered capsule that its facets stand for: where an ideal finger touches a surface,
// its own normal there says from where it presses, whatever the facets do.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "support/lone_finger.h"
#include "support/reference/surface_bound.h"

namespace phalanx::test {

class Rolling {
 public:
  static constexpr double kBand = 5e-6;  ///< pairs this near to the least distance tie for a contact [m]

  /// @param segment  of the index: 0 proximal, 1 middle, 2 distal
  Rolling(const HandModel& hand, int segment)
      : shape_(simple_parameters().segments[static_cast<std::size_t>(kSegmentsPerDigit * kIndex + segment)]) {
    for (const RawTriangle& t : triangles(hand.mesh(segment_index(kIndex, segment)))) {
      const Vec3 facet = (t[1] - t[0]).cross(t[2] - t[0]);
      for (const Vec3& v : t) facet_ = std::max(facet_, angle_of(facet, outward(v)));
      sag_ = std::max(sag_, below((t[0] + t[1] + t[2]) / 3.0));
    }
  }

  /// Outward normal of the ideal segment there, in its frame: away from the centre of the ball in it whose
  /// surface is nearest.
  [[nodiscard]] Vec3 outward(const Vec3& p_S) const { return (p_S - centre(nearest_ball(p_S))).normalized(); }

  /// How far the direction of a contact may be off the ideal's there [rad]: a facet, its edge or its corner
  /// faces within the greatest angle between a facet and the ideal at its corners. And the facets lie between
  /// the ideal ball and one that is smaller by their sag, so that whatever ties with a touching place, to the
  /// band, is within acos(1 - (band + sag) / radius) of it.
  [[nodiscard]] double off() const { return facet_ + std::acos(1.0 - (kBand + sag_) / shape_.radius_tip); }

 private:
  using RawTriangle = std::array<Vec3, 3>;
  static std::vector<RawTriangle> triangles(const TriangleMesh& mesh) {
    std::vector<RawTriangle> out;
    for (const Triangle& t : mesh.triangles) {
      out.push_back({mesh.vertices[static_cast<std::size_t>(t[0])],
                     mesh.vertices[static_cast<std::size_t>(t[1])],
                     mesh.vertices[static_cast<std::size_t>(t[2])]});
    }
    return out;
  }

  [[nodiscard]] Vec3 centre(double t) const { return {0.0, 0.0, -t * shape_.length}; }
  /// How deep p_S lies in the ball at t of the length [m].
  [[nodiscard]] double depth(const Vec3& p_S, double t) const {
    return (1.0 - t) * shape_.radius_base + t * shape_.radius_tip - (p_S - centre(t)).norm();
  }
  [[nodiscard]] double below(const Vec3& p_S) const { return depth(p_S, nearest_ball(p_S)); }
  [[nodiscard]] double nearest_ball(const Vec3& p_S) const {
    double low = 0.0;
    double high = 1.0;
    for (int i = 0; i < 60; ++i) {
      const double a = low + (high - low) / 3.0;
      const double b = high - (high - low) / 3.0;
      (depth(p_S, a) > depth(p_S, b) ? high : low) = depth(p_S, a) > depth(p_S, b) ? b : a;
    }
    return 0.5 * (low + high);
  }

  SegmentShape shape_;
  double facet_ = 0.0;  ///< [rad]
  double sag_ = 0.0;    ///< of the facets below the ideal [m]
};

/// The unit vector nearest to n in the cone of `fan`, by cyclic descent on its non-negative weights.
inline Vec3 nearest_in_cone(const std::vector<Vec3>& fan, const Vec3& n) {
  std::vector<double> weight(fan.size(), 0.0);
  Vec3 sum = Vec3::Zero();
  for (int round = 0; round < 500; ++round) {
    for (std::size_t i = 0; i < fan.size(); ++i) {
      const double better = std::max(0.0, weight[i] + fan[i].dot(n - sum));
      sum += (better - weight[i]) * fan[i];
      weight[i] = better;
    }
  }
  if (sum.norm() > 1e-6) return sum.normalized();
  return *std::max_element(fan.begin(), fan.end(),
                           [&](const Vec3& a, const Vec3& b) { return a.dot(n) < b.dot(n); });
}

}  // namespace phalanx::test

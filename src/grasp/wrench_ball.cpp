// SPDX-License-Identifier: Apache-2.0
#include "grasp/wrench_ball.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include "phalanx/core/random.h"

extern "C" {
#include <libqhull_r/libqhull_r.h>
}

namespace phalanx {
namespace {

constexpr int kStarts = 48;      // of the descent
constexpr int kDescents = 40;    // steps of one start
constexpr double kStep = 0.5;    // the first step [rad]
constexpr double kShrink = 0.9;  // each step, over the one before

Wrench wrench_of(const Vec3& force, const Vec3& torque) {
  Wrench w;
  w << force, torque;
  return w;
}

/// Returns the greatest product of a wrench with a direction, and its index.
std::pair<double, std::size_t> support(const std::vector<Wrench>& wrenches, const Wrench& u) {
  double most = -std::numeric_limits<double>::infinity();
  std::size_t best = 0;
  for (std::size_t i = 0; i < wrenches.size(); ++i) {
    const double along = wrenches[i].dot(u);
    if (along > most) {
      most = along;
      best = i;
    }
  }
  return {most, best};
}

}  // namespace

std::vector<Wrench> contact_wrenches(const std::vector<WrenchContact>& contacts, double friction,
                                     double spin_radius, const Vec3& centre, double radius) {
  std::vector<Wrench> wrenches;
  wrenches.reserve(contacts.size() * (kSlideDirections + 2));
  for (const WrenchContact& contact : contacts) {
    const Vec3 arm = (contact.point - centre) / radius;
    const Vec3 along = contact.inward.unitOrthogonal();
    const Vec3 across = contact.inward.cross(along);
    for (int i = 0; i < kSlideDirections; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kSlideDirections;
      const Vec3 force = contact.inward + friction * (std::cos(angle) * along + std::sin(angle) * across);
      wrenches.push_back(wrench_of(force, arm.cross(force)));
    }
    const Vec3 spin = friction * spin_radius / radius * contact.inward;
    wrenches.push_back(wrench_of(contact.inward, arm.cross(contact.inward) + spin));
    wrenches.push_back(wrench_of(contact.inward, arm.cross(contact.inward) - spin));
  }
  return wrenches;
}

double wrench_ball(const std::vector<Wrench>& wrenches) {
  if (wrenches.size() < 7) return 0.0;
  std::vector<coordT> points;
  points.reserve(wrenches.size() * 6);
  for (const Wrench& w : wrenches) points.insert(points.end(), w.data(), w.data() + 6);
  qhT hull;
  std::FILE* nowhere = std::fopen("/dev/null", "w");
  qh_zero(&hull, nowhere);
  char options[] = "qhull Qt Pp";
  double least = 0.0;
  if (qh_new_qhull(&hull, 6, static_cast<int>(wrenches.size()), points.data(), False, options, nullptr,
                   nowhere) == 0) {
    least = std::numeric_limits<double>::infinity();
    for (const facetT* facet = hull.facet_list; facet != nullptr && facet->next != nullptr;
         facet = facet->next)
      least = std::min(least, -facet->offset);
  }
  qh_freeqhull(&hull, !qh_ALL);
  int kept = 0;
  int kept_bytes = 0;
  qh_memfreeshort(&hull, &kept, &kept_bytes);
  if (nowhere != nullptr) std::fclose(nowhere);
  return std::isfinite(least) ? std::max(0.0, least) : 0.0;
}

double wrench_ball_bound(const std::vector<Wrench>& wrenches) {
  if (wrenches.empty()) return 0.0;
  Wrench mean = Wrench::Zero();
  for (const Wrench& w : wrenches) mean += w;
  Random random(1);
  double least = std::numeric_limits<double>::infinity();
  for (int start = 0; start < kStarts; ++start) {
    Wrench u = -mean;
    if (start > 0 || !(u.norm() > 0.0))
      for (double& x : u) x = random.normal();
    u.normalize();
    double step = kStep;
    for (int i = 0; i < kDescents; ++i, step *= kShrink) {
      const auto [most, best] = support(wrenches, u);
      least = std::min(least, most);
      const Wrench down = wrenches[best] - most * u;
      const double length = down.norm();
      if (!(length > 0.0)) break;
      u = (u - step / length * down).normalized();
    }
  }
  return least;
}

}  // namespace phalanx

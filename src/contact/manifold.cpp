// SPDX-License-Identifier: Apache-2.0
#include "contact/manifold.h"

#include <algorithm>
#include <cmath>

#include "contact/normal_fan.h"
#include "phalanx/core/index.h"

namespace phalanx {
namespace {

constexpr double kMerge = 1e-3;  // points nearer than this on the segment belong to one place [m]
constexpr double kTie = 1e-6;    // a point on a face is this near to it [m]
constexpr double kSame = 10e-6;  // points nearer than this are one [m]
constexpr double kTier = 5e-6;   // places whose distances differ by less are about as near [m]
constexpr int kMostCandidates = 32;
constexpr int kMostTests = 64;                       // of pairs against their neighbours
constexpr double kCosInside = 0.99999847691328769;   // 0.1 degrees, of a direction beside its fan
constexpr double kCosBetween = 0.99619469809174555;  // 5 degrees, between directions of one place

using Order = std::array<std::uint16_t, NearPairs::kMost>;

/// Adds the face normal of a triangle, on the side of `direction`. A sliver's normal is rounding noise; its
/// neighbours' suffice.
void add_face(const Corners& t, const Vec3& direction, NormalFan& fan) noexcept {
  const Vec3 u = t[1] - t[0];
  const Vec3 v = t[2] - t[0];
  const Vec3 normal = u.cross(v);
  const double size = normal.norm();
  if (!(size > 1e-9 * (u.squaredNorm() + v.squaredNorm()))) return;
  fan.add((normal.dot(direction) < 0.0 ? -1.0 / size : 1.0 / size) * normal);
}

/// @returns true if the triangle contains the point, to kTie
bool contains(const Corners& t, const Vec3& point) noexcept {
  const Vec3 w = barycentric(t, point);
  return (w[0] * t[0] + w[1] * t[1] + w[2] * t[2] - point).squaredNorm() <= kTie * kTie;
}

/// @returns true if the pair is nearer than its neighbours on both meshes: its direction lies between the normals
/// of the faces that meet at its point, on the object and on the segment. The faces that meet at a point are as
/// near to the other triangle as the pair, and so are among the near pairs.
bool is_nearest(const PlacedSegment& segment, const ObjectTree& object, const NearPairs& near,
                const NearPairs::Pair& pair, const Vec3& direction) noexcept {
  NormalFan on_object;
  NormalFan on_segment;
  const double limit = std::pow(std::sqrt(pair.closest.squared) + kTie, 2);
  for (std::size_t i = 0; i < near.count(); ++i) {
    const NearPairs::Pair& other = near[i];
    if (other.closest.squared > limit) continue;
    if (other.triangle == pair.triangle) {
      const Corners t = object.corners(other.slot);
      if (contains(t, pair.closest.on_b)) add_face(t, direction, on_object);
    }
    if (other.slot == pair.slot) {
      Corners t = segment.tree.corners(other.triangle);
      for (Vec3& x : t) x = segment.X_WS * x;
      if (contains(t, pair.closest.on_a)) add_face(t, -direction, on_segment);
    }
  }
  return on_object.nearest(direction).dot(direction) >= kCosInside &&
         on_segment.nearest(-direction).dot(-direction) >= kCosInside;
}

/// @returns true if the place is the same as a nearer one, seen by another pair
bool is_same(const ContactPlace& nearer, const ContactPlace& place) noexcept {
  return place.direction.dot(nearer.direction) >= kCosBetween &&
         (place.on_segment - nearer.on_segment).squaredNorm() <= kSame * kSame;
}

bool belongs_to(const ContactPlace& chosen, const ContactPlace& place) noexcept {
  return place.direction.dot(chosen.direction) >= kCosBetween &&
         (place.on_segment - chosen.on_segment).squaredNorm() <= kMerge * kMerge;
}

/// Places that a manifold is chosen from, the nearest first.
struct Candidates {
  int count = 0;
  std::array<ContactPlace, kMostCandidates> place;
};

/// Chooses places: the nearest; then, of those that are about as near as the nearest one left, the farthest from
/// all that are chosen, so that a line or a face that lies flat is held at its ends.
void choose(const Candidates& from, int most, Manifold& out) noexcept {
  out.place[0] = from.place[0];
  out.count = 1;
  while (out.count < most) {
    int best = -1;
    double least_tier = 0.0;
    double farthest = 0.0;
    for (int i = 0; i < from.count; ++i) {
      const ContactPlace& place = from.place[idx(i)];
      double apart = 1e300;
      bool belongs = false;
      for (int j = 0; j < out.count && !belongs; ++j) {
        belongs = belongs_to(out.place[idx(j)], place);
        apart = std::min(apart, (place.on_segment - out.place[idx(j)].on_segment).squaredNorm());
      }
      if (belongs) continue;
      const double tier = std::floor((place.gap - from.place[0].gap) / kTier);
      if (best >= 0 && (tier > least_tier || (tier == least_tier && apart <= farthest))) continue;
      best = i;
      least_tier = tier;
      farthest = apart;
    }
    if (best < 0) return;
    out.place[idx(out.count++)] = from.place[idx(best)];
  }
}

}  // namespace

void find_manifold(const PlacedSegment& segment, const ObjectModel& object, double reach, double least,
                   int most, NearPairs& near, Manifold& out) noexcept {
  out.count = 0;
  near.find(segment, object.tree(), reach);
  while (near.overflows() && reach > least) {
    reach = std::max(least, 0.5 * reach);
    near.find(segment, object.tree(), reach);
  }
  if (near.overflows() || near.count() == 0) return;

  const double limit = reach * reach;
  Order order;
  std::size_t count = 0;
  for (std::size_t i = 0; i < near.count(); ++i)
    if (near[i].closest.squared <= limit) order[count++] = static_cast<std::uint16_t>(i);
  std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count),
            [&](std::uint16_t a, std::uint16_t b) {
              const double da = near[a].closest.squared;
              const double db = near[b].closest.squared;
              return da != db ? da < db : a < b;
            });
  Candidates candidates;
  int tests = 0;
  for (std::size_t n = 0; n < count && candidates.count < kMostCandidates && tests < kMostTests; ++n) {
    const NearPairs::Pair& pair = near[order[n]];
    const double gap = std::sqrt(pair.closest.squared);
    if (!(gap > 0.0)) continue;
    const ContactPlace place{.triangle = pair.triangle,
                             .slot = pair.slot,
                             .gap = gap,
                             .on_segment = pair.closest.on_a,
                             .on_object = pair.closest.on_b,
                             .direction = (pair.closest.on_a - pair.closest.on_b) / gap};
    const auto end = candidates.place.begin() + candidates.count;
    if (std::any_of(candidates.place.begin(), end,
                    [&](const ContactPlace& at) { return is_same(at, place); }))
      continue;
    ++tests;
    if (n > 0 && !is_nearest(segment, object.tree(), near, pair, place.direction)) continue;
    candidates.place[idx(candidates.count++)] = place;
  }
  if (candidates.count > 0) choose(candidates, std::min(most, Manifold::kMost), out);
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "phalanx/contact/proximity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include "contact/normal_fan.h"
#include "contact/search/views.h"
#include "phalanx/contact/triangle_distance.h"
#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"

namespace phalanx {
namespace {

double squared(double x) noexcept { return x * x; }

enum class Order {
  kFixed,    ///< the trees' own order, independent of pruning
  kNearest,  ///< nearer boxes first, which lowers the cap early
};

TriangleDistance to_distance(const search::PairDistance& p) noexcept {
  return {p.squared, Vec3(p.on_segment[0], p.on_segment[1], p.on_segment[2]),
          Vec3(p.on_object[0], p.on_object[1], p.on_object[2])};
}

/// Calls found(triangle, slot, closest points, cap^2) for every pair whose squared distance is at most the
/// cap. found() may lower the cap.
template <Order order, class Found>
void for_each_pair(const PlacedSegment& segment, const ObjectTree& object, double cap_squared,
                   Found&& found) noexcept {
  if (segment.tree.empty() || object.empty()) return;
  const auto sink = [](void* context, const search::PairDistance& p, double& cap) {
    (*static_cast<std::remove_reference_t<Found>*>(context))(p.pair.triangle, p.pair.slot, to_distance(p),
                                                             cap);
  };
  search::functions().visit(search::view_of(segment, object), search::view_of(object), cap_squared,
                            order == Order::kNearest, sink, &found);
}

/// Pair within the cap that closes fastest; decides which other pairs count.
struct Lead {
  const SegmentMotion* motion = nullptr;
  Vec3 direction = Vec3::Zero();
  Vec3 at = Vec3::Zero();  ///< on the segment
  int slot = 0;
  double speed = 0.0;  ///< 0: no pair closes, every pair counts

  [[nodiscard]] double closing_speed(const Vec3& n, const Vec3& x) const noexcept {
    return -n.dot(motion->velocity(x));
  }
  [[nodiscard]] bool admits(const Vec3& n, const Vec3& on_segment) const noexcept {
    return !(speed > 0.0) || n.dot(direction) >= kCos30Deg || closing_speed(n, on_segment) >= 0.5 * speed;
  }
};

Vec3 direction_of(const TriangleDistance& closest) noexcept {
  const double d = std::sqrt(closest.squared);
  return d > 0.0 ? Vec3((closest.on_a - closest.on_b) / d) : Vec3(Vec3::Zero());
}

/// Pairs within a reach, visited several times in the trees' fixed order. If they exceed the memory, each
/// visit searches again.
struct PairsInReach {
  const PlacedSegment& segment;
  const ObjectTree& object;
  double reach;
  const NearPairs& near;

  /// Calls use(triangle, slot, closest points).
  template <class Use>
  void for_each(Use&& use) const noexcept {
    if (near.overflows()) {
      for_each_pair<Order::kFixed>(segment, object, squared(reach),
                                   [&](int triangle, int slot, const TriangleDistance& closest, double&) {
                                     use(triangle, slot, closest);
                                   });
      return;
    }
    for (std::size_t i = 0; i < near.count(); ++i) use(near[i].triangle, near[i].slot, near[i].closest);
  }
};

/// Returns the pair nearer than the cap that closes fastest.
Lead find_lead(const PairsInReach& pairs, double cap, const SegmentMotion& motion) noexcept {
  Lead lead{.motion = &motion};
  pairs.for_each([&](int, int slot, const TriangleDistance& closest) {
    if (closest.squared >= squared(cap)) return;
    const Vec3 n = direction_of(closest);
    const double speed = lead.closing_speed(n, closest.on_a);
    if (speed <= lead.speed) return;
    lead.speed = speed;
    lead.direction = n;
    lead.at = closest.on_a;
    lead.slot = slot;
  });
  return lead;
}

/// Returns the smallest distance below `cap` of the pairs that count [m].
double distance_of_admitted(const PairsInReach& pairs, double cap, const Lead& lead) noexcept {
  double best = squared(cap);
  pairs.for_each([&](int, int, const TriangleDistance& closest) {
    if (closest.squared < best && lead.admits(direction_of(closest), closest.on_a)) best = closest.squared;
  });
  return std::sqrt(best);
}

/// Returns the contact of the pairs that count and are within kPatchBand of `least`.
ContactPatch patch_of(const PlacedSegment& segment, const ObjectModel& object, const PairsInReach& pairs,
                      const Lead& lead, double least) noexcept {
  ContactPatch patch{
      .distance = least, .lead = lead.at, .lead_direction = lead.direction, .lead_slot = lead.slot};
  const ObjectTree& tree = object.tree();
  const double limit = least + kPatchBand;
  MeanDirection direction(std::sqrt(squared(limit) - squared(least)));
  TiedTriangles tied;
  double weight = 0.0;
  pairs.for_each([&](int triangle, int slot, const TriangleDistance& closest) {
    if (closest.squared > squared(limit)) return;
    const Vec3 n = direction_of(closest);
    if (!lead.admits(n, closest.on_a)) return;
    Corners corners = segment.tree.corners(triangle);
    for (Vec3& x : corners) x = segment.X_WS * x;
    TiedRegion region = tied_region(corners, tree.corners(slot), closest, limit, kPatchBand);
    region.weight *= (limit - std::sqrt(closest.squared)) / kPatchBand;
    patch.on_segment += region.weight * region.on_a;
    patch.on_object += region.weight * region.on_b;
    direction.add(closest, n, region.weight);
    weight += region.weight;
    ++patch.pairs;
    tied.add(slot);
  });
  patch.on_segment /= weight;
  patch.on_object /= weight;
  patch.direction = direction.unit();
  patch.object_normal = normal_at_contact(object, tied, patch.on_object, patch.direction);
  return patch;
}

}  // namespace

void NearPairs::find(const PlacedSegment& segment, const ObjectTree& object, double reach) noexcept {
  if (!carried_ && holds(segment.X_WS, reach)) return;
  X_WS_ = segment.X_WS;
  carried_ = false;
  reach_ = reach;
  least_squared_ = 1e300;
  count_ = 0;
  if (candidates_.cover(segment, reach)) return find_among_candidates(segment, object, reach);
  for_each_pair<Order::kFixed>(segment, object, squared(reach),
                               [&](int triangle, int slot, const TriangleDistance& closest, double&) {
                                 add({triangle, slot, closest});
                               });
}

void NearPairs::add(const Pair& pair) noexcept {
  if (count_ < kMost) pair_[count_] = pair;
  ++count_;
  least_squared_ = std::min(least_squared_, pair.closest.squared);
}

void NearPairs::find_among_candidates(const PlacedSegment& segment, const ObjectTree& object,
                                      double reach) noexcept {
  constexpr int kTogether = 64;
  std::array<CandidatePairs::Pair*, kTogether> candidate;
  std::array<search::PairIndex, kTogether> pair;
  std::array<search::PairDistance, kTogether> found;
  const search::SegmentView segment_view = search::view_of(segment, object);
  int n = 0;
  const auto measure = [&] {
    search::functions().measure(segment_view, search::view_of(object), pair.data(), n, found.data());
    for (int i = 0; i < n; ++i) {
      const search::PairDistance& p = found[idx(i)];
      candidates_.measured(*candidate[idx(i)], std::sqrt(p.squared));
      if (p.squared <= squared(reach)) add({p.pair.triangle, p.pair.slot, to_distance(p)});
    }
    n = 0;
  };
  candidates_.for_each(reach, [&](CandidatePairs::Pair& near) {
    candidate[idx(n)] = &near;
    pair[idx(n++)] = {near.triangle, near.slot};
    if (n == kTogether) measure();
  });
  measure();
}

void NearPairs::stop_at(const Pose& X_WS) noexcept {
  if (is_at(X_WS)) return;
  X_WS_ = X_WS;
  carried_ = false;
  reach_ = -1.0;
  least_squared_ = 1e300;
  count_ = 0;
}

double distance(const PlacedSegment& segment, const ObjectTree& object, double cap) noexcept {
  double best = squared(cap);
  for_each_pair<Order::kNearest>(segment, object, best,
                                 [&](int, int, const TriangleDistance& closest, double& cap_squared) {
                                   if (closest.squared < best) cap_squared = best = closest.squared;
                                 });
  return std::sqrt(best);
}

bool crosses(const PlacedSegment& segment, const ObjectTree& object) noexcept {
  if (segment.tree.empty() || object.empty()) return false;
  return search::functions().crosses(search::view_of(segment, object), search::view_of(object));
}

double distance_bound(const PlacedSegment& segment, const ObjectTree& object, double cap) noexcept {
  if (segment.tree.empty() || object.empty()) return cap;
  return search::functions().lower_bound(search::view_of(segment, object), search::view_of(object), cap);
}

ContactPatch contact_patch(const PlacedSegment& segment, const ObjectModel& object, double cap,
                           const SegmentMotion* motion, NearPairs& near) noexcept {
  // Without a motion every pair counts, and only the band above the nearest one need be listed.
  const ObjectTree& tree = object.tree();
  const bool every = motion == nullptr && !near.holds(segment.X_WS, cap + kPatchBand);
  const double nearest = every ? distance(segment, tree, cap) : cap;
  if (every && !(nearest < cap)) return {.distance = cap};
  near.find(segment, tree, nearest + kPatchBand);
  const PairsInReach pairs{segment, tree, nearest + kPatchBand, near};
  const Lead lead = motion == nullptr ? Lead{} : find_lead(pairs, cap, *motion);
  const double least = every ? nearest : distance_of_admitted(pairs, cap, lead);
  if (!(least < cap)) return {.distance = cap};
  return patch_of(segment, object, pairs, lead, least);
}

}  // namespace phalanx

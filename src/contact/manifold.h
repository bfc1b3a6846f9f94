// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "phalanx/contact/near_pairs.h"
#include "phalanx/contact/object_model.h"
#include "phalanx/contact/object_tree.h"
#include "phalanx/contact/proximity.h"

namespace phalanx {

/// Point at which a segment is near the object: of a pair of triangles that is nearer than its neighbours.
struct ContactPlace {
  std::int32_t triangle = 0;       ///< of the segment's mesh
  std::int32_t slot = 0;           ///< of the object's tree
  double gap = 0.0;                ///< distance [m]
  Vec3 on_segment = Vec3::Zero();  ///< closest points, in W [m]
  Vec3 on_object = Vec3::Zero();
  Vec3 direction = Vec3::Zero();  ///< unit vector from the object to the segment, in W
};

/// Contact manifold of one segment: up to kMost places, the nearest first.
struct Manifold {
  static constexpr int kMost = 4;
  int count = 0;
  std::array<ContactPlace, kMost> place;
};

/// Finds the places of a segment within `reach` of the object. Pairs whose points on the segment and directions
/// are near those of a nearer pair belong to its place. A pair is no place if a neighbouring triangle of either
/// mesh is nearer: on a flat, finely cut face these are the edges beside the nearest triangle.
/// @param reach  greatest distance that counts [m]. Where more pairs are within it than `near` holds, it is
/// reduced, at most to `least`
/// @param most   greatest number of places, at most Manifold::kMost
/// @param near   pairs of this segment and this object
/// Real-time: bounded, no allocation, lock, throw or I/O.
void find_manifold(const PlacedSegment& segment, const ObjectTree& object, double reach, double least,
                   int most, NearPairs& near, Manifold& out) noexcept;

/// Returns the object's normal at a place, within 30 degrees of its direction: normal_at_contact() of the triangles
/// that meet there.
/// @param place  its triangle may be -1: of any that is near
/// @param near   pairs of the segment's pose, within the place's gap and 10 um
/// Real-time: bounded, no allocation, lock, throw or I/O.
[[nodiscard]] Vec3 normal_at_place(const ObjectModel& object, const NearPairs& near,
                                   const ContactPlace& place) noexcept;

}  // namespace phalanx

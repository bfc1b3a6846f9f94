// SPDX-License-Identifier: Apache-2.0
// How near a segment is to the object, and where.                                          docs/contact.md
#pragma once

#include "phalanx/contact/object_model.h"
#include "phalanx/contact/segment_motion.h"
#include "phalanx/contact/segment_tree.h"

namespace phalanx {

/// A segment at a pose, and the memory that a search of it writes on: what every question needs.
struct PlacedSegment {
  const SegmentTree& tree;
  const Pose& X_WS;
  SearchScratch& scratch;  ///< fits the tree (asserted in debug); one search at a time
};

/// The smallest distance between the segment and the object if it is below `cap`, else `cap` [m]. 0 if they
/// cross. Real-time: no allocation, lock, throw or I/O.
[[nodiscard]] double distance(const PlacedSegment& segment, const ObjectTree& object, double cap) noexcept;

/// Whether the surfaces of the segment and the object cross or touch. Real-time.
[[nodiscard]] bool crosses(const PlacedSegment& segment, const ObjectTree& object) noexcept;

/// A lower bound on that distance, at most `cap` [m]: as a rule 0.8 of it or more; less, down to 0, where 256
/// pairs of triangles do not settle it. Found much sooner. Real-time.
[[nodiscard]] double distance_bound(const PlacedSegment& segment, const ObjectTree& object,
                                    double cap) noexcept;

/// One contact out of all pairs at nearly the same distance.
struct ContactPatch {
  double distance = 0.0;  ///< the least [m]
  Vec3 on_segment =
      Vec3::Zero();  ///< mean of the closest points on the segment, over the region where they tie, W [m]
  Vec3 on_object = Vec3::Zero();  ///< mean of the closest points on the object, W [m]
  Vec3 direction =
      Vec3::Zero();  ///< unit vector from the object to the segment: mean of the pairs' directions, W
  Vec3 object_normal =
      Vec3::Zero();  ///< the object's interpolated normal there, on the side of `direction`, unit; at a
                     ///< crease the direction between its faces' normals that is nearest to `direction`; W
  int pairs = 0;     ///< 0: nothing is within the cap
  Vec3 lead = Vec3::Zero();  ///< closest point on the segment of the pair that closes fastest, W [m]
  Vec3 lead_direction = Vec3::Zero();  ///< of that pair; zero if none closes, or no motion was given; W
};

/// Pairs whose distance is within `kPatchBand` of the least, in the trees' fixed order, so that a flat touch
/// does not pick a corner by chance.
inline constexpr double kPatchBand = 5e-6;
/// @param motion  null, or the motion that the contact stops: then walls that the segment does not run into
/// do not count beside the one that it
///                does. A pair counts if it faces within 30 degrees of the fastest closing one, or closes at
///                least half as fast.
/// Real-time.
[[nodiscard]] ContactPatch contact_patch(const PlacedSegment& segment, const ObjectModel& object, double cap,
                                         const SegmentMotion* motion = nullptr) noexcept;

}  // namespace phalanx

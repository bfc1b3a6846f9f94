// SPDX-License-Identifier: Apache-2.0
// Distance of a segment from the object, and the contact at the closest points. See docs/contact.md.
#pragma once

#include "phalanx/contact/object_model.h"
#include "phalanx/contact/object_tree.h"
#include "phalanx/contact/segment_motion.h"
#include "phalanx/contact/segment_tree.h"

namespace phalanx {

/// A segment at a pose, with the scratch memory of its search: input of each query.
struct PlacedSegment {
  const SegmentTree& tree;
  const Pose& X_WS;
  SearchScratch& scratch;  ///< fits the tree (asserted in debug); one search at a time
};

/// Returns the smallest distance between the segment and the object, at most `cap` [m]; 0 if they cross.
/// Real-time: no allocation, lock, throw or I/O.
[[nodiscard]] double distance(const PlacedSegment& segment, const ObjectTree& object, double cap) noexcept;

/// @returns true if the surfaces of the segment and the object cross or touch. The work is bounded for any
/// mesh. So the answer is also true if 512 pairs of triangles do not decide it, as near thousands of slivers
/// that meet in a point. Real-time.
[[nodiscard]] bool crosses(const PlacedSegment& segment, const ObjectTree& object) noexcept;

/// Returns a lower bound on that distance, at most `cap` [m], much faster than the distance. As a rule it is
/// 0.8 of the distance or more. It is less, down to 0, if 256 pairs of triangles do not suffice. Real-time.
[[nodiscard]] double distance_bound(const PlacedSegment& segment, const ObjectTree& object,
                                    double cap) noexcept;

/// One contact computed from all pairs of triangles at nearly the same distance.
struct ContactPatch {
  double distance = 0.0;  ///< the least distance of a pair [m]
  /// Mean of the closest points on the segment, over the region where they tie, in W [m].
  Vec3 on_segment = Vec3::Zero();
  Vec3 on_object = Vec3::Zero();  ///< mean of the closest points on the object, W [m]
  /// Unit vector from the object to the segment: the mean of the pairs' directions, in W.
  Vec3 direction = Vec3::Zero();
  /// The object's interpolated unit normal there, on the side of `direction`, in W. At a crease it is the
  /// direction between its faces' normals that is nearest to `direction`.
  Vec3 object_normal = Vec3::Zero();
  int pairs = 0;             ///< 0: nothing is within the cap
  Vec3 lead = Vec3::Zero();  ///< closest point on the segment of the pair that closes fastest, W [m]
  /// Direction of the pair that closes fastest, in W. Zero if none closes, or if no motion was given.
  Vec3 lead_direction = Vec3::Zero();
  int lead_slot = 0;  ///< of that pair's triangle of the object
};

/// Band above the least distance within which pairs count [m]. They are summed in the trees' fixed order, so
/// that the contact of a flat touch is not at an arbitrary corner.
inline constexpr double kPatchBand = 5e-6;
/// Returns the contact of the segment with the object; pairs = 0 if no pair is nearer than `cap`.
/// @param cap     greatest distance that counts [m]
/// @param motion  null, or the motion that the contact stops. With a motion, surfaces that the segment does
/// not run into do not count. A pair counts if it faces within 30 degrees of the fastest closing one, or
/// closes at least half as fast.
/// @param near    pairs of this segment and this object; those that it holds are not searched again
/// Real-time: bounded, no allocation, lock, throw or I/O.
[[nodiscard]] ContactPatch contact_patch(const PlacedSegment& segment, const ObjectModel& object, double cap,
                                         const SegmentMotion* motion, NearPairs& near) noexcept;
/// The same with the scratch's memory, cleared before.
[[nodiscard]] inline ContactPatch contact_patch(const PlacedSegment& segment, const ObjectModel& object,
                                                double cap, const SegmentMotion* motion = nullptr) noexcept {
  segment.scratch.near().clear();
  return contact_patch(segment, object, cap, motion, segment.scratch.near());
}

}  // namespace phalanx

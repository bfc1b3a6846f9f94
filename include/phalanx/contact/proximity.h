// SPDX-License-Identifier: Apache-2.0
// The questions that the GDP asks of a segment and the object. This is the seam behind which the search may
// become fast: whatever answers these three exactly may stand here.
#pragma once

#include "phalanx/contact/object_model.h"
#include "phalanx/contact/triangle_tree.h"

namespace phalanx {

/// The velocity field of a rigid segment as the path parameter s runs, v(x) = angular x x + linear, per unit
/// of s, with bounds that hold along the whole path.
struct SegmentMotion {
  Vec3 angular = Vec3::Zero();  ///< [rad]
  Vec3 linear = Vec3::Zero();   ///< at the world's origin [m]
  double speed = 0.0;           ///< |dx/ds| <= speed for every point of the segment [m]
  double acceleration = 0.0;    ///< |d2x/ds2| <= acceleration for every point of the segment [m]
};

/// How far the segment may go on.
struct Advance {
  double step = 0.0;     ///< the path parameter may grow by this much: no pair gets closer than `floor`
  bool blocked = false;  ///< some pair is within the margin and closing
  bool near = false;     ///< some pair may be within the margin at the end of the step
};

/// Clearances at which a segment stops [m].
struct StopBand {
  double margin;  ///< a pair at this distance or less that closes is a contact
  double floor;   ///< no pair is let closer than this; below the margin by less than 10 nm
};
[[nodiscard]] constexpr StopBand stop_band(double margin) noexcept { return {margin, margin - 5e-9}; }

/// Conservative advancement, pair by pair: over a step h a point at height z above the plane between a pair's
/// closest points, closing at speed v, keeps at least z - v h - A h^2 / 2. The least safe h over all pairs of
/// triangles, at most `longest`. (Mirtich's directional bound, taken for each pair of triangles rather than
/// for the whole body.)
/// @param segment  the segment's tree, placed in W at the current s
/// Real-time: no allocation, lock, throw or I/O.
[[nodiscard]] Advance safe_advance(const TriangleTree& segment, const TriangleTree& object,
                                   const SegmentMotion& motion, double longest,
                                   const StopBand& band) noexcept;

/// The smallest distance between the segment and the object if it is below `cap`, else `cap` [m]. 0 if they
/// cross. Real-time.
[[nodiscard]] double distance(const TriangleTree& segment, const TriangleTree& object, double cap) noexcept;

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
};

/// Pairs whose distance is within `kPatchBand` of the least, in the trees' fixed order, so that a flat touch
/// does not pick a corner by chance.
inline constexpr double kPatchBand = 5e-6;
/// @param motion  null, or the motion that the contact stops: then walls that the segment does not run into
/// do not count beside the one that it
///                does. A pair counts if it faces within 30 degrees of the fastest closing one, or closes at
///                least half as fast.
[[nodiscard]] ContactPatch contact_patch(const TriangleTree& segment, const ObjectModel& object, double cap,
                                         const SegmentMotion* motion = nullptr) noexcept;

}  // namespace phalanx

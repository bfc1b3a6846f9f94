// SPDX-License-Identifier: Apache-2.0
// The memory of the two search trees: plain arrays, eight of a kind side by side, so that one instruction
// tests many. No code, no other header: the searches read it in translation units that are compiled for wider
// instruction sets.
#pragma once

#include <cstdint>

namespace phalanx {

/// Children of a node and triangles of a block.
inline constexpr int kWide = 8;

/// Eight boxes of the object, in single precision, rounded outwards, relative to ObjectTree::centre() [m],
/// and eight slabs: what is in the box is also between the heights `low` and `high` along `axis`, which for a
/// patch of surface is much thinner. Lane 0 of node 0 is the root. An empty lane's box is inside out and
/// meets nothing.
struct alignas(32) BoxNode {
  float min[3][kWide];
  float max[3][kWide];
  float axis[3][kWide];  ///< unit
  float low[kWide];
  float high[kWide];
  std::int32_t child[kWide];  ///< >= 0: a node; < 0: ~block
};

/// Eight triangles of the object in the world frame, [corner][axis][lane] [m]. The last block repeats its
/// last triangle in lanes that it cannot fill.
struct alignas(64) TriangleBlock {
  double corner[3][3][kWide];
};

/// Eight lenses of a segment, in the segment's frame: each holds the points within `radius` of `centre` and
/// within `half` of the plane through it with unit normal `axis` [m]. Thin where a box would be thick: a
/// patch of skin. Lane 0 of node 0 is the root's lens. An empty lane's radius is negative and meets nothing.
struct alignas(32) LensNode {
  float centre[3][kWide];
  float axis[3][kWide];
  float radius[kWide];
  float half[kWide];
  std::int32_t child[kWide];  ///< >= 0: a node; < 0: ~triangle
};

/// A segment's triangle in the segment's frame, [corner][axis] [m].
struct SegmentTriangle {
  double corner[3][3];
};

/// The lenses of a node at the pose that is being searched.
struct alignas(32) PlacedLenses {
  float centre[3][kWide];  ///< relative to ObjectTree::centre() [m]
  float axis[3][kWide];    ///< in W
  float way[3][kWide];     ///< how far the centre goes within the horizon, to first order [m]
  std::uint64_t query;     ///< the query that placed them
};

/// A segment's triangle at the pose that is being searched.
struct PlacedTriangle {
  double corner[3][3];  ///< in W [m]
  double normal[3];     ///< unit, or zero where the triangle has none
  double first[3][3];   ///< how far a corner goes within the horizon, to first order [m]
  double second[3][3];  ///< what the second order adds
  double above;         ///< how far any corner gets above the triangle's plane in that time [m]
  double below;         ///< and below
  std::uint64_t query;  ///< the query that placed it
};

}  // namespace phalanx

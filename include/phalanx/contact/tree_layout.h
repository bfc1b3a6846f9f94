// SPDX-License-Identifier: Apache-2.0
// Memory layout of the two search trees: plain arrays, eight numbers of a kind side by side for vector
// instructions. The header contains no code and includes no other header of the project. The searches read it
// in translation units that are compiled for wider instruction sets.
#pragma once

#include <cstdint>

namespace phalanx {

/// Number of children of a node and of triangles of a block.
inline constexpr int kWide = 8;

/// Eight boxes of the object, relative to ObjectTree::centre() [m], in single precision rounded outwards.
/// Each box also has a slab: its contents lie between the heights `low` and `high` along `axis`. A patch of
/// surface has a slab much thinner than its box. Lane 0 of node 0 is the root. An empty lane's box is inside
/// out, so that nothing overlaps it.
struct alignas(32) BoxNode {
  float min[3][kWide];
  float max[3][kWide];
  float axis[3][kWide];  ///< unit
  float low[kWide];
  float high[kWide];
  std::int32_t child[kWide];  ///< >= 0: a node; < 0: ~block
};

/// Eight triangles of the object in the world frame, [corner][axis][lane] [m]. The last block repeats its
/// last triangle in unused lanes.
struct alignas(64) TriangleBlock {
  double corner[3][3][kWide];
};

/// Eight lenses of a segment, in the segment's frame. A lens holds the points within `radius` of `centre`
/// and within `half` of the plane through it with unit normal `axis` [m]. Around a patch of skin it is
/// thinner than a box. Lane 0 of node 0 is the root's lens. An empty lane's radius is negative, so that
/// nothing overlaps it.
struct alignas(32) LensNode {
  float centre[3][kWide];
  float axis[3][kWide];
  float radius[kWide];
  float half[kWide];
  std::int32_t child[kWide];  ///< >= 0: a node; < 0: ~triangle
};

/// Triangle of a segment in the segment's frame, [corner][axis] [m].
struct SegmentTriangle {
  double corner[3][3];
};

/// Lenses of a node at the query's pose.
struct alignas(32) PlacedLenses {
  float centre[3][kWide];  ///< relative to ObjectTree::centre() [m]
  float axis[3][kWide];    ///< in W
  float way[3][kWide];     ///< displacement of the centre within the horizon, to first order [m]
  std::uint64_t query;     ///< the query that placed them
};

/// Triangle of a segment at the query's pose.
struct PlacedTriangle {
  double corner[3][3];  ///< in W [m]
  double normal[3];     ///< unit, or zero if the triangle has no area
  double first[3][3];   ///< displacement of a corner within the horizon, to first order [m]
  double second[3][3];  ///< the second-order part of it [m]
  double above;         ///< greatest height of any corner above the triangle's plane [m]
  double below;         ///< the same below the plane [m]
  std::uint64_t query;  ///< the query that placed it
};

}  // namespace phalanx

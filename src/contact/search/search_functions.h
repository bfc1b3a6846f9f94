// SPDX-License-Identifier: Apache-2.0
// Interface of the contact search's inner loops: plain data and function pointers, one set of functions for
// each instruction set. tree_layout.h describes the trees.
#pragma once

#include <cstdint>

#include "phalanx/contact/tree_layout.h"

namespace phalanx::search {

/// Segment at one pose, with memory for its lenses and triangles, which a query places on first use.
struct SegmentView {
  const LensNode* nodes;
  const SegmentTriangle* triangles;
  PlacedLenses* lenses;
  PlacedTriangle* placed;
  std::uint64_t query;
  double R[3][3];  ///< X_WS
  double p[3];
  float lens_R[3][3];  ///< the same for lenses: rounded, relative to the object tree's centre
  float lens_p[3];
  double object_centre[3];  ///< ObjectTree::centre()
  float slack;              ///< greatest rounding error of a lens against a box [m]
};

/// Object's search tree.
struct ObjectView {
  const BoxNode* nodes;
  const TriangleBlock* blocks;
  std::int32_t size;  ///< number of slots; the last block's lanes beyond it repeat a triangle
};

/// Motion of a segment's points with the path parameter, from the pose on, per unit of the parameter [m]. A
/// point x has the velocity v = angular x x + linear, and the acceleration angular_rate x x + linear_rate +
/// angular x v. No point's first, second or third derivative ever exceeds `speed`, `bend` or `jerk`.
struct MotionView {
  double angular[3];
  double linear[3];
  double angular_rate[3];
  double linear_rate[3];
  double speed;
  double bend;
  double jerk;
};

/// Pair of triangles: index of the segment's, and slot of the object's.
struct PairIndex {
  std::int32_t triangle;
  std::int32_t slot;
};

/// Closest points of a pair of triangles.
struct PairDistance {
  PairIndex pair;
  double squared;  ///< [m^2]
  double on_segment[3];
  double on_object[3];
};

/// Callback that receives pairs in a fixed order. It may lower the cap, but not below 0 [m^2].
using PairSink = void (*)(void* context, const PairDistance& pair, double& cap_squared);

/// Callback that receives pairs in a fixed order, each with a lower bound on its distance [m], which may be
/// negative. It returns the cap from there on [m], at most the one before. A negative cap ends the search.
using BoundSink = double (*)(void* context, const PairIndex& pair, double bound);

/// Buffer for pairs. If a gather has too little room for a block, it calls make_room, which must make enough.
struct PairStore {
  PairIndex* pair;
  int count;
  int capacity;
  double horizon;  ///< increase of the parameter to cover; make_room may lower it
  void (*make_room)(void* context);
  void* context;
};

/// Possible advance of a pair.
struct PairStep {
  double step;   ///< increase of the parameter during which the pair stays above the floor
  bool blocked;  ///< within the margin and closing
  bool near;     ///< may be within the margin at the end of the horizon
};

/// Inner loops of one instruction set. Real-time: no allocation, lock, throw or I/O.
struct SearchFunctions {
  /// Hands every pair whose squared distance is at most the cap to the sink.
  void (*visit)(const SegmentView& segment, const ObjectView& object, double cap_squared, bool nearest_first,
                PairSink sink, void* context);
  /// @returns true if the surfaces cross or touch, or if 1,024 pairs of lens and box or 512 pairs of
  /// triangles do not decide it
  bool (*crosses)(const SegmentView& segment, const ObjectView& object);
  /// Returns a lower bound on the distance, at most `cap` [m]. As a rule it is 0.8 of the distance or more.
  /// It is less, down to 0, if 256 pairs do not suffice.
  double (*lower_bound)(const SegmentView& segment, const ObjectView& object, double cap);
  /// Collects all pairs that may come within `margin` before the parameter has grown by store.horizon,
  /// and some more.
  void (*gather)(const SegmentView& segment, const ObjectView& object, const MotionView& motion,
                 double margin, PairStore& store);
  /// Computes how far each of n pairs may advance.
  void (*advance)(const SegmentView& segment, const ObjectView& object, const MotionView& motion,
                  double horizon, double margin, double floor, const PairIndex* pairs, int n, PairStep* out);
  /// Computes the closest points of two triangles, [corner][axis].
  void (*closest)(const double (*a)[3], const double (*b)[3], PairDistance& out);
  /// Hands every pair to the sink that the plane of neither triangle separates by more than `cap` [m], in the order
  /// of visit(). The bound is that separation.
  void (*list)(const SegmentView& segment, const ObjectView& object, double cap, BoundSink sink,
               void* context);
  /// Computes the closest points of n pairs, with the bits of visit().
  void (*measure)(const SegmentView& segment, const ObjectView& object, const PairIndex* pairs, int n,
                  PairDistance* out);
  /// Keeps those of n pairs, in order, that the plane of neither triangle separates by more than `margin` until the
  /// parameter has grown by `horizon`.
  /// @returns their number
  int (*sift)(const SegmentView& segment, const ObjectView& object, const MotionView& motion, double horizon,
              double margin, PairIndex* pairs, int n);
};

/// Return the functions of one instruction set, or null if the program was built without it.
const SearchFunctions* portable_functions() noexcept;
const SearchFunctions* avx2_functions() noexcept;
const SearchFunctions* avx512_functions() noexcept;
/// Returns the functions in use.
const SearchFunctions& functions() noexcept;

}  // namespace phalanx::search

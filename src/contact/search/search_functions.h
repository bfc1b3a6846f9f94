// SPDX-License-Identifier: Apache-2.0
// The contact search's inner loops as they are called: plain data and function pointers, one set of functions
// for each instruction set. What they look into is laid out in tree_layout.h.
#pragma once

#include <cstdint>

#include "phalanx/contact/tree_layout.h"

namespace phalanx::search {

/// A segment at one pose, and where its lenses and triangles are placed when a query first looks at them.
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

struct ObjectView {
  const BoxNode* nodes;
  const TriangleBlock* blocks;
  std::int32_t size;  ///< slots; the last block's lanes beyond it repeat one
};

/// How the points of a segment move with the path parameter, from the pose on: at x the velocity is
/// angular x x + linear, its rate of change angular_rate x x + linear_rate + angular x velocity. No point's
/// first, second or third derivative is ever above `speed`, `bend` or `jerk`. Per unit of the parameter [m].
struct MotionView {
  double angular[3];
  double linear[3];
  double angular_rate[3];
  double linear_rate[3];
  double speed;
  double bend;
  double jerk;
};

/// A pair of triangles: the segment's and the object's slot.
struct PairIndex {
  std::int32_t triangle;
  std::int32_t slot;
};

struct PairDistance {
  PairIndex pair;
  double squared;  ///< [m^2]
  double on_segment[3];
  double on_object[3];
};

/// Receives pairs in a fixed order; may lower the cap [m^2].
using PairSink = void (*)(void* context, const PairDistance& pair, double& cap_squared);

/// Room for pairs. A gather that has not enough for a block calls make_room, which must leave room for one.
struct PairStore {
  PairIndex* pair;
  int count;
  int capacity;
  double horizon;  ///< how far the parameter is to grow; make_room may lower it
  void (*make_room)(void* context);
  void* context;
};

/// How far a pair may go on.
struct PairStep {
  double step;   ///< the parameter may grow by this much before the pair is nearer than the floor
  bool blocked;  ///< within the margin and closing
  bool near;     ///< may be within the margin at the end of the horizon
};

struct SearchFunctions {
  /// Every pair whose squared distance is at most the cap.
  void (*visit)(const SegmentView& segment, const ObjectView& object, double cap_squared, bool nearest_first,
                PairSink sink, void* context);
  /// A lower bound on the distance, at most `cap` [m]; as a rule 0.8 of it or more; less, down to 0,
  /// where 256 pairs do not settle it.
  double (*lower_bound)(const SegmentView& segment, const ObjectView& object, double cap);
  /// All pairs that might come within `margin` before the parameter has grown by store.horizon, and some
  /// more.
  void (*gather)(const SegmentView& segment, const ObjectView& object, const MotionView& motion,
                 double margin, PairStore& store);
  /// What each of n pairs allows.
  void (*advance)(const SegmentView& segment, const ObjectView& object, const MotionView& motion,
                  double horizon, double margin, double floor, const PairIndex* pairs, int n, PairStep* out);
  /// The closest points of two triangles, [corner][axis].
  void (*closest)(const double (*a)[3], const double (*b)[3], PairDistance& out);
};

/// What the processor was asked to use. Null where the program has none for this set.
const SearchFunctions* portable_functions() noexcept;
const SearchFunctions* avx2_functions() noexcept;
const SearchFunctions* avx512_functions() noexcept;
/// Those in use.
const SearchFunctions& functions() noexcept;

}  // namespace phalanx::search

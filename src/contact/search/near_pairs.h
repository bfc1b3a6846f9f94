// SPDX-License-Identifier: Apache-2.0
// Pairs of triangles by distance: all pairs within a cap, a crossing test, lower bounds, and given pairs.
#pragma once

#include "contact/search/lens_box.h"
#include "contact/search/placed_triangle.h"
#include "contact/search/search_functions.h"
#include "contact/search/triangle_pair.h"

namespace phalanx::search::PHALANX_SEARCH_SET {

/// Returns one number of each of several pairs, side by side.
template <class At>
PHALANX_INLINE Doubles each(At&& at) noexcept {
#if PHALANX_DOUBLES == 8
  return Doubles{at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)};
#elif PHALANX_DOUBLES == 4
  return Doubles{at(0), at(1), at(2), at(3)};
#else
  return Doubles{at(0), at(1)};
#endif
}

/// Returns the object's triangles of several pairs.
PHALANX_INLINE Triangles object_triangles(const ObjectView& object, const PairIndex* pairs) noexcept {
  const TriangleBlock* block[kDoubles];
  int lane[kDoubles];
  for (int l = 0; l < kDoubles; ++l) {
    block[l] = object.blocks + pairs[l].slot / kWide;
    lane[l] = pairs[l].slot % kWide;
  }
  Triangles t;
  for (int c = 0; c < 3; ++c) {
    const auto axis = [&](int k) { return each([&](int l) { return block[l]->corner[c][k][lane[l]]; }); };
    t.corner[c] = {axis(0), axis(1), axis(2)};
  }
  return t;
}

/// Queue of pairs whose exact distance is computed several at a time. It takes eight pairs whatever the
/// number of lanes. Their results decide which pairs follow, and this must not depend on the number of lanes.
class Waiting {
 public:
  Waiting(const SegmentView& segment, const ObjectView& object) noexcept
      : segment_(segment), object_(object) {}

  /// Adds a pair whose segment triangle is placed.
  /// @returns true if the queue is full and must be taken
  PHALANX_INLINE bool add(const PairIndex& pair) noexcept {
    pair_[count_++] = pair;
    return count_ == kWide;
  }
  /// Hands each pair's lane of the closest points to use(pair, closest, lane), in order of arrival, and
  /// empties the queue.
  template <class Use>
  PHALANX_INLINE void take(Use&& use) noexcept {
    for (int first = 0; first < count_; first += kDoubles) {
      PairIndex some[kDoubles];
      for (int l = 0; l < kDoubles; ++l) some[l] = pair_[first + l < count_ ? first + l : count_ - 1];
      Triangles mine;
      for (int c = 0; c < 3; ++c) {
        const auto axis = [&](int k) {
          return each([&](int l) { return segment_.placed[some[l].triangle].corner[c][k]; });
        };
        mine.corner[c] = {axis(0), axis(1), axis(2)};
      }
      const Closest closest = closest_points(mine, object_triangles(object_, some));
      for (int l = 0; l < kDoubles && first + l < count_; ++l) use(some[l], closest, l);
    }
    count_ = 0;
  }

 private:
  const SegmentView& segment_;
  const ObjectView& object_;
  PairIndex pair_[kWide];
  int count_ = 0;
};

/// Implements SearchFunctions::visit.
inline void visit(const SegmentView& segment, const ObjectView& object, double cap_squared,
                  bool nearest_first, PairSink sink, void* context) noexcept {
  const Sweep still{nullptr, 0.0, 0.0};
  double cap = 0.0;
  float box_cap = 0.0F;
  const auto look_no_farther = [&] {
    cap = square_root(all(cap_squared))[0] * 1.000000001;
    box_cap = single_cap(cap);
  };
  look_no_farther();
  Waiting waiting(segment, object);
  const auto flush = [&] {
    waiting.take([&](const PairIndex& pair, const Closest& closest, int l) {
      if (!(closest.squared[l] <= cap_squared)) return;
      const PairDistance found{pair,
                               closest.squared[l],
                               {closest.on_a.x[l], closest.on_a.y[l], closest.on_a.z[l]},
                               {closest.on_b.x[l], closest.on_b.y[l], closest.on_b.z[l]}};
      sink(context, found, cap_squared);
    });
    look_no_farther();
  };
  const auto leaf = [&](std::int32_t triangle, std::int32_t block, float) {
    const PlacedTriangle& s = placed_triangle(segment, triangle, still);
    for (int i = 0; i < kWide; i += kDoubles) {
      const Doubles apart = separation(s, block_triangles(object.blocks[block], i), still);
      for (unsigned left = double_bits(apart <= cap); left != 0; left &= left - 1) {
        const std::int32_t slot = block * kWide + i + __builtin_ctz(left);
        if (slot >= object.size) break;
        if (waiting.add({triangle, slot})) flush();
      }
    }
  };
  const LensMotion no_motion{};
  Walk<false> walk(segment, object, no_motion);
  const auto wanted = [&](float bound) { return bound <= box_cap; };
  if (nearest_first) {
    walk.run<true>(box_cap, wanted, leaf);
  } else {
    walk.run<false>(box_cap, wanted, leaf);
  }
  flush();
}

/// Implements SearchFunctions::list.
inline void list(const SegmentView& segment, const ObjectView& object, double cap, BoundSink sink,
                 void* context) noexcept {
  const Sweep still{nullptr, 0.0, 0.0};
  double limit = 0.0;
  float box_cap = 0.0F;
  bool wanted = true;
  const auto look_no_farther = [&] {
    limit = cap * 1.000000001;
    box_cap = single_cap(limit);
    wanted = cap >= 0.0;
  };
  look_no_farther();
  const LensMotion no_motion{};
  Walk<false> walk(segment, object, no_motion);
  walk.run<false>(
      box_cap, [&](float bound) { return wanted && bound <= box_cap; },
      [&](std::int32_t triangle, std::int32_t block, float) {
        const PlacedTriangle& s = placed_triangle(segment, triangle, still);
        for (int i = 0; i < kWide && wanted; i += kDoubles) {
          const Doubles apart = separation(s, block_triangles(object.blocks[block], i), still);
          for (unsigned left = double_bits(apart <= limit); left != 0 && wanted; left &= left - 1) {
            const int l = __builtin_ctz(left);
            const std::int32_t slot = block * kWide + i + l;
            if (slot >= object.size) break;
            if (apart[l] > limit) continue;
            cap = sink(context, {triangle, slot}, apart[l]);
            look_no_farther();
          }
        }
      });
}

/// Implements SearchFunctions::measure.
inline void measure(const SegmentView& segment, const ObjectView& object, const PairIndex* pairs, int n,
                    PairDistance* out) noexcept {
  const Sweep still{nullptr, 0.0, 0.0};
  Waiting waiting(segment, object);
  const auto write = [&](const PairIndex& pair, const Closest& closest, int l) {
    *out++ = {pair,
              closest.squared[l],
              {closest.on_a.x[l], closest.on_a.y[l], closest.on_a.z[l]},
              {closest.on_b.x[l], closest.on_b.y[l], closest.on_b.z[l]}};
  };
  for (int i = 0; i < n; ++i) {
    (void)placed_triangle(segment, pairs[i].triangle, still);
    if (waiting.add(pairs[i])) waiting.take(write);
  }
  waiting.take(write);
}

/// Implements SearchFunctions::crosses: visits the deepest pairs first, until a pair touches. If kMostPairs
/// pairs of lens and box or kMostExact pairs of triangles do not decide, the result is true. The shipped
/// objects with fingers in them take less than half of that.
inline bool crosses(const SegmentView& segment, const ObjectView& object) noexcept {
  constexpr int kMostPairs = 1024;
  constexpr int kMostExact = 512;
  const Sweep still{nullptr, 0.0, 0.0};
  const float box_cap = single_cap(0.0);
  bool touches = false;
  bool unsettled = false;
  int pairs = 0;
  int exact = 0;
  const auto wanted = [&](float) {
    if (touches || unsettled) return false;
    unsettled = pairs >= kMostPairs || exact >= kMostExact;
    ++pairs;
    return !unsettled;
  };
  Waiting waiting(segment, object);
  const auto flush = [&] {
    waiting.take([&](const PairIndex&, const Closest& closest, int l) {
      touches = touches || closest.squared[l] <= 0.0;
    });
  };
  const LensMotion no_motion{};
  Walk<false> walk(segment, object, no_motion);
  walk.run<true>(box_cap, wanted, [&](std::int32_t triangle, std::int32_t block, float) {
    const PlacedTriangle& s = placed_triangle(segment, triangle, still);
    for (int i = 0; i < kWide; i += kDoubles) {
      const Doubles apart = separation(s, block_triangles(object.blocks[block], i), still);
      for (unsigned left = double_bits(apart <= 0.0); left != 0; left &= left - 1) {
        const std::int32_t slot = block * kWide + i + __builtin_ctz(left);
        if (slot >= object.size) break;
        ++exact;
        if (waiting.add({triangle, slot})) flush();
      }
    }
  });
  flush();
  return touches || unsettled;
}

/// Implements SearchFunctions::lower_bound: visits the nearest pairs first. A bound of at least kEnough times
/// the best distance is taken instead of the exact distance. So is every bound after kMostExact pairs. The
/// result must be fast, not tight.
inline double lower_bound(const SegmentView& segment, const ObjectView& object, double cap) noexcept {
  constexpr double kEnough = 0.8;
  constexpr int kMostExact = 256;
  const Sweep still{nullptr, 0.0, 0.0};
  double best = cap;
  double believed = cap;
  float box_cap = single_cap(cap);
  int looked_into = 0;
  const auto is_enough = [&](double bound) {
    if (bound < kEnough * best && looked_into < kMostExact) return false;
    believed = bound < believed ? bound : believed;
    return true;
  };
  Waiting waiting(segment, object);
  const auto flush = [&] {
    waiting.take([&](const PairIndex&, const Closest& closest, int l) {
      const double exact = square_root(all(closest.squared[l]))[0];
      best = exact < best ? exact : best;
      ++looked_into;
    });
    box_cap = single_cap(best);
  };
  const LensMotion no_motion{};
  Walk<false> walk(segment, object, no_motion);
  walk.run<true>(
      box_cap, [&](float bound) { return !is_enough(static_cast<double>(bound)); },
      [&](std::int32_t triangle, std::int32_t block, float bound) {
        const PlacedTriangle& s = placed_triangle(segment, triangle, still);
        for (int i = 0; i < kWide; i += kDoubles) {
          const Doubles apart = most(separation(s, block_triangles(object.blocks[block], i), still),
                                     all(static_cast<double>(bound)));
          for (int l = 0; l < kDoubles && block * kWide + i + l < object.size; ++l) {
            if (is_enough(apart[l])) continue;
            if (waiting.add({triangle, block * kWide + i + l})) flush();
          }
        }
      });
  flush();
  const double found = best < believed ? best : believed;
  return found < cap ? greater(found * 0.999999999, 0.0) : cap;
}

}  // namespace phalanx::search::PHALANX_SEARCH_SET

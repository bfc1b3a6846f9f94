// SPDX-License-Identifier: Apache-2.0
// Pairs of triangles by their distance: all within a cap, and a bound on the least.
#pragma once

#include "contact/search/lens_box.h"
#include "contact/search/placed_triangle.h"
#include "contact/search/search_functions.h"
#include "contact/search/triangle_pair.h"

namespace phalanx::search::PHALANX_SEARCH_SET {

/// One number of each of several pairs, side by side.
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

/// The object's triangles of several pairs.
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

/// Pairs on their way to the exact distance, which is found for several at once. However many lanes there
/// are, eight wait: what is known after them decides what is looked at next, and must not depend on the
/// lanes.
class Waiting {
 public:
  Waiting(const SegmentView& segment, const ObjectView& object) noexcept
      : segment_(segment), object_(object) {}

  /// The pair's segment triangle is placed. @returns whether it is time to take them
  PHALANX_INLINE bool add(const PairIndex& pair) noexcept {
    pair_[count_++] = pair;
    return count_ == kWide;
  }
  /// Hands each pair's lane of the closest points to use(pair, closest, lane), in the order in which they
  /// came; then none waits.
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

/// Nearest first, and what is not nearer than kEnough of the best so far is believed and not looked into;
/// after kMostExact pairs nothing is: a bound need not be tight, but it must come soon.
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

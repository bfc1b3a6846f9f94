// SPDX-License-Identifier: Apache-2.0
// Lower bounds on the distance of lenses and boxes, eight at a time, and the traversal of both trees.
#pragma once

#include "contact/search/pack.h"
#include "contact/search/search_functions.h"

namespace phalanx::search::PHALANX_SEARCH_SET {

/// Motion of lenses within a horizon h, in single precision.
struct LensMotion {
  float angular[3];  ///< h times the angular velocity [rad]
  float linear[3];   ///< h times the velocity at the object tree's centre [m]
  float spin;        ///< upper bound on the length of `angular`
  float bend;        ///< upper bound on the higher-order displacement of any point [m]
  float reach;       ///< upper bound on the displacement of any point [m]
};

/// Moves a node's lenses to the pose of the query, on first use.
template <bool kMoving>
PHALANX_INLINE const PlacedLenses& placed_lenses(const SegmentView& segment, const LensMotion& motion,
                                                 std::int32_t node) noexcept {
  PlacedLenses& placed = segment.lenses[node];
  if (placed.query == segment.query) return placed;
  placed.query = segment.query;
  const LensNode& rest = segment.nodes[node];
  for (int i = 0; i < kWide; i += kFloats) {
    const Floats c[3] = {load(rest.centre[0] + i), load(rest.centre[1] + i), load(rest.centre[2] + i)};
    const Floats a[3] = {load(rest.axis[0] + i), load(rest.axis[1] + i), load(rest.axis[2] + i)};
    Floats x[3];
    for (int k = 0; k < 3; ++k) {
      const float(&row)[3] = segment.lens_R[k];
      x[k] = row[0] * c[0] + row[1] * c[1] + row[2] * c[2] + segment.lens_p[k];
      store(x[k], placed.centre[k] + i);
      store(row[0] * a[0] + row[1] * a[1] + row[2] * a[2], placed.axis[k] + i);
    }
    if constexpr (kMoving) {
      const float(&w)[3] = motion.angular;
      store(w[1] * x[2] - w[2] * x[1] + motion.linear[0], placed.way[0] + i);
      store(w[2] * x[0] - w[0] * x[2] + motion.linear[1], placed.way[1] + i);
      store(w[0] * x[1] - w[1] * x[0] + motion.linear[2], placed.way[2] + i);
    }
  }
  return placed;
}

/// Pair of a lens and a box whose distance may be within the cap. Each is numbered node * kWide + lane.
struct LensBox {
  std::int32_t lens;
  std::int32_t box;
  float bound;  ///< lower bound on their distance [m]
};

PHALANX_INLINE Floats square_root(const Floats& a) noexcept {
#if PHALANX_FLOATS == 8
  return static_cast<Floats>(_mm256_sqrt_ps(static_cast<__m256>(a)));
#elif defined(__SSE2__)
  return static_cast<Floats>(_mm_sqrt_ps(static_cast<__m128>(a)));
#else
  Floats r;
  for (int i = 0; i < kFloats; ++i) r[i] = __builtin_sqrtf(a[i]);
  return r;
#endif
}

struct Lenses {
  Floats centre[3];
  Floats axis[3];
  Floats way[3];
  Floats radius;
  Floats half;
};
struct Boxes {
  Floats min[3];
  Floats max[3];
  Floats axis[3];
  Floats low;
  Floats high;
};

/// Returns a node's lenses or boxes. get() turns eight lanes into one lane broadcast to all, or into several
/// side by side.
template <class Get>
PHALANX_INLINE Lenses lenses_of(const PlacedLenses& placed, const LensNode& rest, Get&& get) noexcept {
  return {{get(placed.centre[0]), get(placed.centre[1]), get(placed.centre[2])},
          {get(placed.axis[0]), get(placed.axis[1]), get(placed.axis[2])},
          {get(placed.way[0]), get(placed.way[1]), get(placed.way[2])},
          get(rest.radius),
          get(rest.half)};
}
template <class Get>
PHALANX_INLINE Boxes boxes_of(const BoxNode& node, Get&& get) noexcept {
  return {{get(node.min[0]), get(node.min[1]), get(node.min[2])},
          {get(node.max[0]), get(node.max[1]), get(node.max[2])},
          {get(node.axis[0]), get(node.axis[1]), get(node.axis[2])},
          get(node.low),
          get(node.high)};
}

/// Returns lower bounds on the distance of lenses and boxes. It is the largest of three separations: sphere
/// from box, box from the lens's slab, lens from the box's slab. For moving lenses it bounds the least
/// distance within the horizon. Along a slab's axis only the displacement along it counts.
template <bool kMoving>
PHALANX_INLINE Floats lens_box_bound(const Lenses& lens, const Boxes& box,
                                     const LensMotion& motion) noexcept {
  Floats squared = all(0.0F);
  Floats along = all(0.0F);
  Floats spread = all(0.0F);
  Floats height = all(0.0F);
  Floats cosine = all(0.0F);
  Floats way_along = all(0.0F);
  Floats way_up = all(0.0F);
  for (int k = 0; k < 3; ++k) {
    const Floats outside = most(most(box.min[k] - lens.centre[k], lens.centre[k] - box.max[k]), all(0.0F));
    squared += outside * outside;
    along += lens.axis[k] * ((box.min[k] + box.max[k]) * 0.5F - lens.centre[k]);
    spread += magnitude(lens.axis[k]) * ((box.max[k] - box.min[k]) * 0.5F);
    height += box.axis[k] * lens.centre[k];
    cosine += box.axis[k] * lens.axis[k];
    if constexpr (kMoving) {
      way_along += lens.axis[k] * lens.way[k];
      way_up += box.axis[k] * lens.way[k];
    }
  }
  // Extent of the lens along the box's axis: that of a disc with a rim, or that of the sphere around it.
  const Floats sine = square_root(most(1.000001F - cosine * cosine, all(0.0F)));
  const Floats reach = least(lens.radius, lens.half * magnitude(cosine) + lens.radius * sine);
  const Floats sphere = square_root(squared) * 0.9999990F - lens.radius;
  if constexpr (!kMoving) {
    const Floats slab = magnitude(along) - spread - lens.half;
    const Floats sheet = most(box.low - height, height - box.high) - reach;
    return most(sphere, most(slab, sheet));
  } else {
    const Floats none = all(0.0F);
    const Floats slab =
        most(along - most(way_along, none), -along - most(-way_along, none)) - spread - lens.half;
    const Floats sheet =
        most(box.low - height - most(way_up, none), height - box.high - most(-way_up, none)) - reach;
    return most(sphere - motion.reach, most(slab, sheet) - lens.radius * motion.spin - motion.bend);
  }
}

/// Returns the cap in single precision, rounded towards the safe side.
PHALANX_INLINE float single_cap(double cap) noexcept {
  return cap < 1e15 ? static_cast<float>(cap) * 1.000001F + 1e-12F : 1e15F;
}

/// Depth-first traversal of pairs of lens and box, with the pending pairs on a stack. Both trees have at most
/// 8 levels below 2^24 triangles, and 11 at most. Each step pops one pair and pushes at most 8.
template <bool kMoving>
class Walk {
 public:
  /// @param motion  used if kMoving. Bounds then hold within its horizon, which may become shorter meanwhile.
  Walk(const SegmentView& segment, const ObjectView& object, const LensMotion& motion) noexcept
      : segment_(segment), object_(object), motion_(motion) {}

  /// Hands pairs (triangle, block, bound) whose bound is at most cap to leaf(). leaf() may lower `cap`.
  /// @param wanted  returns true if a pair with this bound is still of interest
  template <bool kNearestFirst, class Wanted, class Leaf>
  PHALANX_INLINE void run(const float& cap, Wanted&& wanted, Leaf&& leaf) noexcept {
    push_boxes<false>(0, 0, 1U, cap);
    while (top_ > 0) {
      const LensBox pair = stack_[--top_];
      if (!wanted(pair.bound)) continue;
      const std::int32_t inner = segment_.nodes[pair.lens / kWide].child[pair.lens % kWide];
      const std::int32_t child = object_.nodes[pair.box / kWide].child[pair.box % kWide];
      if (inner < 0 && child < 0) {
        leaf(~inner, ~child, pair.bound);
      } else if (inner < 0 || (child >= 0 && box_is_larger(pair))) {
        push_boxes<kNearestFirst>(pair.lens, child, ~0U, cap);
      } else {
        push_lenses<kNearestFirst>(inner, pair.box, cap);
      }
    }
  }

 private:
  static constexpr int kCapacity = 2 * 11 * (kWide - 1) + kWide + 2;

  [[nodiscard]] PHALANX_INLINE bool box_is_larger(const LensBox& pair) const noexcept {
    const BoxNode& node = object_.nodes[pair.box / kWide];
    const int lane = pair.box % kWide;
    float longest = 0.0F;
    for (int k = 0; k < 3; ++k) {
      const float edge = node.max[k][lane] - node.min[k][lane];
      longest = edge > longest ? edge : longest;
    }
    return longest > 2.0F * segment_.nodes[pair.lens / kWide].radius[pair.lens % kWide];
  }

  /// Pushes the pairs of one lens with those boxes of a node that `lanes` selects.
  template <bool kSort>
  PHALANX_INLINE void push_boxes(std::int32_t lens, std::int32_t node, unsigned lanes, float cap) noexcept {
    const PlacedLenses& placed = placed_lenses<kMoving>(segment_, motion_, lens / kWide);
    const Lenses one = lenses_of(placed, segment_.nodes[lens / kWide],
                                 [&](const float* lane) { return all(lane[lens % kWide]); });
    alignas(32) float bound[kWide];
    unsigned hits = 0;
    for (int i = 0; i < kWide; i += kFloats) {
      const Boxes boxes = boxes_of(object_.nodes[node], [&](const float* lane) { return load(lane + i); });
      hits |= bound_pairs(one, boxes, cap, bound + i) << i;
    }
    push<kSort>(hits & lanes, bound, [&](int i) { return LensBox{lens, node * kWide + i, bound[i]}; });
  }

  /// Pushes the pairs of a node's lenses with one box.
  template <bool kSort>
  PHALANX_INLINE void push_lenses(std::int32_t node, std::int32_t box, float cap) noexcept {
    const PlacedLenses& placed = placed_lenses<kMoving>(segment_, motion_, node);
    const Boxes one =
        boxes_of(object_.nodes[box / kWide], [&](const float* lane) { return all(lane[box % kWide]); });
    alignas(32) float bound[kWide];
    unsigned hits = 0;
    for (int i = 0; i < kWide; i += kFloats) {
      const Lenses lenses =
          lenses_of(placed, segment_.nodes[node], [&](const float* lane) { return load(lane + i); });
      hits |= bound_pairs(lenses, one, cap, bound + i) << i;
    }
    push<kSort>(hits, bound, [&](int i) { return LensBox{node * kWide + i, box, bound[i]}; });
  }

  /// Writes the pairs' bounds.
  /// @returns bit i set if pair i is within the cap
  PHALANX_INLINE unsigned bound_pairs(const Lenses& lenses, const Boxes& boxes, float cap,
                                      float* bound) const noexcept {
    const Floats apart = lens_box_bound<kMoving>(lenses, boxes, motion_) - segment_.slack;
    store(apart, bound);
    return float_bits(apart <= cap);
  }

  /// Pushes the hits so that lane 0, or the nearest, is popped first.
  template <bool kSort, class Make>
  PHALANX_INLINE void push(unsigned hits, const float* bound, Make&& make) noexcept {
    if constexpr (kSort) {
      const int bottom = top_;
      for (unsigned left = hits; left != 0; left &= left - 1) {
        const int i = __builtin_ctz(left);
        int at = top_++;
        for (; at > bottom && stack_[at - 1].bound < bound[i]; --at) stack_[at] = stack_[at - 1];
        stack_[at] = make(i);
      }
    } else {
      for (unsigned left = hits; left != 0;) {
        const int i = 31 - __builtin_clz(left);
        left &= ~(1U << i);
        stack_[top_++] = make(i);
      }
    }
  }

  const SegmentView& segment_;
  const ObjectView& object_;
  const LensMotion& motion_;
  LensBox stack_[kCapacity];
  int top_ = 0;
};

}  // namespace phalanx::search::PHALANX_SEARCH_SET

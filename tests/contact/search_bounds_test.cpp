// SPDX-License-Identifier: Apache-2.0
// The search's bounds on single pairs, by hand. A bound that is too loose changes no result, so that no test
// of results notices it; it makes every tick slower. The functions are compiled here once more, as the
// portable set is.
#include <gtest/gtest.h>

#include <cmath>

#define PHALANX_SEARCH_SET by_hand
#define PHALANX_DOUBLES 2
#define PHALANX_FLOATS 4
#include "contact/search/search_impl.h"
#undef PHALANX_SEARCH_SET
#undef PHALANX_DOUBLES
#undef PHALANX_FLOATS

namespace phalanx::search {
namespace {

using namespace by_hand;  // NOLINT(google-build-using-namespace): the set that this file has compiled

// ---- a lens and a box ----

struct LensAndBox {
  float centre[3] = {0, 0, 0};
  float axis[3] = {0, 0, 1};
  float way[3] = {0, 0, 0};
  float radius = 2;
  float half = 0.5F;
  float low[3] = {-1, -1, -1};
  float high[3] = {1, 1, 1};
  float across[3] = {1, 0, 0};  ///< the box's slab
  float from = -1000, to = 1000;
  LensMotion motion{};

  template <bool kMoving>
  [[nodiscard]] double bound() const {
    Lenses lens;
    Boxes box;
    for (int k = 0; k < 3; ++k) {
      lens.centre[k] = all(centre[k]);
      lens.axis[k] = all(axis[k]);
      lens.way[k] = all(way[k]);
      box.min[k] = all(low[k]);
      box.max[k] = all(high[k]);
      box.axis[k] = all(across[k]);
    }
    lens.radius = all(radius);
    lens.half = all(half);
    box.low = all(from);
    box.high = all(to);
    const Floats found = lens_box_bound<kMoving>(lens, box, motion);
    for (int i = 1; i < kFloats; ++i) EXPECT_EQ(found[i], found[0]);
    return static_cast<double>(found[0]);
  }
};

constexpr double kSingle = 2e-5;

// The box begins 3 and 4 beyond the centre's x and y: 5 away, less the radius.
TEST(LensBoxBound, OfTheSphereAndTheBox) {
  LensAndBox pair{.low = {3, 4, -1}, .high = {9, 9, 1}};
  EXPECT_NEAR(pair.bound<false>(), 5.0 - 2.0, kSingle);
  LensAndBox behind{.centre = {10, 20, 30}, .half = 2, .low = {0, 0, 0}, .high = {8, 20, 28}};
  EXPECT_NEAR(behind.bound<false>(), std::sqrt(8.0) - 2.0, kSingle);
  LensAndBox around{.low = {-9, -9, -9}, .high = {9, 9, 9}};
  EXPECT_LE(around.bound<false>(), 0.0);
}

// A box over a wide, thin lens: 6 to 8 along its axis. Tilted by 45 degrees, half the box's edge of 2 counts
// along both axes.
TEST(LensBoxBound, OfTheLensesOwnSlabAndTheBox) {
  LensAndBox over{.radius = 100, .low = {-1, -1, 6}, .high = {1, 1, 8}};
  EXPECT_NEAR(over.bound<false>(), 6.0 - 0.5, kSingle);
  LensAndBox under{.radius = 100, .low = {-1, -1, -8}, .high = {1, 1, -6}};
  EXPECT_NEAR(under.bound<false>(), 6.0 - 0.5, kSingle);
  const float s = static_cast<float>(std::sqrt(0.5));
  LensAndBox tilted{.axis = {s, 0, -s}, .radius = 100, .low = {9, -1, -1}, .high = {11, 1, 1}};
  EXPECT_NEAR(tilted.bound<false>(), (10.0 - 2.0) * std::sqrt(0.5) - 0.5, kSingle);
}

// The box reaches around the lens, what is in it lies between 7 and 8 along an axis. Across that axis the
// lens reaches as far as its half thickness, along it as far as its radius, in between as a disc with a rim,
// and never farther than its sphere.
TEST(LensBoxBound, OfTheLensAndTheBoxesSlab) {
  LensAndBox flat{
      .half = 0.25F, .low = {-9, -9, -9}, .high = {9, 9, 9}, .across = {0, 0, 1}, .from = 7, .to = 8};
  EXPECT_NEAR(flat.bound<false>(), 7.0 - 0.25, 3e-3) << "the sine of 0 is taken for a thousandth, to be safe";
  LensAndBox on_edge = flat;
  on_edge.axis[0] = 1;
  on_edge.axis[2] = 0;
  EXPECT_NEAR(on_edge.bound<false>(), 7.0 - 2.0, kSingle);
  LensAndBox slanted = flat;
  slanted.axis[0] = 0.6F;
  slanted.axis[2] = -0.8F;
  EXPECT_NEAR(slanted.bound<false>(), 7.0 - (0.25 * 0.8 + 2.0 * 0.6), kSingle);
  LensAndBox thick = slanted;
  thick.half = 2;
  EXPECT_NEAR(thick.bound<false>(), 7.0 - 2.0, kSingle);
  LensAndBox below = flat;
  below.from = -8;
  below.to = -7;
  EXPECT_NEAR(below.bound<false>(), 7.0 - 0.25, 3e-3);
}

// A turn that takes x to y, y to z and z to x, then (10, 20, 30): (1, 2, 3) comes to (13, 21, 32), the axis
// (0.6, 0, 0.8) to (0.8, 0.6, 0). With w = (4, 5, 6) and (0.1, 0.2, 0.3) a period it goes w x x + that:
// (34.1, -49.8, 19.3). Each lane has a lens of its own. They are placed once a query.
TEST(PlacedLensesByHand, AreTurnedMovedAndGoTheirWay) {
  LensNode node{};
  for (int lane = 0; lane < kWide; ++lane) {
    const float more = 2.0F * static_cast<float>(lane);
    const float centre[3] = {1.0F + more, 2.0F + more, 3.0F + more};
    const float axis[3] = {0.6F, 0.0F, 0.8F};
    for (int k = 0; k < 3; ++k) {
      node.centre[k][lane] = centre[k];
      node.axis[k][lane] = axis[k];
    }
  }
  const LensMotion motion{
      .angular = {4, 5, 6}, .linear = {0.1F, 0.2F, 0.3F}, .spin = 9, .bend = 0, .reach = 99};
  for (const bool moving : {false, true}) {
    PlacedLenses placed{};
    SegmentView segment{};
    segment.nodes = &node;
    segment.lenses = &placed;
    segment.query = 7;
    const float turn[3][3] = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
    const float at[3] = {10, 20, 30};
    for (int k = 0; k < 3; ++k) {
      segment.lens_p[k] = at[k];
      for (int i = 0; i < 3; ++i) segment.lens_R[k][i] = turn[k][i];
    }
    for (int again = 0; again < 2; ++again) {
      const PlacedLenses& found =
          moving ? placed_lenses<true>(segment, motion, 0) : placed_lenses<false>(segment, motion, 0);
      ASSERT_EQ(&found, &placed);
      EXPECT_EQ(found.query, 7U);
      for (int lane = 0; lane < kWide; ++lane) {
        const float more = 2.0F * static_cast<float>(lane);
        EXPECT_FLOAT_EQ(found.centre[0][lane], 13.0F + more);
        EXPECT_FLOAT_EQ(found.centre[1][lane], 21.0F + more);
        EXPECT_FLOAT_EQ(found.centre[2][lane], 32.0F + more);
        EXPECT_FLOAT_EQ(found.axis[0][lane], 0.8F);
        EXPECT_FLOAT_EQ(found.axis[1][lane], 0.6F);
        EXPECT_FLOAT_EQ(found.axis[2][lane], 0.0F);
        if (!moving) continue;
        // (5 - 6, 6 - 4, 4 - 5) more for each step by (1, 1, 1)
        EXPECT_NEAR(found.way[0][lane], 34.1F - more, 1e-5F);
        EXPECT_NEAR(found.way[1][lane], -49.8F + 2.0F * more, 1e-5F);
        EXPECT_NEAR(found.way[2][lane], 19.3F - more, 1e-5F);
      }
      node.centre[0][0] += 100.0F;  // the second time nothing is looked at
    }
    node.centre[0][0] -= 200.0F;
  }
}

// The same three, while the lens goes 1.5 towards the box, or 1.5 away from it: no nearer then than at the
// beginning. The sphere's bound takes the farthest that any point goes; slabs take the way of the centre
// along their axis, what turning moves the rim, and higher orders.
TEST(LensBoxBound, WhileTheLensMoves) {
  LensAndBox sphere{.low = {3, 4, -1}, .high = {9, 9, 1}};
  sphere.motion.reach = 1.25F;
  EXPECT_NEAR(sphere.bound<true>(), 3.0 - 1.25, kSingle);

  for (const float side : {1.0F, -1.0F}) {
    LensAndBox slab{.way = {0, 0, 1.5F * side}, .radius = 100, .low = {-1, -1, 6}, .high = {1, 1, 8}};
    if (side < 0) {
      slab.low[2] = -8;
      slab.high[2] = -6;
    }
    slab.motion.reach = 1000;
    EXPECT_NEAR(slab.bound<true>(), 5.5 - 1.5, kSingle);
    slab.motion.spin = 0.01F;
    slab.motion.bend = 0.125F;
    EXPECT_NEAR(slab.bound<true>(), 5.5 - 1.5 - 100 * 0.01 - 0.125, kSingle);
    slab.way[2] = -slab.way[2];
    EXPECT_NEAR(slab.bound<true>(), 5.5 - 100 * 0.01 - 0.125, kSingle);

    LensAndBox sheet{.axis = {1, 0, 0},
                     .way = {0, 0, 1.5F * side},
                     .low = {-9, -9, -9},
                     .high = {9, 9, 9},
                     .across = {0, 0, 1}};
    sheet.from = side > 0 ? 7.0F : -8.0F;
    sheet.to = side > 0 ? 8.0F : -7.0F;
    sheet.motion.spin = 0.05F;
    sheet.motion.bend = 0.125F;
    sheet.motion.reach = 1000;
    EXPECT_NEAR(sheet.bound<true>(), 5.0 - 1.5 - 2 * 0.05 - 0.125, kSingle);
    sheet.way[2] = -sheet.way[2];
    EXPECT_NEAR(sheet.bound<true>(), 5.0 - 2 * 0.05 - 0.125, kSingle);
  }
}

// Rounded to the safe side, by little.
TEST(LensBoxBound, ACapInSinglePrecisionIsNoSmallerAndHardlyLarger) {
  for (const double cap : {0.0, 1e-9, 0.1, 1.0 / 3.0, 7.0, 1e14}) {
    EXPECT_GE(static_cast<double>(single_cap(cap)), cap);
    EXPECT_LE(static_cast<double>(single_cap(cap)), cap * 1.000002 + 2e-12);
  }
  EXPECT_EQ(single_cap(1e300), 1e15F);
}

// ---- how a segment moves, for lenses ----

// Within 0.5 of the parameter. The velocity at the object's centre (0, 0, 2): angular x r + linear = (8, 0,
// 0) + (1, 2, 3).
TEST(LensMotionOf, AMotionOverAHorizon) {
  SegmentView segment{};
  segment.object_centre[2] = 2;
  MotionView motion{};
  motion.angular[1] = 4;
  motion.linear[0] = 1;
  motion.linear[1] = 2;
  motion.linear[2] = 3;
  motion.speed = 20;
  motion.bend = 12;
  const LensMotion lens = lens_motion(segment, motion, 0.5);
  EXPECT_NEAR(lens.angular[1], 2.0, 1e-6);
  EXPECT_NEAR(lens.linear[0], 4.5, 1e-6);
  EXPECT_NEAR(lens.linear[1], 1.0, 1e-6);
  EXPECT_NEAR(lens.linear[2], 1.5, 1e-6);
  EXPECT_GE(lens.spin, 2.0F);
  EXPECT_NEAR(lens.spin, 2.0, 1e-5);
  EXPECT_GE(lens.bend, 1.50002F);  // 12 x 0.5^2 / 2, and 2e-6 of 20 x 0.5 for rounding
  EXPECT_NEAR(lens.bend, 1.50002, 3e-6);
  EXPECT_GE(lens.reach, 10.0F);
  EXPECT_NEAR(lens.reach, 10.0, 1e-4);
}

// ---- two triangles ----

/// One triangle of a segment, placed in the world as it is, and one of an object.
struct TrianglePair {
  double mine[3][3];
  double theirs[3][3];
  MotionView motion{};
  double horizon = 1.0;
  double margin = 0.0;
  double floor = 0.0;

  [[nodiscard]] SegmentView segment() {
    SegmentView view{};
    for (int c = 0; c < 3; ++c)
      for (int k = 0; k < 3; ++k) triangle.corner[c][k] = mine[c][k];
    for (int k = 0; k < 3; ++k) view.R[k][k] = 1.0;
    placed.query = 6;
    view.triangles = &triangle;
    view.placed = &placed;
    view.query = 7;
    return view;
  }
  [[nodiscard]] ObjectView object() {
    for (int c = 0; c < 3; ++c)
      for (int k = 0; k < 3; ++k)
        for (int lane = 0; lane < kWide; ++lane) block.corner[c][k][lane] = theirs[c][k];
    return {nullptr, &block, 1};
  }
  [[nodiscard]] PairStep advanced() {
    const PairIndex pair{0, 0};
    PairStep step{};
    advance(segment(), object(), motion, horizon, margin, floor, &pair, 1, &step);
    return step;
  }
  /// @param jerk  the third order within the horizon [m]
  [[nodiscard]] double separated(bool moving, double jerk = 0.0) {
    const SegmentView view = segment();
    const Sweep sweep{moving ? &motion : nullptr, horizon, jerk};
    const PlacedTriangle& swept = placed_triangle(view, 0, sweep);
    const Doubles found = separation(swept, block_triangles(*object().blocks, 0), sweep);
    EXPECT_EQ(found[0], found[1]);
    return found[0];
  }

  // What the views look into.
  SegmentTriangle triangle{};
  PlacedTriangle placed{};
  TriangleBlock block{};
};

/// A triangle in the plane z = height, and one in the plane z = 0 below it.
TrianglePair facing(double height) {
  return TrianglePair{.mine = {{0, 0, height}, {1, 0, height}, {0, 1, height}},
                      .theirs = {{-2, -2, 0}, {4, -2, 0}, {-2, 4, 0}}};
}

TEST(PairStepByHand, AtASteadySpeedIsTheWayDownToTheFloor) {
  TrianglePair pair = facing(0.5);
  pair.motion.linear[2] = -2.0;
  pair.floor = 0.1;
  PairStep step = pair.advanced();
  EXPECT_NEAR(step.step, 0.2, 1e-12);
  EXPECT_FALSE(step.blocked);
  EXPECT_TRUE(step.near) << "it reaches the plane after a quarter of the horizon";
  pair.motion.linear[2] = 2.0;
  step = pair.advanced();
  EXPECT_EQ(step.step, pair.horizon) << "it goes away";
  EXPECT_FALSE(step.near);
  pair.motion.linear[2] = 0.0;
  EXPECT_EQ(pair.advanced().step, pair.horizon);
}

// The nearest corner counts: 0.5 above the plane, the others 1.5.
TEST(PairStepByHand, IsTheLeastOfTheCorners) {
  TrianglePair pair = facing(1.5);
  pair.mine[2][2] = 0.5;
  pair.motion.linear[2] = -2.0;
  EXPECT_NEAR(pair.advanced().step, 0.25, 1e-12);
}

// From rest, g = a h^2 / 2; against the speed, the braking way v^2 / 2 a is enough, or not.
TEST(PairStepByHand, WithAnAcceleration) {
  TrianglePair pair = facing(0.09);
  pair.motion.linear_rate[2] = -2.0;
  EXPECT_NEAR(pair.advanced().step, 0.3, 1e-12);
  pair.motion.linear_rate[2] = 2.0;
  pair.motion.linear[2] = -0.59;
  EXPECT_EQ(pair.advanced().step, pair.horizon) << "stands after 0.087";
  pair.motion.linear[2] = -1.0;  // 0.09 - h + h^2 = 0
  EXPECT_NEAR(pair.advanced().step, 0.1, 1e-12);
  pair.motion.linear_rate[2] = -2.0;
  pair.motion.linear[2] = 0.7;  // 0.09 + 0.7 h - h^2 = 0
  EXPECT_NEAR(pair.advanced().step, 0.81097722286, 1e-9);
}

// 0.001 = 0.6 h^3 / 6 at h = 0.2154. With a third order of at most 0.6 h^2 limit / 6 it is 0.1 for the limit
// 1, and for the limit sqrt(0.1 x 1) it is 0.1778.
TEST(PairStepByHand, WithAThirdOrderIsBoundedTwice) {
  TrianglePair pair = facing(0.001);
  pair.motion.jerk = 0.6;
  EXPECT_NEAR(pair.advanced().step, std::sqrt(0.01 / std::sqrt(0.1)), 1e-12);
}

// A point x that turns about the origin has the velocity w x x and the acceleration w' x x + w x (w x x).
// Here the corner (1, 0, 0.5) is the first to reach the plane: it falls at 2, and the z part of w x (w x x)
// is -4 z = -2.
TEST(PairStepByHand, TurnsWithItsSegment) {
  TrianglePair pair = facing(0.5);
  pair.motion.angular[1] = 2.0;  // 0.5 - 2 h - 2 h^2 / 2 = 0
  EXPECT_NEAR(pair.advanced().step, (std::sqrt(4.0 + 2.0 * 2.0 * 0.5) - 2.0) / 2.0, 1e-12);
  pair.motion.angular_rate[1] = 4.0;  // 0.5 - 2 h - 6 h^2 / 2 = 0
  EXPECT_NEAR(pair.advanced().step, (std::sqrt(4.0 + 2.0 * 6.0 * 0.5) - 2.0) / 6.0, 1e-12);
}

// At the end of the horizon it is at least at its height less the way, half the acceleration times h^2, and a
// sixth of the third order times h^3. What goes away counts as standing still.
TEST(PairStepByHand, IsNearWhatMayBeWithinTheMarginAtTheHorizon) {
  TrianglePair pair = facing(1.0);
  pair.floor = -10.0;
  pair.horizon = 0.5;
  const auto is_near_within = [&](double margin) {
    pair.margin = margin;
    return pair.advanced().near;
  };
  pair.motion.linear[2] = -1.0;  // 0.5 left
  EXPECT_FALSE(is_near_within(0.499));
  EXPECT_TRUE(is_near_within(0.501));
  pair.motion.linear_rate[2] = 1.0;  // braking counts for nothing
  EXPECT_FALSE(is_near_within(0.499));
  EXPECT_TRUE(is_near_within(0.501));
  pair.motion.linear_rate[2] = -1.0;  // 0.375 left
  EXPECT_FALSE(is_near_within(0.374));
  EXPECT_TRUE(is_near_within(0.376));
  pair.motion.jerk = 1.0;  // 0.125 / 6 = 0.0208 less
  EXPECT_FALSE(is_near_within(0.354));
  EXPECT_TRUE(is_near_within(0.355));
  pair.motion.jerk = 0.0;
  pair.motion.linear[2] = 1.0;  // it goes away, and is pulled back by 0.125
  EXPECT_FALSE(is_near_within(0.874));
  EXPECT_TRUE(is_near_within(0.876));
}

// Within the margin what closes is stopped, but for less than 1e-9 above the floor; what does not close goes
// on, and counts from half a nanometre below where it is.
TEST(PairStepByHand, WithinTheMarginStopsWhatCloses) {
  TrianglePair pair = facing(1e-4);
  pair.margin = 2e-4;
  pair.floor = 5e-5;
  pair.motion.linear[2] = -1e-3;
  EXPECT_TRUE(pair.advanced().blocked);
  EXPECT_EQ(pair.advanced().step, 0.0);
  EXPECT_TRUE(pair.advanced().near);
  pair.motion.linear[2] = -0.9e-9;
  EXPECT_FALSE(pair.advanced().blocked);
  pair.motion.linear[2] = -1.1e-9;
  EXPECT_TRUE(pair.advanced().blocked);
  pair.floor = 1.001e-4;
  pair.motion.linear[2] = -1e-12;
  EXPECT_TRUE(pair.advanced().blocked) << "no room above the floor";

  pair.motion.linear[2] = 0.0;
  pair.motion.linear_rate[2] = -2.0;
  pair.floor = 2e-4;  // below it already
  const PairStep step = pair.advanced();
  EXPECT_FALSE(step.blocked);
  EXPECT_NEAR(step.step, std::sqrt(5e-10), 1e-8);
  pair.theirs[0][2] = pair.theirs[1][2] = pair.theirs[2][2] = 1e-4;
  EXPECT_TRUE(pair.advanced().blocked) << "at no distance there is no direction";
}

// Triangles in planes 0.5 apart; the upper one 0.1 higher at a corner, or 0.2 lower; side by side in one
// plane, which tells nothing.
TEST(Separation, IsTheGapAcrossOneOfThePlanes) {
  EXPECT_NEAR(facing(0.5).separated(false), 0.5, 1e-12);
  EXPECT_NEAR(facing(-0.5).separated(false), 0.5, 1e-12);
  TrianglePair raised = facing(0.5);
  raised.mine[2][2] = 0.6;
  EXPECT_NEAR(raised.separated(false), 0.5, 1e-12);
  raised.mine[2][2] = 0.3;
  EXPECT_NEAR(raised.separated(false), 0.3, 1e-12);
  TrianglePair beside = facing(0.0);
  for (auto& corner : beside.mine) corner[0] += 10.0;
  EXPECT_NEAR(beside.separated(false), 0.0, 1e-12);
  // The object's triangle lies in the plane z = (x + 2) / 6, under the corner at x = 1 by 1.25 - 0.5 along z.
  TrianglePair slanted = facing(1.25);
  slanted.theirs[1][2] = 1.0;
  EXPECT_NEAR(slanted.separated(false), 0.75 / std::sqrt(1.0 + 1.0 / 36.0), 1e-12);
}

// Half a unit of the parameter: 0.2 towards the other plane at first order, 0.05 at second, 0.01 at third.
TEST(Separation, WhileTheSegmentMoves) {
  TrianglePair pair = facing(0.5);
  pair.horizon = 0.5;
  pair.motion.linear[2] = -0.4;
  EXPECT_NEAR(pair.separated(true), 0.5 - 0.2, 1e-12);
  pair.motion.linear_rate[2] = -0.4;
  EXPECT_NEAR(pair.separated(true), 0.5 - 0.2 - 0.05, 1e-12);
  EXPECT_NEAR(pair.separated(true, 0.01), 0.5 - 0.2 - 0.05 - 0.01, 1e-12);
  pair.motion.linear[2] = 0.4;  // away: first and second order count by themselves
  EXPECT_NEAR(pair.separated(true), 0.5 - 0.05, 1e-12);
  pair.motion.linear_rate[2] = 0.4;
  EXPECT_NEAR(pair.separated(true), 0.5, 1e-12);
  pair.motion.linear[0] = 3.0;  // along the planes
  EXPECT_NEAR(pair.separated(true), 0.5, 1e-12);

  TrianglePair above = facing(-0.5);  // from below
  above.horizon = 0.5;
  above.motion.linear[2] = 0.4;
  above.motion.linear_rate[2] = 0.4;
  EXPECT_NEAR(above.separated(true), 0.5 - 0.2 - 0.05, 1e-12);
}

/// The same pair with x, y and z in the place of y, z and x, `shift` times.
TrianglePair with_shifted_axes(const TrianglePair& pair, int shift) {
  TrianglePair out = pair;
  for (int k = 0; k < 3; ++k) {
    const int to = (k + shift) % 3;
    for (int c = 0; c < 3; ++c) {
      out.mine[c][to] = pair.mine[c][k];
      out.theirs[c][to] = pair.theirs[c][k];
    }
    out.motion.angular[to] = pair.motion.angular[k];
    out.motion.angular_rate[to] = pair.motion.angular_rate[k];
  }
  return out;
}

// A height of 1 over the plane, a quarter of the parameter. The corner (1, 0, 1) falls at 2; along z it is
// drawn by the growing turn at 4 x = 4 and towards the axis at 2^2 z = 4: 2 / 4 at first order and 8 / 32 at
// second leave 1 / 4. About -x it is the corner (0, 1, 1), likewise.
TEST(Separation, WhileTheSegmentTurns) {
  for (const bool about_x : {false, true}) {
    for (int shift = 0; shift < 3; ++shift) {
      TrianglePair pair = facing(1.0);
      pair.horizon = 0.25;
      pair.motion.angular[about_x ? 0 : 1] = about_x ? -2.0 : 2.0;
      pair.motion.angular_rate[about_x ? 0 : 1] = about_x ? -4.0 : 4.0;
      pair = with_shifted_axes(pair, shift);
      EXPECT_NEAR(pair.separated(true), 0.25, 1e-12) << (about_x ? "about -x, " : "about y, ") << shift;
    }
  }
}

/// The other way round than facing(): a wide triangle of the segment in the plane z = height, and below it
/// one of the object that hangs down from z = 0. Its own plane is so steep that it does not separate them.
TrianglePair hanging(double height) {
  return TrianglePair{.mine = {{-2, -2, height}, {4, -2, height}, {-2, 4, height}},
                      .theirs = {{0, 0, 0}, {1, 0, 0}, {0, 1, -1}}};
}
TrianglePair upside_down(TrianglePair pair) {
  for (int c = 0; c < 3; ++c) {
    pair.mine[c][2] = -pair.mine[c][2];
    pair.theirs[c][2] = -pair.theirs[c][2];
  }
  pair.motion.linear[2] = -pair.motion.linear[2];
  pair.motion.linear_rate[2] = -pair.motion.linear_rate[2];
  return pair;
}

// Still; at first and at second order; of the two planes one alone separates. Wherever they are, and also
// after they have moved.
TEST(Separation, IsAcrossThePlaneOfEitherTriangleAlone) {
  TrianglePair raised = facing(0.5);  // across the object's plane: the segment's is slanted
  raised.mine[2][2] = 0.3;
  for (const double up : {0.0, 10.0, -10.0}) {
    for (TrianglePair pair : {hanging(0.5), raised}) {
      const double gap = pair.mine[2][2];
      for (int c = 0; c < 3; ++c) {
        pair.mine[c][2] += up;
        pair.theirs[c][2] += up;
      }
      EXPECT_NEAR(pair.separated(false), gap, 1e-12);
      EXPECT_NEAR(upside_down(pair).separated(false), gap, 1e-12);
      pair.horizon = 0.5;
      pair.motion.linear[2] = -0.2;
      EXPECT_NEAR(pair.separated(true), gap - 0.1, 1e-12);
      EXPECT_NEAR(upside_down(pair).separated(true), gap - 0.1, 1e-12);
      EXPECT_NEAR(pair.separated(false), gap, 1e-12) << "still again";
      pair.motion.linear_rate[2] = -0.4;
      EXPECT_NEAR(pair.separated(true), gap - 0.15, 1e-12);
      EXPECT_NEAR(upside_down(pair).separated(true), gap - 0.15, 1e-12);
      EXPECT_NEAR(pair.separated(true, 0.01), gap - 0.16, 1e-12);
      EXPECT_NEAR(pair.separated(false), gap, 1e-12) << "still again";
      pair.motion.linear[2] = 0.2;
      pair.motion.linear_rate[2] = 0.4;
      EXPECT_NEAR(pair.separated(true), gap, 1e-12);
      EXPECT_NEAR(upside_down(pair).separated(true), gap, 1e-12);
    }
  }
}

}  // namespace
}  // namespace phalanx::search

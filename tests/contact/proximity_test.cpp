// SPDX-License-Identifier: Apache-2.0
#include "phalanx/contact/proximity.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "contact/containment.h"
#include "contact/search/views.h"
#include "phalanx/contact/triangle_distance.h"
#include "phalanx/mesh/primitives.h"
#include "support/search_cases.h"

namespace phalanx {
namespace {

/// Of the segment at its pose from the object, over all pairs of triangles.
double brute_force(const SegmentTree& segment, const Pose& X, const ObjectTree& object) {
  double best = 1e300;
  for (int i = 0; i < segment.size(); ++i) {
    Corners corners = segment.corners(i);
    for (Vec3& x : corners) x = X * x;
    for (int j = 0; j < object.size(); ++j)
      best = std::min(best, triangle_distance(corners, object.corners(j)).squared);
  }
  return std::sqrt(best);
}

struct Case {
  TriangleMesh mesh = make_tapered_capsule(0.03, 0.008, 0.006, 10, 3, 2);
  ObjectModel object{make_torus(0.08, 0.02, 600)};
  SegmentTree segment{mesh};
  SearchScratch scratch{segment};

  double distance_at(const Pose& X, double cap) {
    return distance({segment, X, scratch}, object.tree(), cap);
  }
};

Pose random_pose(std::mt19937_64& random, double size) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> u(-size, size);
  const Vec3 axis = Vec3(normal(random), normal(random), normal(random)).normalized();
  return Pose{rotation_about(axis, u(random) / size * 3.0), Vec3(u(random), u(random), u(random))};
}

TEST(Proximity, DistanceEqualsBruteForceAtSeededPoses) {
  Case c;
  std::mt19937_64 random(7);
  for (int i = 0; i < 150; ++i) {
    const Pose X = random_pose(random, 0.08);
    const double expected = brute_force(c.segment, X, c.object.tree());
    EXPECT_NEAR(c.distance_at(X, 1.0), expected, 1e-15) << "seed 7 case " << i;
    EXPECT_EQ(crosses({c.segment, X, c.scratch}, c.object.tree()), expected == 0.0) << "seed 7 case " << i;
    EXPECT_EQ(c.distance_at(X, 0.5 * expected), 0.5 * expected) << "a cap below it comes back";
    const double bound = distance_bound({c.segment, X, c.scratch}, c.object.tree(), 1.0);
    EXPECT_LE(bound, expected) << "seed 7 case " << i;
    const double capped = distance_bound({c.segment, X, c.scratch}, c.object.tree(), 0.1 * bound);
    EXPECT_LE(capped, 0.1 * bound);
    EXPECT_GE(capped, 0.08 * bound) << "at least 0.8 of what is to be had";
  }
}

TEST(Proximity, AFlatTouchPicksTheMiddle) {
  // A box lying 50 um above a larger one: every point of its lower face is closest. The middle must not
  // depend on how the faces are cut.
  for (const int table_triangles : {12, 48, 300}) {
    for (const int box_triangles : {12, 48, 200}) {
      const ObjectModel table(make_box(Vec3(0.2, 0.2, 0.2), table_triangles));
      const SegmentTree box(make_box(Vec3(0.02, 0.02, 0.02), box_triangles));
      SearchScratch scratch(box);
      const Pose X{Mat3::Identity(), Vec3(0.013, -0.007, 0.11 + 50e-6)};
      const ContactPatch patch = contact_patch({box, X, scratch}, table, 1e-3);
      EXPECT_NEAR(patch.distance, 50e-6, 1e-15);
      EXPECT_NEAR(patch.on_segment.x(), 0.013, 5e-6);
      EXPECT_NEAR(patch.on_segment.y(), -0.007, 5e-6);
      EXPECT_NEAR(patch.on_object.x(), 0.013, 5e-6);
      EXPECT_NEAR(patch.direction.z(), 1.0, 1e-12);
      EXPECT_NEAR(patch.object_normal.z(), 1.0, 1e-12);
    }
  }
}

// As above with a lower face of 5000 triangles: more pairs tie than are kept, and they are sought again for
// each question.
TEST(Proximity, ATouchOfMorePairsThanAreKeptIsTheSame) {
  const ObjectModel table(make_box(Vec3(0.2, 0.2, 0.2), 12));
  const SegmentTree box(make_box(Vec3(0.02, 0.02, 0.02), 30'000));
  SearchScratch scratch(box);
  const Pose X{Mat3::Identity(), Vec3(0.013, -0.007, 0.11 + 50e-6)};
  SegmentMotion down;
  down.linear = Vec3(0.0, 0.0, -1.0);
  const SegmentMotion* motions[] = {nullptr, &down};
  for (const SegmentMotion* motion : motions) {
    const ContactPatch patch = contact_patch({box, X, scratch}, table, 51e-6, motion);
    EXPECT_GT(patch.pairs, static_cast<int>(NearPairs::kMost));
    EXPECT_NEAR(patch.distance, 50e-6, 1e-15);
    EXPECT_NEAR(patch.on_segment.x(), 0.013, 2e-5);
    EXPECT_NEAR(patch.on_segment.y(), -0.007, 2e-5);
    EXPECT_NEAR(patch.direction.z(), 1.0, 1e-12);
    EXPECT_NEAR(patch.object_normal.z(), 1.0, 1e-12);
  }
}

// Two parallel triangles 1 mm apart, whose boxes are as far apart as they are: what single precision may be
// off, 2e-6 of 10 + 10 + 30 mm = 0.1 um, comes off the bound, so that a cap of 10 nm more than the distance
// finds it.
TEST(Proximity, ABoundAllowsForTheRoundingOfSinglePrecision) {
  const ObjectModel floor(
      TriangleMesh{{Vec3(-0.02, -0.02, 0), Vec3(0.04, -0.02, 0), Vec3(-0.02, 0.04, 0)}, {{0, 1, 2}}});
  const SegmentTree segment(TriangleMesh{{Vec3(0, 0, 0), Vec3(0.01, 0, 0), Vec3(0, 0.01, 0)}, {{0, 1, 2}}});
  SearchScratch scratch(segment);
  const Pose X{Mat3::Identity(), Vec3(0.0, 0.0, 1e-3)};
  EXPECT_NEAR(distance({segment, X, scratch}, floor.tree(), 1e-3 + 1e-8), 1e-3, 1e-12);
}

// Of 20,000 triangles, deep in the ball: what was found ends the search. A search that goes on places every
// triangle of the segment.
TEST(Proximity, CrossingIsSettledByTheFirstPairThatDoes) {
  const ObjectModel ball(make_sphere(0.05, 20000));
  const SegmentTree segment(make_tapered_capsule(0.03, 0.008, 0.006, 24, 12, 12));
  SearchScratch scratch(segment);
  std::mt19937_64 random(12);
  int crossing = 0;
  for (int i = 0; i < 50; ++i) {
    const Pose X = random_pose(random, 0.05);
    if (!crosses({segment, X, scratch}, ball.tree())) continue;
    ++crossing;
    const std::uint64_t query = scratch.next_query() - 1;
    int placed = 0;
    for (int t = 0; t < segment.size(); ++t) placed += scratch.triangles()[t].query == query ? 1 : 0;
    EXPECT_LT(10 * placed, segment.size()) << "seed 12 case " << i;
  }
  EXPECT_GT(crossing, 10);
}

// Two triangles half a metre apart that no plane of theirs separates, and whose boxes overlap: each pair is
// measured. 512 are, and none touches; the last block of 520, which is not looked at, counts as touching.
TEST(Proximity, CrossingIsAssumedWhere512PairsDoNotSettleIt) {
  const SegmentTree hanging(TriangleMesh{{Vec3(-1, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, -1)}, {{0, 1, 2}}});
  SearchScratch scratch(hanging);
  const auto crossing = [&](std::size_t times) {
    TriangleMesh across{{Vec3(0, -1, 0.5), Vec3(0, 1, 0.5), Vec3(0, 0, 1.5)}, {}};
    across.triangles.assign(times, Triangle{0, 1, 2});
    return crosses({hanging, Pose{}, scratch}, ObjectTree(across));
  };
  EXPECT_FALSE(crossing(1));
  EXPECT_FALSE(crossing(512));
  EXPECT_TRUE(crossing(520));
  EXPECT_TRUE(crossing(20000));
}

// The lens of a standing triangle is a disc around the origin, which the floor's boxes reach; its plane
// separates the triangles. So pairs of lens and box are visited, and none of triangles is measured.
TEST(Proximity, CrossingIsAssumedWhere1024PairsOfLensAndBoxDoNotSettleIt) {
  const SegmentTree standing(TriangleMesh{{Vec3(-1, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 1)}, {{0, 1, 2}}});
  SearchScratch scratch(standing);
  const auto crossing = [&](std::size_t times) {
    TriangleMesh floor{{Vec3(-5, -5, -0.5), Vec3(5, -5, -0.5), Vec3(0, 5, -0.5)}, {}};
    floor.triangles.assign(times, Triangle{0, 1, 2});
    return crosses({standing, Pose{}, scratch}, ObjectTree(floor));
  };
  EXPECT_FALSE(crossing(1));
  EXPECT_FALSE(crossing(2000));
  EXPECT_TRUE(crossing(40000));
}

// Near a dense ball and near slivers that meet in its poles: whatever crosses is found, whether it was
// settled or not. The times are printed and not judged.
TEST(Proximity, NoCrossingIsMissedHoweverDenseTheMesh) {
  const SegmentTree segment(make_tapered_capsule(0.03, 0.008, 0.006, 24, 12, 12));
  SearchScratch scratch(segment);
  for (const auto& [name, mesh] : {std::pair{"ball of 20,000 triangles", make_sphere(0.1, 20000)},
                                   std::pair{"8,000 slivers", test::meridians(4000)}}) {
    const ObjectModel object(mesh);
    std::mt19937_64 random(13);
    std::vector<double> us;
    int crossing = 0;
    for (int i = 0; i < 200; ++i) {
      const Pose X = random_pose(random, 0.06);
      const auto begin = std::chrono::steady_clock::now();
      const bool found = crosses({segment, X, scratch}, object.tree());
      us.push_back(1e6 * std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
      if (distance({segment, X, scratch}, object.tree(), 1e-9) > 0.0) continue;
      ++crossing;
      EXPECT_TRUE(found) << name << ", seed 13 case " << i;
    }
    EXPECT_GT(crossing, 20);
    std::sort(us.begin(), us.end());
    std::printf("crosses(), %s: p50 %.1f us, p90 %.1f us, longest %.1f us\n", name, us[100], us[180],
                us.back());
  }
}

// The segment is a right-angled triangle whose longest edge reaches from (-1, 0, 0) to (1, 0, 0), so that its
// lens is a disc of radius 1 around the origin. Everything of the object is 2 away, and seen from the lens
// its boxes are 1 away. Where edges cross no plane separates the triangles: each pair is measured, but of 257
// the last is believed to be as near as its box. A floor's own plane separates it by 2: eight pairs are
// measured, and for the others that is enough.
TEST(Proximity, ABoundMeasures256PairsAndBelievesWhatIsLeft) {
  const auto bound = [](const TriangleMesh& mine, TriangleMesh theirs, std::size_t times) {
    theirs.triangles.assign(times, Triangle{0, 1, 2});
    const ObjectTree object(theirs);
    const SegmentTree segment(mine);
    SearchScratch scratch(segment);
    const Pose X;
    return distance_bound({segment, X, scratch}, object, 10.0);
  };
  const TriangleMesh hanging{{Vec3(-1, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, -1)}, {{0, 1, 2}}};
  const TriangleMesh across{{Vec3(0, -1, 2), Vec3(0, 1, 2), Vec3(0, 0, 3)}, {{0, 1, 2}}};
  EXPECT_NEAR(bound(hanging, across, 1), 2.0, 1e-8);
  EXPECT_NEAR(bound(hanging, across, 256), 2.0, 1e-8);
  EXPECT_NEAR(bound(hanging, across, 257), 1.0, 1e-4);
  const TriangleMesh standing{{Vec3(-1, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 1)}, {{0, 1, 2}}};
  const TriangleMesh floor{{Vec3(-5, -5, -2), Vec3(5, -5, -2), Vec3(0, 5, -2)}, {{0, 1, 2}}};
  EXPECT_NEAR(bound(standing, floor, 300), 2.0, 1e-8);
}

TEST(Proximity, AnEdgeLyingOnAFacePicksTheMiddleOfTheEdge) {
  const ObjectModel table(make_box(Vec3(0.2, 0.2, 0.2), 300));
  const SegmentTree box(make_box(Vec3(0.02, 0.02, 0.02), 12));
  SearchScratch scratch(box);
  const Mat3 R = rotation_about(Vec3::UnitY(), std::numbers::pi / 4.0);
  const Pose X{R, Vec3(0.003, 0.004, 0.1 + 0.01 * std::numbers::sqrt2 + 50e-6)};
  const ContactPatch patch = contact_patch({box, X, scratch}, table, 1e-3);
  EXPECT_NEAR(patch.on_segment.x(), 0.003, 1e-5);
  EXPECT_NEAR(patch.on_segment.y(), 0.004, 1e-4);
}

TEST(Proximity, ASheetsNormalIsOnTheSideOfTheHand) {
  TriangleMesh sheet;
  sheet.vertices = {Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(1, 1, 0), Vec3(-1, 1, 0)};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  const ObjectModel object(sheet);
  const SegmentTree ball(make_sphere(0.01, 200));
  SearchScratch scratch(ball);
  for (const double side : {1.0, -1.0}) {
    const Pose X{Mat3::Identity(), Vec3(0.1, 0.2, side * 0.006)};
    const ContactPatch patch = contact_patch({ball, X, scratch}, object, 1.0);
    EXPECT_NEAR(patch.object_normal.z(), side, 1e-12);
    EXPECT_NEAR(patch.direction.z(), side, 1e-12);
  }
}

TEST(WindingNumber, IsOneInsideZeroOutside) {
  const TriangleMesh torus = make_torus(0.08, 0.02, 800);
  EXPECT_NEAR(winding_number(torus, Vec3(0.04, 0, 0)), 1.0, 1e-9);
  EXPECT_NEAR(winding_number(torus, Vec3(0, 0, 0)), 0.0, 1e-9);
  EXPECT_NEAR(winding_number(torus, Vec3(0.2, 0.1, 0)), 0.0, 1e-9);
}

// A box of 100 x 60 x 40 mm around (0.1, 0, 0.2) m and a segment of 20 x 20 x 10 mm at (0.8, 0.1, -0.3) m:
// apart by 0.7 m along x, half a width of 50 mm, and 15 mm from the segment's origin to its corner. A dozen
// roundings of 6e-8 are 7.2e-7 of that; the search allows 2e-6.
TEST(SegmentView, AllowsForTheRoundingOfAllThatSinglePrecisionHolds) {
  TriangleMesh box = make_box(Vec3(0.10, 0.06, 0.04), 12);
  for (Vec3& v : box.vertices) v += Vec3(0.1, 0.0, 0.2);
  const ObjectTree object(box);
  const SegmentTree segment(make_box(Vec3(0.02, 0.02, 0.01), 12));
  SearchScratch scratch(segment);
  const Pose X{Mat3::Identity(), Vec3(0.8, 0.1, -0.3)};
  const search::SegmentView view = search::view_of({segment, X, scratch}, object);
  EXPECT_NEAR(view.slack, 2e-6 * (0.7 + 0.015 + 0.05), 1e-12);
  const std::array apart{0.7, 0.1, -0.5};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(view.lens_p[i], apart[i], 1e-6);
    EXPECT_EQ(view.p[i], X.p[static_cast<Eigen::Index>(i)]);
  }
}

TEST(MotionView, HasEveryNumberOfTheMotion) {
  SegmentMotion motion;
  motion.angular = Vec3(1, 2, 3);
  motion.linear = Vec3(4, 5, 6);
  motion.angular_rate = Vec3(7, 8, 9);
  motion.linear_rate = Vec3(10, 11, 12);
  motion.speed = 13;
  motion.bend = 14;
  motion.jerk = 15;
  const search::MotionView view = search::view_of(motion);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(view.angular[i], 1.0 + i);
    EXPECT_EQ(view.linear[i], 4.0 + i);
    EXPECT_EQ(view.angular_rate[i], 7.0 + i);
    EXPECT_EQ(view.linear_rate[i], 10.0 + i);
  }
  EXPECT_EQ(view.speed, 13.0);
  EXPECT_EQ(view.bend, 14.0);
  EXPECT_EQ(view.jerk, 15.0);
}

// 24 triangles are three blocks of eight, all within the margin. Before a block there must be room for eight:
// of 24 places there is, of 23 not before the third block, of 15 neither before the second nor the third.
TEST(Gather, AsksForRoomBeforeABlockThatMightNotFit) {
  TriangleMesh mesh{{Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(0, 1, 0)}, {}};
  mesh.triangles.assign(24, Triangle{0, 1, 2});
  const ObjectTree object(mesh);
  const SegmentTree segment(TriangleMesh{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {{0, 1, 2}}});
  SearchScratch scratch(segment);
  const Pose X{Mat3::Identity(), Vec3(0.0, 0.0, 0.5)};
  struct Room {
    std::array<search::PairIndex, 64> pair{};
    search::PairStore store{};
    int calls = 0;
    int taken = 0;
  };
  for (const int capacity : {24, 23, 15}) {
    SCOPED_TRACE(capacity);
    Room room;
    room.store = {room.pair.data(),
                  0,
                  capacity,
                  1.0,
                  [](void* self) {
                    Room& full = *static_cast<Room*>(self);
                    ++full.calls;
                    full.taken += full.store.count;
                    full.store.count = 0;
                  },
                  &room};
    search::functions().gather(search::view_of({segment, X, scratch}, object), search::view_of(object),
                               search::view_of(SegmentMotion{}), 1.0, room.store);
    EXPECT_EQ(room.calls, capacity == 24 ? 0 : capacity == 23 ? 1 : 2);
    EXPECT_EQ(room.taken, 8 * (capacity == 24 ? 0 : 2));
    EXPECT_EQ(room.taken + room.store.count, 24);
  }
}

// Of all pairs within 3 mm, those that come within the margin anywhere on a path of up to 2 mm are kept, for segments
// and objects of all kinds. The path has a constant acceleration; 25 of its poses are looked at.
TEST(Sift, KeepsEveryPairThatTheMotionMayBringWithinTheMargin) {
  constexpr std::uint64_t kSeed = 11;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  constexpr double kMargin = 50e-6;
  test::Random random(kSeed);
  int met = 0;
  int left_out = 0;
  for (const test::SearchCase& shapes : test::search_cases(random)) {
    SCOPED_TRACE(shapes.name);
    const ObjectModel object(shapes.object);
    const SegmentTree segment(shapes.segment);
    SearchScratch scratch(segment);
    for (int n = 0; n < 12; ++n) {
      Pose X = shapes.pose(random);
      const ContactPatch patch = contact_patch({segment, X, scratch}, object, 1.0);
      if (patch.pairs == 0) continue;
      X.p += (test::between(random, 60e-6, 500e-6) - patch.distance) * patch.direction;
      const PlacedSegment placed{segment, X, scratch};
      const search::ObjectView tree = search::view_of(object.tree());
      std::vector<search::PairIndex> pairs;
      search::functions().list(
          search::view_of(placed, object.tree()), tree, 3e-3,
          [](void* list, const search::PairIndex& pair, double) {
            static_cast<std::vector<search::PairIndex>*>(list)->push_back(pair);
            return 3e-3;
          },
          &pairs);
      if (pairs.size() > 1000) pairs.resize(1000);
      // x(h) = x + h v(x) + h^2 / 2 a(x) about the middle of the segment, h in [0, 1].
      const Vec3 middle = X * segment.centre();
      SegmentMotion motion;
      motion.angular = test::in_cube(random, 0.03);
      motion.linear = test::in_cube(random, 1e-3) - 0.5e-3 * patch.direction - motion.angular.cross(middle);
      motion.angular_rate = test::in_cube(random, 0.03);
      motion.linear_rate = test::in_cube(random, 0.5e-3) - motion.angular_rate.cross(middle);
      std::vector<search::PairIndex> kept = pairs;
      kept.resize(static_cast<std::size_t>(
          search::functions().sift(search::view_of(placed, object.tree()), tree, search::view_of(motion), 1.0,
                                   kMargin, kept.data(), static_cast<int>(kept.size()))));
      left_out += static_cast<int>(pairs.size() - kept.size());
      std::size_t next = 0;
      for (const search::PairIndex& pair : pairs) {
        if (next < kept.size() && kept[next].triangle == pair.triangle && kept[next].slot == pair.slot) {
          ++next;  // kept, in order
          continue;
        }
        Corners mine = segment.corners(pair.triangle);
        for (Vec3& x : mine) x = X * x;
        for (int i = 0; i <= 24; ++i) {
          const double h = i / 24.0;
          Corners moved = mine;
          for (Vec3& x : moved) {
            const Vec3 v = motion.velocity(x);
            const Vec3 a = motion.angular_rate.cross(x) + motion.linear_rate + motion.angular.cross(v);
            x += h * v + 0.5 * h * h * a;
          }
          ASSERT_GT(triangle_distance(moved, object.tree().corners(pair.slot)).squared, kMargin * kMargin)
              << "triangle " << pair.triangle << ", slot " << pair.slot << ", at " << h;
        }
      }
      ASSERT_EQ(next, kept.size());
      met += static_cast<int>(kept.size());
    }
  }
  EXPECT_GT(met, 500);
  EXPECT_GT(left_out, 5000);
}

TEST(ObjectModel, RefusesAVertexThatIsMoreThanTenKilometresAwayAlongAnyAxis) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      TriangleMesh mesh{{Vec3::Zero(), Vec3::Ones(), Vec3(1.0, 0.0, 0.0)}, {{0, 1, 2}}};
      mesh.vertices[0][axis] = sign * 9999.0;
      EXPECT_NO_THROW(ObjectModel{mesh}) << axis;
      mesh.vertices[0][axis] = sign * 10001.0;
      EXPECT_THAT([&] { ObjectModel{mesh}; },
                  ::testing::ThrowsMessage<std::invalid_argument>(::testing::HasSubstr("10001.0")))
          << axis;
    }
  }
}

TEST(ObjectModel, KeepsItsPartsWhenItIsMovedFrom) {
  ObjectModel from(make_sphere(0.01, 100));
  const ObjectModel to = std::move(from);
  EXPECT_EQ(from.triangle_count(), to.triangle_count());  // NOLINT(bugprone-use-after-move)
  EXPECT_EQ(&from.tree(), &to.tree());
}

TEST(Containment, SeesASegmentInsideAnObjectAndAnObjectInsideASegment) {
  const TriangleMesh small = make_sphere(0.01, 100);
  const TriangleMesh large = make_sphere(0.1, 400);
  EXPECT_TRUE(Containment(large).with(small, Pose{}));
  EXPECT_TRUE(Containment(small).with(large, Pose{}));
  EXPECT_FALSE(Containment(large).with(small, Pose{Mat3::Identity(), Vec3(0.2, 0, 0)}));
}

// The object is a ball of 5 mm radius, the segment one of 50 mm that has turned and moved. In the segment's
// frame the object is 30 mm off the middle, inside, or 90 mm, outside, or 45 mm along each axis: 78 mm off,
// outside, though within the box around the segment.
TEST(Containment, SeesAnObjectInsideASegmentWhereverThatIs) {
  const TriangleMesh segment = make_sphere(0.1, 400);
  const Pose X{rotation_about(Vec3::UnitZ(), 1.2), Vec3(0.3, -0.1, 0.2)};
  for (const Vec3& off : {Vec3(0.03, 0.0, 0.0), Vec3(0.09, 0.0, 0.0), Vec3(0.045, 0.045, 0.045)}) {
    TriangleMesh ball = make_sphere(0.01, 100);
    for (Vec3& v : ball.vertices) v += X * off;
    EXPECT_EQ(Containment(ball).with(segment, X), off.norm() < 0.05) << off.transpose();
  }
}

TEST(Containment, DoesNotCountVerticesThatNoTriangleUses) {
  TriangleMesh sheet;  // 5 cm below the ball, and a stray vertex inside it
  sheet.vertices = {Vec3(-1, -1, -0.05), Vec3(1, -1, -0.05), Vec3(0, 1, -0.05), Vec3(0, 0, 0)};
  sheet.triangles = {{0, 1, 2}};
  EXPECT_FALSE(Containment(sheet).with(make_sphere(0.01, 100), Pose{}));
}

// Seen from its middle, a ball with a triangle missing covers nearly the whole sphere.
TEST(Containment, AnOpenShellContainsNothingHoweverMuchItSurrounds) {
  const TriangleMesh small = make_sphere(0.01, 100);
  TriangleMesh open = make_sphere(0.1, 400);
  EXPECT_TRUE(Containment(open).with(small, Pose{}));
  open.triangles.pop_back();
  ASSERT_GT(winding_number(open, Vec3::Zero()), 0.9);
  EXPECT_FALSE(Containment(open).with(small, Pose{}));
}

// Two balls of 50 mm, 0.5 m apart, and a sheet that is open: each by itself.
TEST(Containment, LooksAtEveryPartOfTheObjectByItself) {
  TriangleMesh object = make_sphere(0.1, 400);
  append(object, make_sphere(0.1, 300), Pose{Mat3::Identity(), Vec3(0.5, 0, 0)});
  append(object, TriangleMesh{{Vec3(-1, -1, 1), Vec3(1, -1, 1), Vec3(0, 1, 1)}, {{0, 1, 2}}});
  const Containment containment(object);
  const TriangleMesh small = make_sphere(0.01, 100);
  for (const double x : {0.0, 0.25, 0.5})
    EXPECT_EQ(containment.with(small, Pose{Mat3::Identity(), Vec3(x, 0, 0)}), x != 0.25) << x;
}

TEST(Containment, SeesThroughAnInsideOutSolidAndDuplicateFaces) {
  const TriangleMesh small = make_sphere(0.01, 100);
  TriangleMesh inside_out = make_sphere(0.1, 400);
  for (Triangle& t : inside_out.triangles) std::swap(t[1], t[2]);
  EXPECT_TRUE(Containment(inside_out).with(small, Pose{}));
  for (const bool turned : {false, true}) {  // one face twice, once as it is and once the other way round
    TriangleMesh twice = make_sphere(0.1, 400);
    const Triangle t = twice.triangles.front();
    twice.triangles.push_back(turned ? Triangle{t[0], t[2], t[1]} : Triangle{t[1], t[2], t[0]});
    EXPECT_TRUE(Containment(twice).with(small, Pose{})) << turned;
  }
  TriangleMesh sheet;  // a large table, every triangle twice, 3 cm away: contains nothing
  sheet.vertices = {Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(1, 1, 0), Vec3(-1, 1, 0)};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 1, 2}, {0, 2, 3}};
  for (const double side : {0.03, -0.03}) {
    EXPECT_FALSE(Containment(sheet).with(small, Pose{Mat3::Identity(), Vec3(0, 0, side)}));
  }
}

}  // namespace
}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// The first contact along a digit's way: each of its pieces, and all of it, against all pairs of triangles at
// many places of the way.
#include "contact/first_contact.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <iostream>
#include <set>

#include "support/moving_digit.h"
#include "support/sanitized.h"

namespace phalanx {
namespace {

using test::between;
using test::kIndex;
using test::kMargin;
using test::MovingDigit;
using test::Random;

constexpr double kFloor = stop_band(kMargin).floor;
/// The oracle and the search place the same corners, some 0.2 m from the origin, by formulas of their own.
constexpr double kRounding = 1e-13;

TriangleMesh ball_in_reach(int triangles) {
  return test::moved(make_sphere(0.03, triangles), test::at(0.0, -0.03, -0.05));
}

// Over a way that is long for a tick, or short.
void aim_anywhere(Random& random, MovingDigit& digit, double length) {
  DigitAngles from{};
  DigitAngles to{};
  do {
    from = test::any_angles(random, digit.hand(), between(random, 0.0, 1.0));
    to = test::any_angles(random, digit.hand(), 1.0);
    for (std::size_t i = 0; i < kJointsPerDigit; ++i) to[i] = from[i] + length * (to[i] - from[i]);
    digit.aim(from, to);
  } while (digit.gap(0.0) <= kMargin);
}

TEST(PairList, NoPairThatIsNotInItComesWithinTheMarginBeforeTheHorizon) {
  std::cout << "seed 21\n";
  Random random(21);
  MovingDigit plain(ball_in_reach(300));
  MovingDigit with_coupling(ball_in_reach(300), true);
  int met = 0;
  int most = 0;
  for (int n = 0; n < (test::kSlowBuild ? 8 : 40); ++n) {
    MovingDigit& digit = n % 4 < 2 ? plain : with_coupling;
    aim_anywhere(random, digit, n % 2 == 0 ? 1.0 : 0.1);
    const DigitPose start = digit.pose(0.0);
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      PairList list;
      const double horizon = gather_pairs(digit.search(start, k), 0.0, 1.0, k, list);
      ASSERT_GT(horizon, 0.0);
      std::set<std::pair<std::size_t, std::size_t>> listed;
      for (int i = 0; i < list.count; ++i) {
        const PairList::Pair& pair = list.pair[static_cast<std::size_t>(i)];
        listed.emplace(pair.triangle, digit.object().tree().source(pair.slot));
      }
      ASSERT_EQ(static_cast<int>(listed.size()), list.count) << "each pair once, seed 21 way " << n;
      most = std::max(most, list.count);
      for (int step = 0; step <= 16; ++step) {
        for (const test::ExactPair& pair : digit.pairs_within(horizon * step / 16.0, k, kMargin)) {
          ++met;
          ASSERT_TRUE(listed.contains({pair.a, pair.b})) << "seed 21 way " << n << " segment " << k;
        }
      }
    }
  }
  EXPECT_GT(met, test::kSlowBuild ? 200 : 1000);
  EXPECT_GT(most, 256) << "more than reach the list at once";
}

TEST(PairList, NoPairGoesBelowTheFloorBeforeItIsDue) {
  std::cout << "seed 22\n";
  Random random(22);
  MovingDigit plain(ball_in_reach(300));
  MovingDigit with_coupling(ball_in_reach(300), true);
  int stepped = 0;
  for (int n = 0; n < (test::kSlowBuild ? 12 : 60); ++n) {
    MovingDigit& digit = n % 4 < 2 ? plain : with_coupling;
    aim_anywhere(random, digit, n % 2 == 0 ? 1.0 : 0.1);
    const DigitPose start = digit.pose(0.0);
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      const PairSearch search = digit.search(start, k);
      PairList list;
      for (int later = 0; later <= kSegmentsPerDigit; ++later)
        list.begin[static_cast<std::size_t>(later)] = 0;
      const double horizon = gather_pairs(search, 0.0, 1.0, k, list);
      list.begin[static_cast<std::size_t>(k + 1)] = list.count;
      ASSERT_FALSE(evaluate_pairs(search, 0.0, horizon, k, true, list)) << "it starts clear of the margin";
      for (int i = 0; i < list.count; i += 1 + list.count / 20) {
        const PairList::Pair& pair = list.pair[static_cast<std::size_t>(i)];
        stepped += pair.until > 0.0 && pair.until < horizon ? 1 : 0;
        for (int step = 0; step <= 8; ++step) {
          ASSERT_GE(digit.pair_gap(pair.until * step / 8.0, k, pair), kFloor - kRounding)
              << "seed 22 way " << n << " segment " << k << " until " << pair.until;
        }
        if (!pair.near) {
          ASSERT_GT(digit.pair_gap(horizon, k, pair), kMargin - kRounding) << "seed 22 way " << n;
        }
      }
    }
  }
  EXPECT_GT(stepped, test::kSlowBuild ? 60 : 300);
}

struct Stops {
  int stops = 0;
  int exhausted = 0;
};

// The stop is within the band and closing, and nothing was below the floor before it.
void expect_right_stop(MovingDigit& digit, Stops& count, int places) {
  Status status = Status::kOk;
  const Stop stop = digit.advance(status);
  for (int i = 0; i < places; ++i) {
    const double evenly = stop.s * i / places;
    const double crowding = stop.s * (1.0 - std::exp2(-0.75 * i));  // where it comes close
    ASSERT_GE(digit.gap(evenly), kFloor - kRounding) << "at " << evenly << " of " << stop.s;
    ASSERT_GE(digit.gap(crowding), kFloor - kRounding) << "at " << crowding << " of " << stop.s;
  }
  ASSERT_GE(digit.gap(stop.s), kFloor - kRounding);
  if (has(status, Status::kSearchExhausted)) {
    ++count.exhausted;
    return;
  }
  if (stop.segment < 0) {
    ASSERT_EQ(stop.s, 1.0);
    return;
  }
  ++count.stops;
  const double gap = digit.gap(stop.s, stop.segment);
  ASSERT_LE(gap, kMargin + kRounding);
  ASSERT_LE(digit.gap(stop.s + 1e-7, stop.segment), gap + kRounding) << "it stops what closes";
}

Stops check_stops(std::uint64_t seed, MovingDigit& digit, int ways, int places, double length) {
  Random random(seed);
  Stops count;
  for (int n = 0; n < ways; ++n) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed << " way " << n);
    aim_anywhere(random, digit, length);
    expect_right_stop(digit, count, places);
    if (::testing::Test::HasFatalFailure()) break;
  }
  return count;
}

TEST(FirstContact, WithoutEvaluationsLeftTheDigitStandsStillAsAWholeAndSaysSo) {
  MovingDigit digit(ball_in_reach(300));
  digit.aim({}, {0.1, 0.0, 0.2, 0.3});
  Status status = Status::kOk;
  const Stop stop = digit.advance(status, kMaxEvaluations);
  EXPECT_EQ(stop.s, 0.0);
  EXPECT_EQ(stop.segment, kSegmentsPerDigit - 1) << "the most distal: no joint moves on";
  EXPECT_TRUE(has(status, Status::kSearchExhausted));
}

TEST(FirstContact, IsTheFirstPlaceWithinTheMarginThatCloses) {
  std::cout << "seed 23\n";
  for (const bool with_coupling : {false, true}) {
    MovingDigit digit(ball_in_reach(300), with_coupling);
    for (const double length : {1.0, 0.1}) {
      const Stops found = check_stops(23, digit, with_coupling ? 20 : 40, test::kSlowBuild ? 1 : 8, length);
      EXPECT_GT(found.stops, with_coupling ? 1 : 3);
      EXPECT_EQ(found.exhausted, 0);
    }
  }
}

TEST(SoakFirstContact, IsTheFirstPlaceWithinTheMarginThatCloses) {
  Random shapes(5);
  const std::vector<TriangleMesh> objects = {
      ball_in_reach(300), ball_in_reach(4000),
      test::moved(make_torus(0.05, 0.012, 900), test::at(0, -0.045, -0.05)),
      test::moved(test::meridians(200), test::at(0.0, -0.07, -0.05)),
      test::moved(test::soup(shapes, 60), test::at(0.0, -0.13, -0.05))};
  for (const TriangleMesh& object : objects) {
    MovingDigit plain(object);
    MovingDigit with_coupling(object, true);
    // The independent distance looks at every pair of triangles, so the number of ways falls with the number
    // of triangles.
    const int ways = std::clamp(24'000 / static_cast<int>(object.triangles.size()), 10, 300);
    int stops = 0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      std::cout << "seed " << seed << ", " << ways << " ways\n";
      for (const double length : {1.0, 0.1, 0.01}) {
        MovingDigit& digit = seed % 2 == 1 ? plain : with_coupling;
        stops += check_stops(seed, digit, ways, 32, length).stops;
      }
    }
    EXPECT_GT(stops, 3) << object.triangles.size() << " triangles";
  }
}

/// Whether the first list of a way runs over.
bool runs_over(MovingDigit& digit, int k) {
  const DigitPose start = digit.pose(0.0);
  PairList list;
  return gather_pairs(digit.search(start, k), 0.0, 1.0, k, list) < 1.0;
}

TriangleMesh coincident_plates(int n) {
  TriangleMesh mesh;
  for (int i = 0; i < n; ++i)
    test::add_triangle(mesh, Vec3(-0.2, -0.03, 0.2), Vec3(0.2, -0.03, 0.2), Vec3(0.0, -0.03, -0.4));
  return mesh;
}

struct Crowd {
  const char* name;
  TriangleMesh object;
  TriangleMesh once;  ///< no triangle twice
  bool may_give_up;   ///< more pairs are met at the same place than a list holds
};

TEST(FirstContact, IsRightWhereTheListRunsOver) {
  const TriangleMesh ball = ball_in_reach(6000);
  const TriangleMesh slivers = test::moved(test::meridians(300), test::at(0.0, -0.07, -0.05));
  const Crowd crowds[] = {
      {"a fine ball", ball, ball, false},
      {"slivers from pole to pole", slivers, slivers, false},
      {"3,000 coincident triangles", coincident_plates(3000), coincident_plates(1), true}};
  for (const Crowd& crowd : crowds) {
    SCOPED_TRACE(crowd.name);
    MovingDigit digit(crowd.object, crowd.once);
    Random random(24);
    int over = 0;
    Stops count;
    for (int n = 0; n < 4; ++n) {
      SCOPED_TRACE(::testing::Message() << "seed 24 way " << n);
      aim_anywhere(random, digit, n % 2 == 0 ? 1.0 : 0.3);
      for (int k = 0; k < kSegmentsPerDigit; ++k) over += runs_over(digit, k) ? 1 : 0;
      ASSERT_NO_FATAL_FAILURE(expect_right_stop(digit, count, test::kSlowBuild ? 1 : 5));
    }
    std::cout << crowd.name << ": " << over << " lists ran over, " << count.stops << " stops, "
              << count.exhausted << " given up\n";
    EXPECT_GT(over, 0);
    EXPECT_GT(count.stops + count.exhausted, 2);
    if (!crowd.may_give_up) {
      EXPECT_EQ(count.exhausted, 0);
    }
  }
}

}  // namespace
}  // namespace phalanx

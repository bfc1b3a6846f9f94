// SPDX-License-Identifier: Apache-2.0
#include "phalanx/contact/near_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>

#include "phalanx/contact/gdp.h"
#include "phalanx/contact/proximity.h"
#include "phalanx/core/index.h"
#include "phalanx/mesh/primitives.h"
#include "phalanx/step/haptic_step.h"
#include "support/human_motion.h"
#include "support/sanitized.h"
#include "support/search_cases.h"
#include "support/simple_hand.h"

namespace phalanx {
namespace {

class NearPairsTest : public ::testing::Test {
 protected:
  /// All pairs within `reach`, one by one.
  [[nodiscard]] std::size_t pairs_within(const Pose& X, double reach) const {
    std::size_t count = 0;
    for (int i = 0; i < segment_.size(); ++i) {
      Corners mine = segment_.corners(i);
      for (Vec3& x : mine) x = X * x;
      for (int slot = 0; slot < object_.tree().size(); ++slot)
        count += triangle_distance(mine, object_.tree().corners(slot)).squared <= reach * reach ? 1U : 0U;
    }
    return count;
  }
  static Pose above(double gap) { return {Mat3::Identity(), Vec3(0.003, -0.002, 0.11 + gap)}; }

  const SegmentTree segment_{make_box(Vec3(0.02, 0.02, 0.02), 300)};
  const ObjectModel object_{make_box(Vec3(0.2, 0.2, 0.2), 1200)};
  SearchScratch scratch_{segment_};
  NearPairs near_;
};

TEST_F(NearPairsTest, AreAllPairsWithinTheReach) {
  const Pose X = above(50e-6);
  near_.find({segment_, X, scratch_}, object_.tree(), 60e-6);
  EXPECT_EQ(near_.count(), pairs_within(X, 60e-6));
  EXPECT_GT(near_.count(), 0U);
  for (std::size_t i = 0; i < near_.count(); ++i) EXPECT_NEAR(near_[i].closest.squared, 50e-6 * 50e-6, 1e-20);
  EXPECT_TRUE(near_.is_within(X, 51e-6));
  EXPECT_FALSE(near_.is_within(X, 49e-6));
}

TEST_F(NearPairsTest, HoldForOnePoseUpToOneReach) {
  const Pose X = above(50e-6);
  EXPECT_FALSE(near_.holds(X, 60e-6));
  near_.find({segment_, X, scratch_}, object_.tree(), 60e-6);
  EXPECT_TRUE(near_.holds(X, 60e-6));
  EXPECT_TRUE(near_.holds(X, 55e-6));
  EXPECT_FALSE(near_.holds(X, 61e-6));
  Pose moved = X;
  moved.p.x() += 1e-15;
  EXPECT_FALSE(near_.holds(moved, 60e-6));
  EXPECT_FALSE(near_.is_within(moved, 60e-6));
  Pose turned = X;
  turned.R(0, 1) += 1e-15;
  EXPECT_FALSE(near_.holds(turned, 60e-6));
  near_.stop_at(X);
  EXPECT_TRUE(near_.holds(X, 60e-6)) << "it was there already";
  near_.stop_at(moved);
  EXPECT_TRUE(near_.is_at(moved));
  EXPECT_FALSE(near_.holds(moved, 60e-6)) << "stored, not searched";
  near_.clear();
  EXPECT_FALSE(near_.is_at(moved));
}

TEST_F(NearPairsTest, TooManyAreNotHeld) {
  const SegmentTree fine(make_box(Vec3(0.02, 0.02, 0.02), 30'000));
  SearchScratch scratch(fine);
  const Pose X = above(50e-6);
  near_.find({fine, X, scratch}, object_.tree(), 60e-6);
  EXPECT_TRUE(near_.overflows());
  EXPECT_FALSE(near_.holds(X, 60e-6));
}

TEST_F(NearPairsTest, AContactWithTheScratchsMemorySearchesEachTime) {
  const Pose X = above(50e-6);
  EXPECT_GT(contact_patch({segment_, X, scratch_}, object_, 60e-6).pairs, 0);
  const ObjectModel lower(make_box(Vec3(0.2, 0.2, 0.198), 1200));
  EXPECT_EQ(contact_patch({segment_, X, scratch_}, lower, 60e-6).pairs, 0);
}

/// @returns true if both hold the same pairs in the same order, with the same bits
bool same_pairs(const NearPairs& a, const NearPairs& b) {
  if (a.count() != b.count()) return false;
  if (a.overflows()) return true;
  for (std::size_t i = 0; i < a.count(); ++i) {
    const NearPairs::Pair& p = a[i];
    const NearPairs::Pair& q = b[i];
    if (p.triangle != q.triangle || p.slot != q.slot || p.closest.squared != q.closest.squared ||
        p.closest.on_a != q.closest.on_a || p.closest.on_b != q.closest.on_b)
      return false;
  }
  return true;
}

// Segments of all kinds wander beside objects of all kinds, by up to a quarter of a millimetre at a time.
TEST(CandidatePairs, AreThoseThatASearchFinds) {
  constexpr std::uint64_t kSeed = 7;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  test::Random random(kSeed);
  int from_list = 0;
  int found = 0;
  for (const test::SearchCase& shapes : test::search_cases(random)) {
    SCOPED_TRACE(shapes.name);
    const ObjectModel object(shapes.object);
    const SegmentTree segment(shapes.segment);
    SearchScratch scratch(segment);
    NearPairs listed;
    listed.candidates().allocate();
    NearPairs searched;
    for (int start = 0; start < 6; ++start) {
      Pose X = shapes.pose(random);
      const ContactPatch patch = contact_patch({segment, X, scratch}, object, 1.0);
      if (patch.pairs == 0) continue;
      X.p += (100e-6 - patch.distance) * patch.direction;
      const double step = test::between(random, 0.0, 1.0);
      listed.clear();
      for (int i = 0; i < 40; ++i) {
        const Vec3 axis = test::in_cube(random, 1.0);
        const Mat3 turn = rotation_about(axis.normalized(), step * test::between(random, 0.0, 2e-3));
        const Vec3 pivot = patch.on_segment;
        X.p = pivot + turn * (X.p - pivot) + step * test::in_cube(random, 0.1e-3);
        X.R = turn * X.R;
        const PlacedSegment placed{segment, X, scratch};
        const double reach = test::between(random, 0.0, 400e-6);
        from_list += listed.candidates().cover(placed, reach) ? 1 : 0;
        if (i % 3 != 2) listed.candidates().list(placed, object.tree(), reach);
        listed.find(placed, object.tree(), reach);
        searched.clear();
        searched.find(placed, object.tree(), reach);
        ASSERT_TRUE(same_pairs(listed, searched))
            << "step " << i << ", " << listed.count() << " and " << searched.count() << " pairs";
        found += static_cast<int>(searched.count());
      }
    }
  }
  EXPECT_GT(from_list, 500);
  EXPECT_GT(found, 5000);
}

TEST(CandidatePairs, LastForTheWayThatTheyWereListedFor) {
  const SegmentTree segment(make_box(Vec3(0.02, 0.02, 0.02), 300));
  const ObjectModel object(make_box(Vec3(0.2, 0.2, 0.2), 1200));
  SearchScratch scratch(segment);
  CandidatePairs candidates;
  candidates.allocate();
  Pose X{Mat3::Identity(), Vec3(0.003, -0.002, 0.11 + 50e-6)};
  const PlacedSegment placed{segment, X, scratch};
  EXPECT_FALSE(candidates.cover(placed, 0.0)) << "nothing is listed";
  candidates.list(placed, object.tree(), 60e-6);
  EXPECT_FALSE(candidates.empty());
  EXPECT_TRUE(candidates.cover(placed, 60e-6));
  EXPECT_TRUE(candidates.cover(placed, 359e-6));
  EXPECT_FALSE(candidates.cover(placed, 361e-6));
  X.p.x() += 200e-6;  // to and fro: it is the way that counts
  EXPECT_TRUE(candidates.cover(placed, 159e-6));
  X.p.x() -= 90e-6;
  EXPECT_TRUE(candidates.cover(placed, 69e-6));
  EXPECT_FALSE(candidates.cover(placed, 71e-6));
  // Half the diagonal of the box is 17.3 mm: 2 mrad about its middle move a corner by 34.6 um.
  X.R = rotation_about(Vec3::UnitX(), 2e-3);
  EXPECT_TRUE(candidates.cover(placed, 35e-6));
  EXPECT_FALSE(candidates.cover(placed, 36e-6));
  const auto near = [&](double reach) {
    int count = 0;
    candidates.for_each(reach, [&](const CandidatePairs::Pair&) { ++count; });
    return count;
  };
  EXPECT_GT(near(60e-6), 0);
  candidates.for_each(60e-6, [&](CandidatePairs::Pair& pair) { candidates.measured(pair, 80e-6); });
  EXPECT_EQ(near(79e-6), 0) << "measured here, not where they were listed";
  EXPECT_GT(near(81e-6), 0);
  candidates.clear();
  EXPECT_TRUE(candidates.empty());
  EXPECT_FALSE(candidates.cover(placed, 0.0));
}

TEST(CandidatePairs, AreNotListedForAFastSegmentOrBesideTooFineAMesh) {
  const ObjectModel object(make_box(Vec3(0.2, 0.2, 0.2), 1200));
  const SegmentTree coarse(make_box(Vec3(0.02, 0.02, 0.02), 300));
  const SegmentTree fine(make_box(Vec3(0.02, 0.02, 0.02), 30'000));
  const Pose X{Mat3::Identity(), Vec3(0.003, -0.002, 0.11 + 50e-6)};
  CandidatePairs candidates;
  {
    SearchScratch scratch(coarse);
    candidates.list({coarse, X, scratch}, object.tree(), 60e-6);
    EXPECT_FALSE(candidates.cover({coarse, X, scratch}, 0.0)) << "no memory";
    candidates.allocate();
    candidates.list({coarse, X, scratch}, object.tree(), 1.001e-3);
    EXPECT_FALSE(candidates.cover({coarse, X, scratch}, 0.0));
    candidates.list({coarse, X, scratch}, object.tree(), 0.999e-3);
    EXPECT_TRUE(candidates.cover({coarse, X, scratch}, 0.999e-3));
    candidates.clear();
  }
  SearchScratch scratch(fine);
  candidates.list({fine, X, scratch}, object.tree(), 60e-6);
  EXPECT_TRUE(candidates.empty());
  EXPECT_FALSE(candidates.cover({fine, X, scratch}, 0.0));
  NearPairs near;
  near.candidates().allocate();
  near.candidates().list({fine, X, scratch}, object.tree(), 60e-6);
  near.find({fine, X, scratch}, object.tree(), 60e-6);
  EXPECT_TRUE(near.overflows()) << "a search found them";
}

// A ball of 14 mm wanders over one of 60 mm. The list holds all pairs within 60 um, but not those of 0.3 mm of way.
TEST(CandidatePairs, BesideAFineMeshTheyLastForLessOfTheWay) {
  constexpr std::uint64_t kSeed = 5;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  test::Random random(kSeed);
  const SegmentTree segment(make_sphere(0.014, 20'000));
  const ObjectModel object(make_sphere(0.06, 200'000));
  SearchScratch scratch(segment);
  NearPairs listed;
  CandidatePairs& candidates = listed.candidates();
  candidates.allocate();
  NearPairs searched;
  Pose X{Mat3::Identity(), Vec3(0.037 + 50e-6, 0.0, 0.001)};
  int lists = 0;
  int covered = 0;
  for (int i = 0; i < 200; ++i) {
    X.p += test::in_cube(random, 5e-6);
    X.p *= (0.037 + 50e-6) / X.p.norm();
    const PlacedSegment placed{segment, X, scratch};
    const bool was_covered = candidates.cover(placed, 60e-6);
    candidates.list(placed, object.tree(), 60e-6);
    ASSERT_TRUE(candidates.cover(placed, 60e-6)) << "step " << i;
    EXPECT_FALSE(candidates.cover(placed, 359e-6)) << "step " << i;
    lists += was_covered ? 0 : 1;
    listed.find(placed, object.tree(), 60e-6);
    searched.clear();
    searched.find(placed, object.tree(), 60e-6);
    ASSERT_FALSE(searched.overflows());
    ASSERT_GT(searched.count(), 20U);
    ASSERT_TRUE(same_pairs(listed, searched)) << "step " << i;
    covered += was_covered ? 1 : 0;
  }
  EXPECT_LT(lists, 50) << "of " << covered + lists;
}

/// Two hands in the same motion. The stored pairs of one are removed before each tick, so that it lists what
/// its digits may meet.
class Twice {
 public:
  explicit Twice(const TriangleMesh& mesh, int hand_triangles, ContactMode mode = ContactMode::kStatic)
      : model_(hand(hand_triangles), ObjectModel(mesh)),
        parameters_{.mode = mode},
        contact_{model_.hand, model_.trees(), model_.object, parameters_},
        stores_(contact_),
        lists_(contact_) {
    for (NearPairs& near : lists_.near) near = NearPairs();  // without candidates: it searches the trees
  }

  void tick(const JointArray& hcp) {
    std::array<bool, kDigits> measured{};
    measured.fill(true);
    HandPoses poses;
    model_.hand.poses(hcp, poses);
    for (NearPairs& near : lists_.near) near.clear();
    const Status status = advance_gdp(contact_, hcp, poses, measured, stores_);
    ASSERT_EQ(advance_gdp(contact_, hcp, poses, measured, lists_), status);
    ASSERT_EQ(stores_.angle, lists_.angle);
    for (int s = 0; s < kPalm; ++s) {
      const ContactRecord& a = stores_.record[idx(s)];
      const ContactRecord& b = lists_.record[idx(s)];
      ASSERT_EQ(a.active, b.active) << segment_name(s);
      ASSERT_EQ(a.p_S, b.p_S) << segment_name(s);
      ASSERT_EQ(a.n_c, b.n_c) << segment_name(s);
      ASSERT_EQ(a.force_normal, b.force_normal) << segment_name(s);
      ASSERT_EQ(a.offset, b.offset) << segment_name(s);
      ASSERT_EQ(a.depth, b.depth) << segment_name(s);
      ASSERT_EQ(a.couple, b.couple) << segment_name(s);
      if (parameters_.mode == ContactMode::kSliding)
        continue;  // where there are candidates, no bound is computed
      // Bounds within the margin tell the search nothing.
      ASSERT_EQ(std::max(stores_.clearance[idx(s)].bound(), parameters_.margin),
                std::max(lists_.clearance[idx(s)].bound(), parameters_.margin))
          << segment_name(s);
    }
    for (NearPairs& near : stores_.near) candidates += near.candidates().empty() ? 0 : 1;
    const std::uint64_t stores = queries(stores_, stores_before_);
    shortened += stores < queries(lists_, lists_before_) ? 1 : 0;
    longest_list = std::max(longest_list, lists_.pairs.count);
  }
  [[nodiscard]] const HandParameters& hand_parameters() const { return model_.hand.parameters(); }

  int shortened = 0;     ///< ticks in which stored pairs saved a search
  int candidates = 0;    ///< segments with candidates, summed over the ticks
  int longest_list = 0;  ///< of the digit that was last in a tick [pairs]

 private:
  static HandModel hand(int triangles) {
    HandParameters hand = test::simple_parameters();
    for (int d = 0; d < kDigits; ++d) hand.digits[idx(d)].base.x() = 0.022 * (d - 2);
    return make_hand_model(hand, Handedness::kRight, Pose{}, triangles);
  }
  /// Queries since the last call.
  static std::uint64_t queries(GdpState& state, std::uint64_t& before) {
    const std::uint64_t now = state.scratch.next_query();
    return now - std::exchange(before, now);
  }

  HapticModel model_;
  ContactParameters parameters_;
  ContactModel contact_;
  GdpState stores_;
  GdpState lists_;
  std::uint64_t stores_before_ = 0;
  std::uint64_t lists_before_ = 0;
};

/// Plays whole motions of a hand that reaches for an object, holds it, slides along it and lets go.
void play(Twice& hands, std::uint64_t seed, int ticks) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  test::HumanMotion motion(hands.hand_parameters(), seed);
  for (int t = 0; t < ticks; ++t) {
    hands.tick(motion.next(0.001));
    if (::testing::Test::HasFatalFailure()) FAIL() << "tick " << t;
  }
}

/// A bar and a ball in the fingers' way, at the edges of which they stay behind.
TriangleMesh bar(int triangles) {
  return test::moved(make_box(Vec3(0.12, 0.012, 0.012), triangles), test::at(0.0, -0.030, -0.050));
}
TriangleMesh ball(int triangles) {
  return test::moved(make_sphere(0.05, triangles), test::at(0.004, -0.040, -0.050));
}

TriangleMesh rod(int triangles) {
  const Pose across{rotation_about(Vec3::UnitY(), std::numbers::pi / 2.0), Vec3(0.0, -0.030, -0.050)};
  return test::moved(make_cylinder(0.012, 0.12, triangles), across);
}

// One hand keeps candidates over its ticks, the other searches the trees in each.
TEST(NearPairsOfTheHand, ChangeNoBitWhereFingersSlide) {
  int candidates = 0;
  for (const TriangleMesh& object : {bar(300), ball(2000)}) {
    for (std::uint64_t seed = 4; seed <= 6; ++seed) {
      Twice hands(object, 800, ContactMode::kSliding);
      play(hands, seed, test::kSlowBuild ? 300 : 3000);
      candidates += hands.candidates;
    }
  }
  EXPECT_GT(candidates, test::kSlowBuild ? 10 : 1000);
}

TEST(NearPairsOfTheHand, ChangeNoBit) {
  for (const TriangleMesh& object : {bar(300), ball(2000)}) {
    int shortened = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      Twice hands(object, 800);
      play(hands, seed, 3000);
      shortened += hands.shortened;
    }
    EXPECT_GT(shortened, 100);
  }
}

// Of meshes so fine that a digit lists more than a thousand pairs.
TEST(NearPairsOfTheHand, ChangeNoBitOfFineMeshes) {
  Twice hands(rod(200'000), 20'000);
  play(hands, 2, test::kSlowBuild ? 100 : 2000);
  if (test::kSlowBuild) return;
  EXPECT_GT(hands.shortened, 20);
  EXPECT_GT(hands.longest_list, 1000);
}

}  // namespace
}  // namespace phalanx

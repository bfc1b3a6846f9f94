// SPDX-License-Identifier: Apache-2.0
#include "phalanx/contact/near_pairs.h"

#include <gtest/gtest.h>

#include <string>

#include "phalanx/contact/gdp.h"
#include "phalanx/contact/proximity.h"
#include "phalanx/core/index.h"
#include "phalanx/mesh/primitives.h"
#include "phalanx/step/haptic_step.h"
#include "support/human_motion.h"
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

TEST_F(NearPairsTest, HoldsEachPairWithinTheReach) {
  const Pose X = above(50e-6);
  near_.find({segment_, X, scratch_}, object_.tree(), 60e-6);
  EXPECT_EQ(near_.count(), pairs_within(X, 60e-6));
  EXPECT_GT(near_.count(), 0U);
  for (std::size_t i = 0; i < near_.count(); ++i) EXPECT_NEAR(near_[i].closest.squared, 50e-6 * 50e-6, 1e-20);
  EXPECT_TRUE(near_.is_within(X, 51e-6));
  EXPECT_FALSE(near_.is_within(X, 49e-6));
}

TEST_F(NearPairsTest, KnowsOnePoseUpToOneReach) {
  const Pose X = above(50e-6);
  EXPECT_FALSE(near_.known(X, 60e-6));
  near_.find({segment_, X, scratch_}, object_.tree(), 60e-6);
  EXPECT_TRUE(near_.known(X, 60e-6));
  EXPECT_TRUE(near_.known(X, 55e-6));
  EXPECT_FALSE(near_.known(X, 61e-6));
  Pose moved = X;
  moved.p.x() += 1e-15;
  EXPECT_FALSE(near_.known(moved, 60e-6));
  EXPECT_FALSE(near_.is_within(moved, 60e-6));
  Pose turned = X;
  turned.R(0, 1) += 1e-15;
  EXPECT_FALSE(near_.known(turned, 60e-6));
  near_.stop_at(X);
  EXPECT_TRUE(near_.known(X, 60e-6)) << "it was there already";
  near_.stop_at(moved);
  EXPECT_TRUE(near_.is_at(moved));
  EXPECT_FALSE(near_.known(moved, 60e-6)) << "noted, not searched";
  near_.forget();
  EXPECT_FALSE(near_.is_at(moved));
}

TEST_F(NearPairsTest, KeepsNoneOfTooMany) {
  const SegmentTree fine(make_box(Vec3(0.02, 0.02, 0.02), 10800));
  SearchScratch scratch(fine);
  const Pose X = above(50e-6);
  near_.find({fine, X, scratch}, object_.tree(), 60e-6);
  EXPECT_GT(near_.count(), NearPairs::kMost);
  EXPECT_FALSE(near_.known(X, 60e-6));
}

// What a contact knew of another object must not answer for this one.
TEST_F(NearPairsTest, AContactWithTheScratchsMemorySearchesEachTime) {
  const Pose X = above(50e-6);
  EXPECT_GT(contact_patch({segment_, X, scratch_}, object_, 60e-6).pairs, 0);
  const ObjectModel lower(make_box(Vec3(0.2, 0.2, 0.198), 1200));
  EXPECT_EQ(contact_patch({segment_, X, scratch_}, lower, 60e-6).pairs, 0);
}

/// Two hands in the same motion, of which one forgets what its segments knew.
class Twice {
 public:
  explicit Twice(const TriangleMesh& mesh)
      : object_(mesh),
        model_(hand(), ObjectModel(mesh)),
        contact_{model_.hand, model_.trees(), model_.object, parameters_},
        knows_(contact_),
        forgets_(contact_) {}

  void tick(const JointArray& hcp) {
    std::array<bool, kDigits> measured{};
    measured.fill(true);
    HandPoses poses;
    model_.hand.poses(hcp, poses);
    for (NearPairs& near : forgets_.near) near.forget();
    std::array<bool, kSegments> known{};
    for (int s = 0; s < kPalm; ++s) known[idx(s)] = knows_.near[idx(s)].is_at(pose(s));
    const Status status = advance_gdp(contact_, hcp, poses, measured, knows_);
    ASSERT_EQ(advance_gdp(contact_, hcp, poses, measured, forgets_), status);
    ASSERT_EQ(knows_.angle, forgets_.angle);
    for (int s = 0; s < kPalm; ++s) {
      const ContactRecord& a = knows_.record[idx(s)];
      const ContactRecord& b = forgets_.record[idx(s)];
      ASSERT_EQ(a.active, b.active) << segment_name(s);
      ASSERT_EQ(a.p_S, b.p_S) << segment_name(s);
      ASSERT_EQ(a.n_c, b.n_c) << segment_name(s);
      ASSERT_EQ(a.force_normal, b.force_normal) << segment_name(s);
      ASSERT_EQ(a.offset, b.offset) << segment_name(s);
      ASSERT_EQ(a.depth, b.depth) << segment_name(s);
      stayed += known[idx(s)] && knows_.near[idx(s)].is_at(pose(s)) ? 1 : 0;
      contacts += a.active ? 1 : 0;
    }
  }
  [[nodiscard]] const HandParameters& hand_parameters() const { return model_.hand.parameters(); }

  long stayed = 0;  ///< segments that did not move in a tick, so that what they knew could be used
  long contacts = 0;

 private:
  static HandModel hand() {
    HandParameters hand = test::simple_parameters();
    for (int d = 0; d < kDigits; ++d) hand.digits[idx(d)].base.x() = 0.022 * (d - 2);
    return make_hand_model(hand, Handedness::kRight, Pose{}, 800);
  }
  [[nodiscard]] const Pose& pose(int s) const {
    return knows_.poses.digit[idx(digit_of_segment(s))].segment[idx(s % kSegmentsPerDigit)];
  }

  TriangleMesh object_;
  HapticModel model_;
  ContactParameters parameters_;
  ContactModel contact_;
  GdpState knows_;
  GdpState forgets_;
};

// Whole motions of a hand that reaches for an object, holds it, slides along it and lets go.
TEST(NearPairsOfTheHand, ChangeNothing) {
  const struct {
    const char* name;
    TriangleMesh mesh;
  } objects[] = {{"ball", test::moved(make_sphere(0.05, 2000), test::at(0.004, -0.068, -0.045))},
                 {"box", test::moved(make_box(Vec3(0.09, 0.03, 0.05), 600), test::at(0.0, -0.045, -0.05))}};
  for (const auto& object : objects) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      SCOPED_TRACE(std::string(object.name) + ", seed " + std::to_string(seed));
      Twice hands(object.mesh);
      test::HumanMotion motion(hands.hand_parameters(), seed);
      for (int t = 0; t < 1500; ++t) {
        hands.tick(motion.next(0.001));
        if (HasFatalFailure()) FAIL() << "tick " << t;
      }
      EXPECT_GT(hands.contacts, 100);
      EXPECT_GT(hands.stayed, 100) << "in too few ticks anything could be known";
    }
  }
}

}  // namespace
}  // namespace phalanx

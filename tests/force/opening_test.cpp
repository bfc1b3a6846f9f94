// SPDX-License-Identifier: Apache-2.0
#include "phalanx/force/opening.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "force/force_stage_fixture.h"
#include "support/all_stabilisers.h"

namespace phalanx {
namespace {

using test::kDistal;
using test::kProximal;
using test::kTick;
using Stage = test::ForceStageFixture;

/// One tick of 10 ms; the force of the last one was the bound.
void go_on(OpeningState& opening, std::optional<double> way) {
  opening.advance(true, way, opening.now().force, 0.01);
}
/// Ticks at one way.
void wait(OpeningState& opening, double seconds, std::optional<double> way = 0.02) {
  for (int i = 0; i < static_cast<int>(100.0 * seconds + 0.5); ++i) go_on(opening, way);
}

TEST(Opening, NeedsAConfirmation) {
  OpeningState opening;
  EXPECT_FALSE(opening.confirm()) << "nothing is inside";
  opening.advance(false, std::nullopt, 0.0, 0.01);
  EXPECT_EQ(opening.now().phase, OpeningPhase::kNone);
  wait(opening, 60.0);
  EXPECT_EQ(opening.now().phase, OpeningPhase::kUnconfirmed);
  EXPECT_EQ(opening.now().force, 0.0);
  EXPECT_EQ(opening.now().way, 0.02);
  EXPECT_TRUE(opening.confirm());
  EXPECT_FALSE(opening.confirm()) << "once";
  EXPECT_EQ(opening.now().phase, OpeningPhase::kConfirmed);
  EXPECT_EQ(opening.now().force, 0.0);
}

TEST(Opening, RisesByOneNewtonASecondToOneNewton) {
  OpeningState opening;
  wait(opening, 0.01);
  opening.confirm();
  for (int i = 1; i <= 250; ++i) {
    go_on(opening, 0.02);
    EXPECT_NEAR(opening.now().force, std::min(1.0, 0.01 * i), 1e-12) << i;
  }
}

TEST(Opening, EndsAfterThreeSecondsInWhichTheFingerDoesNotFollow) {
  OpeningState opening;
  wait(opening, 0.01, 0.02);
  opening.confirm();
  wait(opening, 2.9, 0.0195);  // half a millimetre is no progress
  EXPECT_EQ(opening.now().phase, OpeningPhase::kConfirmed);
  wait(opening, 2.9, 0.0185);  // 1.5 mm is
  EXPECT_EQ(opening.now().phase, OpeningPhase::kConfirmed);
  EXPECT_EQ(opening.now().force, 1.0);
  wait(opening, 0.2, 0.0185);
  EXPECT_EQ(opening.now().phase, OpeningPhase::kNotFollowed);
  EXPECT_EQ(opening.now().force, 0.0);
  wait(opening, 60.0, 0.001);
  EXPECT_EQ(opening.now().phase, OpeningPhase::kNotFollowed) << "it comes back by a confirmation alone";
  EXPECT_TRUE(opening.confirm());
  go_on(opening, 0.001);
  EXPECT_NEAR(opening.now().force, 0.01, 1e-12) << "from zero again";
}

// A finger that goes deeper, and then comes back to where it was, has not followed.
TEST(Opening, CountsProgressFromTheShortestWay) {
  OpeningState opening;
  wait(opening, 0.01, 0.02);
  opening.confirm();
  wait(opening, 2.0, 0.024);
  wait(opening, 1.1, 0.0195);
  EXPECT_EQ(opening.now().phase, OpeningPhase::kNotFollowed);
}

// Half of a short way is progress.
TEST(Opening, LetsAFingerFollowThatIsHardlyInside) {
  OpeningState opening;
  wait(opening, 0.01, 0.6e-3);
  opening.confirm();
  wait(opening, 2.9, 0.6e-3);
  wait(opening, 2.9, 0.25e-3);
  EXPECT_EQ(opening.now().phase, OpeningPhase::kConfirmed);
}

TEST(Opening, CoversTheWayThatWasConfirmedAndFiveMillimetresMore) {
  OpeningState opening;
  wait(opening, 0.01, 0.02);
  opening.confirm();
  wait(opening, 0.5, 0.0249);
  EXPECT_EQ(opening.now().phase, OpeningPhase::kConfirmed);
  go_on(opening, 0.0251);
  EXPECT_EQ(opening.now().phase, OpeningPhase::kUnconfirmed);
  EXPECT_EQ(opening.now().force, 0.0);
}

TEST(Opening, KeepsTheWayOverTicksWithoutAContactAndNeedsOneToBegin) {
  OpeningState opening;
  wait(opening, 1.0, std::nullopt);
  EXPECT_FALSE(opening.confirm()) << "there is no way to confirm";
  wait(opening, 0.01, 0.02);
  ASSERT_TRUE(opening.confirm());
  wait(opening, 2.5, 0.02);
  go_on(opening, std::nullopt);
  EXPECT_EQ(opening.now().way, 0.02);
  wait(opening, 0.6, 0.02);
  EXPECT_EQ(opening.now().phase, OpeningPhase::kNotFollowed) << "the gap was no progress";
}

// After a second without a force, as without good samples, it does not jump.
TEST(Opening, RisesFromTheForceThatWasSent) {
  OpeningState opening;
  wait(opening, 0.01);
  opening.confirm();
  for (int i = 0; i < 100; ++i) opening.advance(true, 0.02, 0.0, 0.01);
  EXPECT_NEAR(opening.now().force, 0.01, 1e-12);
  for (int i = 0; i < 100; ++i) opening.advance(true, 0.02, 0.3, 0.01);
  EXPECT_NEAR(opening.now().force, 0.31, 1e-12);
}

TEST(Opening, EndsWhenTheDigitIsClearOrTheConfirmationIsWithdrawn) {
  OpeningState opening;
  wait(opening, 0.01);
  opening.withdraw();
  EXPECT_EQ(opening.now().phase, OpeningPhase::kUnconfirmed);
  opening.confirm();
  wait(opening, 0.5);
  opening.withdraw();
  EXPECT_EQ(opening.now().phase, OpeningPhase::kUnconfirmed);
  EXPECT_EQ(opening.now().force, 0.0);
  opening.confirm();
  wait(opening, 0.5);
  EXPECT_NEAR(opening.now().force, 0.5, 1e-12);
  opening.advance(false, std::nullopt, 0.0, 0.01);
  EXPECT_EQ(opening.now().phase, OpeningPhase::kNone);
  EXPECT_EQ(opening.now().force, 0.0);
  opening.withdraw();
  EXPECT_EQ(opening.now().phase, OpeningPhase::kNone);
}

/// A digit that started inside, with two contacts; every other limiter is off.
struct TwoContacts {
  TwoContacts(Stabiliser method, const Vec3& of_proximal) : second(of_proximal) {
    stage.parameters.stabiliser.method = method;
    stage.start_inside();
    press();
    stage.ticks(20);
  }
  void press() {
    for (const int k : {kDistal, kProximal}) {
      ContactRecord& record =
          stage.press(k, k == kDistal ? 20e-3 : 30e-3, k == kDistal ? Vec3(Vec3::UnitY()) : second);
      record.silent = true;
      record.p_gdp.y() += 20e-3;  // the way out
    }
  }
  /// The finger shakes, so that methods with a damper add to the law's force.
  void tick(int i) {
    stage.move_hcp({0.0, i % 2 == 0 ? 1e-3 : -1e-3, 0.0});
    press();
    stage.tick();
  }
  /// Greatest of both forces and their sum [N].
  [[nodiscard]] double force() const {
    const Vec3 sum = stage.sent(kDistal) * Vec3::UnitY() + stage.sent(kProximal) * second;
    return std::max({stage.sent(kDistal), stage.sent(kProximal), sum.norm()});
  }
  Stage stage;
  Vec3 second;
};

// Whatever the method adds to the law's force, and however two contacts oppose each other: 1 N each, and 1 N in all,
// by 1 N/s. Without a confirmation there is none, also in the tick after it is withdrawn and where a method decays
// slowly.
TEST(Opening, BoundsEachForceAndTheirSumWithEveryMethod) {
  for (const Stabiliser method : test::kAllStabilisers) {
    for (const Vec3& second : {Vec3(Vec3::UnitY()), Vec3(-Vec3::UnitY()), Vec3(Vec3::UnitX())}) {
      SCOPED_TRACE(static_cast<int>(method));
      TwoContacts finger(method, second);
      finger.stage.parameters.stabiliser.min_rate = -0.01;
      EXPECT_EQ(finger.force(), 0.0);
      ASSERT_TRUE(finger.stage.state.opening[test::kIndex].confirm());
      double largest = 0.0;
      for (int i = 1; i <= 500; ++i) {
        const double before = finger.force();
        finger.tick(i);
        ASSERT_LE(finger.force(), std::min(1.0, before + kTick) + 1e-12) << i;
        ASSERT_FALSE(finger.stage.wall(kDistal).active) << "a wall has no bound of this kind";
        largest = std::max(largest, finger.force());
      }
      EXPECT_GT(largest, 0.0);
      if (method == Stabiliser::kNone || method == Stabiliser::kSmoothing ||
          method == Stabiliser::kRiseOnly) {
        EXPECT_NEAR(largest, 1.0, 1e-9);
      }
      finger.stage.state.opening[test::kIndex].withdraw();
      finger.tick(501);
      EXPECT_EQ(finger.force(), 0.0);
    }
  }
}

// Without good samples the force ends, and rises again by 1 N/s when they return.
TEST(Opening, RisesAgainAfterStaleSamples) {
  TwoContacts finger(Stabiliser::kNone, Vec3::UnitY());
  ASSERT_TRUE(finger.stage.state.opening[test::kIndex].confirm());
  for (int i = 1; i <= 100; ++i) finger.tick(i);
  EXPECT_NEAR(finger.force(), 0.5, 1e-9);
  finger.stage.stale = true;
  for (int i = 1; i <= 200; ++i) finger.tick(i);
  EXPECT_EQ(finger.force(), 0.0);
  finger.stage.stale = false;
  finger.tick(1);
  EXPECT_LE(finger.force(), kTick + 1e-12);
}

}  // namespace
}  // namespace phalanx

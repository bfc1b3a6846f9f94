// SPDX-License-Identifier: Apache-2.0
#include "phalanx/simulation/closed_loop/stability_criterion.h"

#include <gmock/gmock.h>

#include <cmath>
#include <utility>
#include <vector>

#include "simulation/pressing_finger.h"

namespace phalanx {
namespace {

using test::kTip;

constexpr int kOther = 8;  // distal segment of the middle finger
constexpr double kPeriod = 0.005;
const TrialSchedule kSchedule;

/// The segment `into` metres in the wall z = 0, which pushes with `force`.
void press(Snapshot& snapshot, int segment, double into, double force) {
  SegmentSnapshot& contact = snapshot.segment[idx(segment)];
  contact.contact = into > 0.0;
  contact.depth = std::max(0.0, into);
  contact.force = force;
  if (contact.contact || force > 0.0) contact.normal = Vec3::UnitZ();
  snapshot.hcp_pose[idx(segment)].p = Vec3(0.0, 0.0, -into);
  snapshot.gdp_pose[idx(segment)].p = Vec3(0.0, 0.0, std::max(0.0, -into));
  contact.point = snapshot.gdp_pose[idx(segment)].p;
}

Snapshot tip_at(double into, double force) {
  Snapshot snapshot;
  press(snapshot, kTip, into, force);
  return snapshot;
}

/// An observer and the plan that it looks at.
class Watching {
 public:
  Watching() : observer_(plan_, kSchedule, StabilityCriterion{}) {}
  /// @param felt  force along n that the motors render at that time [N]
  /// @param lost  and that they do not [N]
  void add(double t, const Snapshot& snapshot, double felt = 0.0, double lost = 0.0) {
    observer_.add(t, snapshot, torque_of(felt), torque_of(lost));
  }
  /// A press that is meant to reach `force` [N], its finger coming at `speed` [m/s].
  void expect(double force, double speed) {
    PatientParameters patient;
    patient.press_spread = 0.0;
    patient.approach_min = patient.approach_max = speed;
    HandParameters hand;
    hand.min_angle.fill(-10.0);
    hand.max_angle.fill(10.0);
    observer_.expect(PressIntent(plan_, patient, hand, 1000.0, force, 1, kSchedule));
  }
  /// The same snapshot at every step from the beginning of the window to its end.
  void fill_window(const Snapshot& snapshot) {
    for (double t = kSchedule.window_begin; t < kSchedule.window_end; t += kPeriod) add(t, snapshot);
  }
  [[nodiscard]] TrialResult result() const { return observer_.result(); }

 private:
  [[nodiscard]] JointArray torque_of(double force) const {
    JointArray torque{};
    for (std::size_t j = 0; j < torque.size(); ++j) torque[j] = force * plan_.digit[test::kIndex]->g[j];
    return torque;
  }

  PressPlan plan_ = test::plan_on_paper();
  TrialObserver observer_;
};

/// Force and depth rest, and once in the window they are otherwise.
TrialResult with_one_swing(double force, double into) {
  Watching watching;
  watching.fill_window(tip_at(2e-3, 2.0));
  watching.add(3.0, tip_at(2e-3 + into, 2.0 + force));
  return watching.result();
}

TEST(TrialObserver, CallsAQuietPressStableAndSaysHowItWas) {
  Watching watching;
  watching.fill_window(tip_at(2e-3, 2.0));
  const TrialResult result = watching.result();
  EXPECT_TRUE(result.stable);
  EXPECT_TRUE(result.valid);
  EXPECT_THAT(result.why_invalid, ::testing::IsEmpty());
  EXPECT_EQ(result.force_swing, 0.0);
  EXPECT_EQ(result.position_swing, 0.0);
  EXPECT_NEAR(result.mean_force, 2.0, 1e-12);
  EXPECT_NEAR(result.mean_depth, 2e-3, 1e-12);
  EXPECT_EQ(result.peak_depth, 2e-3);
  EXPECT_EQ(result.ghost_s, 0.0);
  EXPECT_EQ(result.ghost_energy, 0.0);
}

TEST(TrialObserver, AllowsHalfANewton) {
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_TRUE(with_one_swing(sign * 0.49, 0.0).stable);
    EXPECT_FALSE(with_one_swing(sign * 0.51, 0.0).stable);
    EXPECT_NEAR(with_one_swing(sign * 0.51, 0.0).force_swing, 0.51, 1e-12);
  }
}

TEST(TrialObserver, AllowsHalfAMillimetre) {
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_TRUE(with_one_swing(0.0, sign * 0.49e-3).stable);
    EXPECT_FALSE(with_one_swing(0.0, sign * 0.51e-3).stable);
    EXPECT_NEAR(with_one_swing(0.0, sign * 0.51e-3).position_swing, 0.51e-3, 1e-12);
  }
}

// 2.0 N and 2.5 N are exactly half a newton apart, which is still allowed.
TEST(TrialObserver, AllowsASwingOfExactlyItsBound) {
  const TrialResult result = with_one_swing(0.5, 0.0);
  EXPECT_EQ(result.force_swing, 0.5);
  EXPECT_TRUE(result.stable);
}

// 10 mm aside is no swing along n.
TEST(TrialObserver, LooksAlongTheNormalAlone) {
  Watching watching;
  watching.fill_window(tip_at(2e-3, 2.0));
  Snapshot aside = tip_at(2e-3, 2.0);
  aside.hcp_pose[idx(kTip)].p.x() = 10e-3;
  watching.add(3.0, aside);
  EXPECT_EQ(watching.result().position_swing, 0.0);
}

// The contact's material point, 20 mm from the segment's origin: a turn by 0.05 rad moves it by 1 mm along n.
TEST(TrialObserver, FollowsTheContactsMaterialPoint) {
  Watching watching;
  Snapshot snapshot = tip_at(2e-3, 2.0);
  snapshot.segment[idx(kTip)].point = Vec3(0.020, 0.0, 0.0);
  watching.fill_window(snapshot);
  snapshot.hcp_pose[idx(kTip)].R = rotation_about(Vec3::UnitY(), 0.05);
  watching.add(3.0, snapshot);
  EXPECT_NEAR(watching.result().position_swing, 0.020 * std::sin(0.05), 1e-12);
}

TEST(TrialObserver, LooksAtTheWindowAlone) {
  Watching watching;
  watching.add(kSchedule.window_begin - kPeriod, tip_at(9e-3, 9.0));
  watching.fill_window(tip_at(2e-3, 2.0));
  watching.add(kSchedule.window_end, tip_at(7e-3, 7.0));
  const TrialResult result = watching.result();
  EXPECT_TRUE(result.stable);
  EXPECT_EQ(result.force_swing, 0.0);
  EXPECT_EQ(result.peak_depth, 9e-3);  // of the whole run
}

TEST(TrialObserver, IsUnstableIfOneOfSeveralContactsSwings) {
  Watching watching;
  Snapshot snapshot = tip_at(2e-3, 3.0);
  press(snapshot, kOther, 1e-3, 1.0);
  watching.fill_window(snapshot);
  EXPECT_TRUE(watching.result().stable);
  press(snapshot, kOther, 1e-3, 1.51);
  watching.add(3.0, snapshot);
  const TrialResult result = watching.result();
  EXPECT_FALSE(result.stable);
  EXPECT_NEAR(result.force_swing, 0.51, 1e-12);
  EXPECT_NEAR(result.mean_force, 3.0, 1e-12);  // of the contact that presses most
}

// Only the index finger is meant to press: what the middle finger does is no press, and of two phalanges of
// the index finger the one with the larger force counts.
TEST(TrialObserver, SaysHowTheDigitThatIsMeantToPressDoes) {
  Watching watching;
  Snapshot snapshot = tip_at(2e-3, 2.0);
  press(snapshot, kOther, 1e-3, 5.0);
  watching.fill_window(snapshot);
  EXPECT_NEAR(watching.result().mean_force, 2.0, 1e-12);
  EXPECT_NEAR(watching.result().mean_depth, 2e-3, 1e-12);
  Watching phalanges;
  snapshot = tip_at(2e-3, 1.0);
  press(snapshot, kTip - 1, 1e-3, 3.0);
  phalanges.fill_window(snapshot);
  EXPECT_NEAR(phalanges.result().mean_force, 3.0, 1e-12);
}

// It was at 0 N before: 0.51 N is a swing of 0.51 N, however steadily it stays.
TEST(TrialObserver, CountsTheForceOfAContactThatAppearsInTheWindow) {
  for (const double force : {0.49, 0.51}) {
    Watching watching;
    Snapshot snapshot = tip_at(2e-3, 2.0);
    for (double t = kSchedule.window_begin; t < 3.5; t += kPeriod) watching.add(t, snapshot);
    press(snapshot, kOther, 0.1e-3, force);
    for (double t = 3.5; t < kSchedule.window_end; t += kPeriod) watching.add(t, snapshot);
    EXPECT_EQ(watching.result().stable, force < 0.5);
    EXPECT_NEAR(watching.result().force_swing, force, 1e-12);
  }
}

TEST(TrialObserver, CountsTheForceOfAContactThatDisappearsInTheWindow) {
  Watching watching;
  watching.fill_window(tip_at(2e-3, 2.0));
  watching.add(3.0, tip_at(-0.1e-3, 0.0));
  EXPECT_NEAR(watching.result().force_swing, 2.0, 1e-12);
}

// What touches nothing swings by nothing, and proves nothing.
TEST(TrialObserver, IsInvalidWithoutAContact) {
  Watching watching;
  watching.fill_window(tip_at(-1e-3, 0.0));
  const TrialResult result = watching.result();
  EXPECT_FALSE(result.valid);
  EXPECT_THAT(result.why_invalid, ::testing::HasSubstr("no contact"));
  EXPECT_FALSE(Watching().result().valid);  // nothing was seen at all
}

TEST(TrialObserver, IsInvalidIfALimiterActedBeforeTheRelease) {
  const std::vector<std::pair<Status, std::string>> limiters = {
      {Status::kForceLimited, "force_limited"},
      {Status::kTorqueLimited, "torque_limited"},
      {Status::kTorqueRateLimited, "torque_rate_limited"},
      {Status::kSampleJump, "sample_jump"}};
  for (const auto& [status, name] : limiters) {
    Watching watching;
    watching.fill_window(tip_at(2e-3, 2.0));
    Snapshot limited = tip_at(2e-3, 2.0);
    limited.status = status;
    watching.add(1.0, limited);
    const TrialResult result = watching.result();
    EXPECT_FALSE(result.valid) << name;
    EXPECT_EQ(result.why_invalid, name);
    EXPECT_TRUE(result.stable) << name;
  }
}

// The finger begins at 0.2 s, 20 mm before the wall, and ends 3 N (3.5e-4 + 1e-3) m/N = 4.05 mm behind it.
// The window begins at 2.7 s, and the finger is to rest for 0.3 s before: it may need 2.2 s for the 24.05 mm.
TEST(TrialObserver, TheFingerRestsBeforeTheWindow) {
  for (const auto& [needs, valid] : {std::pair{2.19, true}, std::pair{2.21, false}, std::pair{2.49, false}}) {
    Watching watching;
    watching.expect(3.0, 24.05e-3 / needs);
    watching.fill_window(tip_at(2e-3, 2.0));
    EXPECT_EQ(watching.result().valid, valid) << needs;
    EXPECT_EQ(watching.result().why_invalid, valid ? "" : "the finger was still on its way") << needs;
  }
}

// A press of 3 N with 1 kN/m in the wall ends some 5 mm behind it, 25 mm from the start: 0.5 s at 50 mm/s, 5
// s at 5.
TEST(TrialObserver, IsInvalidIfTheFingerIsStillOnItsWay) {
  for (const auto& [speed, valid] : {std::pair{0.05, true}, std::pair{0.005, false}}) {
    Watching watching;
    watching.expect(3.0, speed);
    watching.fill_window(tip_at(2e-3, 2.0));
    EXPECT_EQ(watching.result().valid, valid) << speed;
    EXPECT_EQ(watching.result().why_invalid, valid ? "" : "the finger was still on its way");
  }
}

TEST(TrialObserver, IsInvalidIfTheFingerPressesWithLessThanATenth) {
  for (const double force : {0.31, 0.29}) {
    Watching watching;
    watching.expect(3.0, 0.05);
    watching.fill_window(tip_at(2e-3, force));
    EXPECT_EQ(watching.result().valid, force > 0.3) << force;
  }
}

TEST(TrialObserver, IsInvalidIfTheMotorsRenderLessThanNineTenths) {
  for (const double lost : {0.29, 0.31}) {
    Watching watching;
    watching.expect(3.0, 0.05);
    for (double t = kSchedule.window_begin; t < kSchedule.window_end; t += kPeriod)
      watching.add(t, tip_at(2e-3, 3.0), 3.0 - lost, lost);
    EXPECT_EQ(watching.result().valid, lost < 0.3) << lost;
  }
}

TEST(TrialObserver, IsInvalidIfTheStiffnessWasHalved) {
  Watching watching;
  Snapshot halved = tip_at(2e-3, 2.0);
  halved.stiffness_factor = 0.5;
  watching.fill_window(halved);
  EXPECT_FALSE(watching.result().valid);
  EXPECT_EQ(watching.result().why_invalid, "stiffness halved");
}

TEST(TrialObserver, NamesEveryLimiterThatActed) {
  Watching watching;
  watching.fill_window(tip_at(2e-3, 2.0));
  Snapshot limited = tip_at(2e-3, 2.0);
  limited.status = Status::kTorqueLimited;
  watching.add(1.0, limited);
  limited.status = Status::kForceLimited;
  watching.add(2.0, limited);
  EXPECT_EQ(watching.result().why_invalid, "force_limited, torque_limited");
}

TEST(TrialObserver, StaysValidWithTheBitsThatLimitNothingAndAfterTheRelease) {
  Watching watching;
  Snapshot snapshot = tip_at(2e-3, 2.0);
  snapshot.status = Status::kOscillating | Status::kSlid;
  watching.fill_window(snapshot);
  snapshot.status = Status::kForceLimited;
  watching.add(kSchedule.release, snapshot);
  EXPECT_TRUE(watching.result().valid);
}

// Inside until 4.300 s; then 1.5, 1.0 and 0.5 N are felt while the finger goes on by 1, 2 and 1 mm: 15 ms and
// 4 mJ. What is sent then is 0 already and plays no part.
TEST(TrialObserver, MeasuresTheGhostThatIsFeltFromTheLastStepInside) {
  Watching watching;
  watching.fill_window(tip_at(2e-3, 2.0));
  watching.add(4.300, tip_at(0.5e-3, 2.0), 2.0);
  watching.add(4.305, tip_at(-0.5e-3, 0.0), 1.5);
  watching.add(4.310, tip_at(-2.5e-3, 0.0), 1.0);
  watching.add(4.315, tip_at(-3.5e-3, 0.0), 0.5);
  watching.add(4.320, tip_at(-4.5e-3, 0.0), 0.009);  // gone
  watching.add(4.325, tip_at(-5.5e-3, 0.0), 0.0);
  const TrialResult result = watching.result();
  EXPECT_NEAR(result.ghost_s, 0.015, 1e-9);
  EXPECT_NEAR(result.ghost_energy, 1.5 * 1e-3 + 1.0 * 2e-3 + 0.5 * 1e-3, 1e-12);
}

TEST(TrialObserver, MeasuresTheLastGhostIfTheFingerComesBack) {
  Watching watching;
  watching.add(4.300, tip_at(0.5e-3, 2.0), 2.0);
  watching.add(4.305, tip_at(-0.5e-3, 1.5), 1.5);
  watching.add(4.310, tip_at(0.1e-3, 1.5), 1.5);
  watching.add(4.315, tip_at(-0.1e-3, 1.0), 1.0);
  watching.add(4.320, tip_at(-0.3e-3, 0.0), 0.0);
  const TrialResult result = watching.result();
  EXPECT_NEAR(result.ghost_s, 0.005, 1e-9);
  EXPECT_NEAR(result.ghost_energy, 1.0 * 0.2e-3, 1e-12);
}

TEST(TrialObserver, HasNoGhostWhereNothingIsFeltOutside) {
  Watching watching;
  watching.fill_window(tip_at(2e-3, 2.0));
  watching.add(4.300, tip_at(0.5e-3, 0.5), 0.5);
  watching.add(4.305, tip_at(-0.5e-3, 0.5), 0.0);
  EXPECT_EQ(watching.result().ghost_s, 0.0);
  EXPECT_EQ(watching.result().ghost_energy, 0.0);
}

// The finger is out before the release: what is felt then is no ghost of this press.
TEST(TrialObserver, HasNoGhostOfAFingerThatWasNotInsideAtTheRelease) {
  Watching watching;
  watching.add(4.300, tip_at(-0.5e-3, 0.0), 1.0);
  watching.add(4.305, tip_at(-1.5e-3, 0.0), 1.0);
  EXPECT_EQ(watching.result().ghost_s, 0.0);
}

TEST(TrialObserver, WaitsUntilEveryPhalanxOfTheDigitHasLeft) {
  Watching watching;
  watching.add(4.300, tip_at(0.5e-3, 1.0), 1.0);
  Snapshot out = tip_at(-0.5e-3, 0.0);
  press(out, kTip - 1, 1e-3, 0.5);
  watching.add(4.305, out, 1.0);
  EXPECT_EQ(watching.result().ghost_s, 0.0);
  press(out, kTip - 1, -1e-3, 0.0);
  watching.add(4.310, out, 1.0);
  EXPECT_NEAR(watching.result().ghost_s, 0.005, 1e-9);
}

}  // namespace
}  // namespace phalanx

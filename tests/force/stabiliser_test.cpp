// SPDX-License-Identifier: Apache-2.0
#include "phalanx/force/stabiliser.h"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "phalanx/core/constants.h"
#include "phalanx/force/stabiliser_methods.h"
#include "support/all_stabilisers.h"

namespace phalanx {
namespace {

constexpr double kStabiliserPeriod = 0.005;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Feeds one contact with a wall F = k d, one depth a step.
class Contact {
 public:
  explicit Contact(StabiliserParameters parameters, double stiffness = 500.0)
      : parameters_(parameters), stiffness_(stiffness) {}

  /// The force sent at this depth; below 0 there is no contact.
  double press(double depth) {
    const double speed = pressed_ ? (depth - depth_) / kStabiliserPeriod : 0.0;
    pressed_ = depth >= 0.0;
    depth_ = depth;
    const StabiliserInput input{.force = pressed_ ? stiffness_ * depth : 0.0,
                                .depth = depth,
                                .speed = speed,
                                .speed_now = speed,
                                .sent = sent_,
                                .pressing = pressed_,
                                .period = kStabiliserPeriod};
    sent_ = stabilised_force(parameters_, input, memory_);
    return sent_;
  }
  [[nodiscard]] const StabiliserMemory& memory() const { return memory_; }

 private:
  StabiliserParameters parameters_;
  double stiffness_;
  StabiliserMemory memory_;
  double depth_ = 0.0;
  double sent_ = 0.0;
  bool pressed_ = false;
};

// 4 mm into 500 N/m: 2 N.
TEST(Stabiliser, NoneDirectionAndLocalWallSendTheLawsForce) {
  for (const Stabiliser method : {Stabiliser::kNone, Stabiliser::kDirection, Stabiliser::kLocalWall}) {
    Contact contact({.method = method});
    EXPECT_DOUBLE_EQ(contact.press(4e-3), 2.0);
    EXPECT_EQ(contact.press(-1e-3), 0.0);
  }
  Contact unknown({.method = static_cast<Stabiliser>(77)});
  EXPECT_DOUBLE_EQ(unknown.press(4e-3), 2.0) << "a number that is no method is none";
}

// 20 N/s at 200 Hz: 0.1 N a step, up and down; rise-only falls at once.
TEST(Stabiliser, SmoothingBoundsBothWaysAndRiseOnlyOne) {
  Contact smoothed({.method = Stabiliser::kSmoothing});
  Contact rising({.method = Stabiliser::kRiseOnly});
  for (int n = 1; n <= 3; ++n) {
    EXPECT_NEAR(smoothed.press(4e-3), 0.1 * n, 1e-15);
    EXPECT_NEAR(rising.press(4e-3), 0.1 * n, 1e-15);
  }
  EXPECT_NEAR(smoothed.press(-1e-3), 0.2, 1e-15);
  EXPECT_EQ(rising.press(-1e-3), 0.0);
}

// 500 N/m, 1000 N/m and 4 N s/m over 5 ms, the proxy at 1 mm: by a hop of 3 mm it would come to 4.2 N over
// 2300 N/m = 1.83 mm. It stays within the depth of 1 mm, and the force at the law's 0.5 N.
TEST(Stabiliser, TheCouplingsProxyStaysWithinTheDepthWhereAContactHops) {
  double proxy = 1e-3;
  EXPECT_NEAR(coupled_force(0.5, 1e-3, 3e-3, 1000.0, 4.0, kStabiliserPeriod, proxy), 0.5, 1e-15);
  EXPECT_EQ(proxy, 1e-3);
}

// After 1 / (2 pi f) seconds a step has come to 1 - 1/e of its height, exactly: 10 periods at f = 10 / pi Hz
// and T = 5 ms. It ends: a force that has decayed below 0.1 mN is 0.
TEST(Stabiliser, TheLowPassIsExactAtItsTimeConstantAndEnds) {
  Contact contact({.method = Stabiliser::kLowPass, .lowpass_hz = 10.0 / std::numbers::pi});
  double force = 0.0;
  for (int n = 0; n < 10; ++n) force = contact.press(4e-3);
  EXPECT_NEAR(force, 2.0 * (1.0 - std::exp(-1.0)), 1e-12);
  // 1.264 N falls below 0.1 mN after ln(12642) = 9.4447 time constants of 10 steps.
  int steps = 0;
  while (force > 0.0 && steps < 1000) {
    force = contact.press(-1e-3);
    ++steps;
  }
  EXPECT_EQ(steps, 95);
  EXPECT_EQ(low_passed_force(0.0, 1e-4, 3.0, 0.0), 1e-4) << "0.1 mN itself, of which no time takes anything";
}

// 4 mm at +0.1 m/s into 500 N/m and 4 N s/m: 2 + 0.4 N; leaving at 1 m/s it would pull: 0.
TEST(Stabiliser, KelvinVoigtAddsDampingAndNeverPulls) {
  EXPECT_DOUBLE_EQ(damped_force(2.0, 4.0, 0.1), 2.4);
  EXPECT_EQ(damped_force(2.0, 4.0, -1.0), 0.0);
}

// 4 mm, wall 500 N/m, coupling 1500 N/m: two springs in series, 375 N/m, 1.5 N, at rest. A coupling a million
// times stiffer than the wall is the wall.
TEST(Stabiliser, TheVirtualCouplingIsASeriesOfTwoSpringsAtRest) {
  Contact soft({.method = Stabiliser::kVirtualCoupling, .coupling_stiffness = 1500.0});
  Contact rigid({.method = Stabiliser::kVirtualCoupling, .coupling_stiffness = 5e8});
  double force = 0.0;
  for (int n = 0; n < 200; ++n) force = soft.press(4e-3);
  EXPECT_NEAR(force, 1.5, 1e-9);
  EXPECT_NEAR(soft.memory().proxy, 3e-3, 1e-12);
  EXPECT_NEAR(rigid.press(4e-3), 2.0, 1e-5);
}

// One step by hand: k = 500, Kc = 1000, Bc / T = 4 / 0.005 = 800 N/m, d from 0 to 2 mm:
// xp = (1000 + 800) x 2 mm / 2300 = 1.5652 mm, F = 0.78261 N. Then back to 1 mm: xp = (1000 x 1 + 800 x
// (-1 + 1.5652)) / 2300 mm = 0.63138 mm.
TEST(Stabiliser, TheVirtualCouplingsStepsAreThoseOfImplicitEuler) {
  double proxy = 0.0;
  EXPECT_NEAR(coupled_force(1.0, 2e-3, 2e-3, 1000.0, 4.0, kStabiliserPeriod, proxy), 500.0 * 3.6 / 2300.0,
              1e-12);
  EXPECT_NEAR(proxy, 3.6e-3 / 2300.0 * 1000.0 / 1.0, 1e-12);
  const double before = proxy;
  EXPECT_NEAR(coupled_force(0.5, 1e-3, -1e-3, 1000.0, 4.0, kStabiliserPeriod, proxy),
              500.0 * (1.0 + 800.0 * (before - 1e-3)) / 2300.0, 1e-12);
}

// In by 1 mm a step to 3 mm and out again, wall 1000 N/m: the force held over each step lags, so that on the
// way in 0 + 1 + 2 mJ are put in and on the way out 3 + 2 + 1 mJ come back: after two steps out
// E = 3 - 3 - 2 = -2 mJ, at -0.2 m/s, which asks for a = 2e-3 / (0.005 x 0.04) = 10 N s/m.
TEST(Stabiliser, ThePassivityControllerTakesBackWhatTheHoldMade) {
  double energy = 0.0;
  const double kFast = 0.2;
  EXPECT_EQ(passive_force(1.0, 0.0, kFast, 50.0, kStabiliserPeriod, energy), 1.0);
  EXPECT_EQ(passive_force(2.0, 1.0, kFast, 50.0, kStabiliserPeriod, energy), 2.0);
  EXPECT_EQ(passive_force(3.0, 2.0, kFast, 50.0, kStabiliserPeriod, energy), 3.0);
  EXPECT_NEAR(energy, 3e-3, 1e-15);
  EXPECT_NEAR(passive_force(2.0, 3.0, -kFast, 50.0, kStabiliserPeriod, energy), 2.0, 1e-9)
      << "E is 0: nothing to take";
  double energy_capped = energy;
  // 2 mJ at 0.2 m/s: a = 10, and 1 N - 10 x 0.2 would pull: 0. With at most 2 N s/m: 0.6 N.
  EXPECT_EQ(passive_force(1.0, 2.0, -kFast, 50.0, kStabiliserPeriod, energy), 0.0);
  EXPECT_NEAR(energy, -2e-3, 1e-12);
  EXPECT_NEAR(passive_force(1.0, 2.0, -kFast, 2.0, kStabiliserPeriod, energy_capped), 0.6, 1e-12);
}

// Whatever wall oscillates, what it has given away is taken back while the finger moves: with no cap on a and
// no pull asked for, E after the next step is 0. Pressing 1 mm in: F' v T is the same energy that was
// missing.
TEST(Stabiliser, ThePassivityControllersEnergyReturnsToZero) {
  double energy = -1e-3;
  const double out =
      passive_force(3.0, 0.0, 0.1, 1e9, kStabiliserPeriod, energy);  // a = 1e-3 / (0.005 x 0.01) = 20
  EXPECT_NEAR(out, 5.0, 1e-9);
  static_cast<void>(
      passive_force(0.0, out - 3.0, 0.1, 1e9, kStabiliserPeriod, energy));  // the damper's part of it
  EXPECT_NEAR(energy, 0.0, 1e-12);
}

// 1 mJ at 1 m/s: a = 1e-3 / (0.005 x 1) = 0.2 N s/m, 0.2 N. Where no energy is missing the law's force stays,
// also at a speed whose square is too small for a number.
TEST(Stabiliser, ThePassivityControllerTakesEachSpeed) {
  double missing = -1e-3;
  EXPECT_NEAR(passive_force(3.0, 0.0, 1.0, 50.0, kStabiliserPeriod, missing), 3.2, 1e-12);
  double none = 0.0;
  EXPECT_EQ(passive_force(2.0, 0.0, 1e-200, 50.0, kStabiliserPeriod, none), 2.0);
}

// b = 1 N s/m at 200 Hz: 400 N/m at most. Into a wall of 2000 N/m, 1 mm a step: 0.4 N a step. At rest it
// stays; on the way out it stays until the law has come down to it.
TEST(Stabiliser, EnergyBoundingIsNeverStifferThanTwiceTheDampingOverThePeriod) {
  Contact contact({.method = Stabiliser::kEnergyBounding, .device_damping = 1.0}, 2000.0);
  EXPECT_NEAR(contact.press(1e-3), 0.4, 1e-12);
  EXPECT_NEAR(contact.press(2e-3), 0.8, 1e-12);
  EXPECT_NEAR(contact.press(2e-3), 0.8, 1e-12) << "the law says 4 N, but nothing moves";
  EXPECT_NEAR(contact.press(1e-3), 0.8, 1e-12) << "the law still says more";
  EXPECT_NEAR(contact.press(0.2e-3), 0.8 - 400.0 * 0.8e-3, 1e-12);
  EXPECT_EQ(contact.press(-1e-3), 0.0);
}

// Within the bound it is the law itself.
TEST(Stabiliser, EnergyBoundingLeavesASoftWallAlone) {
  Contact contact({.method = Stabiliser::kEnergyBounding, .device_damping = 2.0}, 500.0);
  for (const double depth : {1e-3, 2e-3, 4e-3, 3e-3, 1e-3})
    EXPECT_NEAR(contact.press(depth), 500.0 * depth, 1e-12);
  EXPECT_EQ(energy_bounded_force(2.0, 2.0, 0.0, 2.0, kStabiliserPeriod), 2.0) << "and at rest";
}

TEST(Stabiliser, TheDirectionTurnsByTheBoundAndThenIsThere) {
  const double step = 0.1;
  Vec3 direction = Vec3::UnitZ();
  for (int n = 1; n <= 15; ++n) {
    const Vec3 next = turned_direction(direction, Vec3::UnitX(), step);
    EXPECT_NEAR(std::acos(std::min(1.0, direction.dot(next))), step, 1e-7);
    EXPECT_NEAR(next.x(), std::sin(step * n), 1e-12);
    EXPECT_EQ(next.y(), 0.0);
    direction = next;
  }
  EXPECT_EQ(turned_direction(direction, Vec3::UnitX(), step), Vec3::UnitX()) << "pi / 2 is 15.7 steps";
  EXPECT_EQ(turned_direction(Vec3::Zero(), Vec3::UnitY(), step), Vec3::UnitY()) << "the first one";
  EXPECT_EQ(turned_direction(Vec3::UnitZ(), Vec3::UnitX(), std::numbers::pi / 2), Vec3::UnitX())
      << "the bound itself is there";
}

TEST(Stabiliser, TheDirectionTurnsToTheOppositeToo) {
  for (const Vec3& from : {Vec3::UnitX().eval(), Vec3::UnitY().eval(), Vec3::UnitZ().eval()}) {
    Vec3 direction = from;
    for (int n = 0; n < 63; ++n) {
      direction = turned_direction(direction, -from, 0.05);
      EXPECT_NEAR(direction.norm(), 1.0, 1e-12);
    }
    EXPECT_EQ(direction, -from) << "pi is 62.8 steps";
  }
}

// By 0.3 rad, whichever direction it starts from: the one across it is made of another axis.
TEST(Stabiliser, TheTurnToTheOppositeIsByTheBoundFromAnyDirection) {
  const std::array<Vec3, 4> directions = {Vec3(0.6, 0.8, 0.0), Vec3(0.96, 0.28, 0.0), Vec3(0.0, -0.6, 0.8),
                                          Vec3(-1.0, 0.0, 0.0)};
  for (const Vec3& from : directions) {
    const Vec3 next = turned_direction(from, -from, 0.3);
    EXPECT_NEAR(next.norm(), 1.0, 1e-12) << from.transpose();
    EXPECT_NEAR(from.dot(next), std::cos(0.3), 1e-12) << from.transpose();
  }
  const Vec3 almost(-1.0, 0.0, 1.5e-9);  // opposite to +X but for 1.5 nrad towards +Z: the way is by +Z
  EXPECT_NEAR(turned_direction(Vec3::UnitX(), almost, 0.3).z(), std::sin(0.3), 1e-12);
}

// At a depth of exactly 0 the damper of 4 N s/m would push 0.8 N, passivity's at its largest of 10 N s/m 2 N,
// and energy bounding would hold its 1 N. The finger arrives with the first depth above 0.
TEST(Stabiliser, AContactWithoutDepthPushesNothingAndHasNotArrived) {
  for (const Stabiliser method : {Stabiliser::kKelvinVoigt, Stabiliser::kVirtualCoupling,
                                  Stabiliser::kPassivity, Stabiliser::kEnergyBounding}) {
    StabiliserMemory memory;
    memory.energy = -1.0;
    const StabiliserInput input{.force = 0.0,
                                .depth = 0.0,
                                .speed = 0.2,
                                .speed_now = 0.2,
                                .sent = 1.0,
                                .pressing = true,
                                .period = kStabiliserPeriod};
    EXPECT_EQ(stabilised_force({.method = method}, input, memory), 0.0) << static_cast<int>(method);
    EXPECT_FALSE(memory.touching) << static_cast<int>(method);
  }
  double proxy = 1e-3;
  EXPECT_EQ(coupled_force(0.0, 0.0, 0.0, 1000.0, 4.0, kStabiliserPeriod, proxy), 0.0);
  EXPECT_EQ(proxy, 0.0);
}

// Each number by itself: no force, no force sent (0.1 N is one step of smoothing from there), no depth and no
// speed.
TEST(Stabiliser, CountsWhatIsNotFiniteAsNothing) {
  const auto sent = [](Stabiliser method, StabiliserInput input) {
    input.pressing = true;
    input.period = kStabiliserPeriod;
    StabiliserMemory memory;
    return stabilised_force({.method = method}, input, memory);
  };
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    EXPECT_EQ(sent(Stabiliser::kNone, {.force = bad, .depth = 1e-3}), 0.0) << bad;
    EXPECT_NEAR(sent(Stabiliser::kSmoothing, {.force = 1.0, .depth = 1e-3, .sent = bad}), 0.1, 1e-15) << bad;
    EXPECT_EQ(sent(Stabiliser::kKelvinVoigt, {.force = 1.0, .depth = bad, .speed = 0.1}), 0.0) << bad;
    EXPECT_EQ(sent(Stabiliser::kKelvinVoigt, {.force = 1.0, .depth = 1e-3, .speed = bad}), 1.0) << bad;
    const StabiliserInput input{.force = 1.0, .depth = 1e-3, .speed_now = bad, .sent = 0.5};
    EXPECT_EQ(sent(Stabiliser::kPassivity, input), 1.0) << bad;
  }
}

// 4 N s/m times 1e308 m/s overflow: nothing is sent, and the contact's memory is cleared.
TEST(Stabiliser, ForgetsAContactWhoseForceIsNotFinite) {
  StabiliserMemory memory;
  const StabiliserInput input{
      .force = 1.0, .depth = 1e-3, .speed = 1e308, .pressing = true, .period = kStabiliserPeriod};
  EXPECT_EQ(stabilised_force({.method = Stabiliser::kKelvinVoigt, .damping = 4.0}, input, memory), 0.0);
  EXPECT_FALSE(memory.touching);
}

// A contact that is gone leaves nothing behind but what decays.
TEST(Stabiliser, ForgetsAContactThatIsGone) {
  for (const Stabiliser method : test::kAllStabilisers) {
    Contact contact({.method = method});
    for (const double depth : {1e-3, 5e-3, 3e-3, 6e-3}) contact.press(depth);
    for (int n = 0; n < 200; ++n) contact.press(-1e-3);
    EXPECT_EQ(contact.press(-1e-3), 0.0) << static_cast<int>(method);
    EXPECT_EQ(contact.memory().energy, 0.0);
    EXPECT_EQ(contact.memory().proxy, 0.0);
    EXPECT_FALSE(contact.memory().touching);
  }
}

TEST(Stabiliser, IsFiniteAndNeverPullsWhateverArrives) {
  const std::vector<double> wild = {
      0.0, kNan, kInfinity, -kInfinity, 1e300, -1e300, 1e-310, -0.1, 3.0, std::numeric_limits<double>::max()};
  for (const Stabiliser method : test::kAllStabilisers) {
    std::mt19937_64 random(31);
    StabiliserMemory memory;
    double sent = 0.0;
    const auto any = [&] {
      return random() % 3 == 0 ? wild[random() % wild.size()]
                               : std::uniform_real_distribution<double>(-0.5, 2.0)(random);
    };
    for (int n = 0; n < 5000; ++n) {
      const StabiliserInput input{.force = any(),
                                  .depth = any(),
                                  .speed = any(),
                                  .speed_now = any(),
                                  .sent = random() % 8 == 0 ? any() : sent,
                                  .pressing = random() % 8 != 0,
                                  .period = kStabiliserPeriod};
      sent = stabilised_force({.method = method}, input, memory);
      ASSERT_TRUE(std::isfinite(sent)) << "method " << static_cast<int>(method) << " seed 31 step " << n;
      ASSERT_GE(sent, 0.0);
      ASSERT_TRUE(std::isfinite(memory.energy) && std::isfinite(memory.proxy));
      ASSERT_LE(std::abs(memory.energy), 1e3);
      ASSERT_GE(memory.proxy, 0.0);
    }
  }
}

// What damps by the speed adds to the law's force where the finger presses in; the cap comes once more after
// it.
TEST(StabiliserMethods, ThoseThatAddToTheLawsForceAreKnown) {
  for (const Stabiliser method : test::kAllStabilisers) {
    const bool adds = method == Stabiliser::kKelvinVoigt || method == Stabiliser::kPassivity ||
                      method == Stabiliser::kEnergyBounding;
    EXPECT_EQ(keeps_below_law(method), !adds) << static_cast<int>(method);
  }
}

}  // namespace
}  // namespace phalanx

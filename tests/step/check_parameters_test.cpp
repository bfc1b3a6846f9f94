// SPDX-License-Identifier: Apache-2.0
#include "step/check_parameters.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "phalanx/core/constants.h"
#include "phalanx/mesh/primitives.h"
#include "support/simple_hand.h"

namespace phalanx {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kLargest = std::numeric_limits<double>::max();
constexpr double kSmallest = std::numeric_limits<double>::min();

HapticModel floor_model() {
  return HapticModel(test::simple_hand(),
                     ObjectModel(test::moved(make_box(Vec3(0.3, 0.02, 0.3), 4), test::at(0.0, -0.05, 0.0))));
}

void expect_refused(const HapticModel& model, const char* name, double value) {
  EXPECT_THAT([&] { check_parameters(model); },
              ::testing::ThrowsMessage<std::invalid_argument>(::testing::HasSubstr(name)))
      << name << " = " << value;
}

/// A parameter and the smallest and largest value that it may have.
struct Range {
  const char* name;
  double& (*of)(HapticModel&);
  double low;
  double high;
};

const Range kRanges[] = {
    {"rate_hz", [](HapticModel& m) -> double& { return m.rate_hz; }, 1.0, 4000.0},
    {"contact.margin", [](HapticModel& m) -> double& { return m.contact.margin; }, 1e-6, 1e-3},
    {"contact.slid_distance", [](HapticModel& m) -> double& { return m.contact.slid_distance; }, 0.0,
     kLargest},
    {"force.stiffness", [](HapticModel& m) -> double& { return m.force.stiffness; }, 0.0, 1e6},
    {"force.damping", [](HapticModel& m) -> double& { return m.force.damping; }, 0.0, 1e6},
    {"force.velocity_lowpass_hz", [](HapticModel& m) -> double& { return m.force.velocity_lowpass_hz; }, 1e-3,
     1e6},
    {"force.hunt_crossley_exponent", [](HapticModel& m) -> double& { return m.force.hunt_crossley_exponent; },
     1.0, 5.0},
    {"force.hunt_crossley_damping", [](HapticModel& m) -> double& { return m.force.hunt_crossley_damping; },
     0.0, 1e3},
    {"force.cubic", [](HapticModel& m) -> double& { return m.force.cubic; }, 0.0, 1e15},
    {"force.linear_depth", [](HapticModel& m) -> double& { return m.force.linear_depth; }, 0.0, 1.0},
    {"stabiliser.lowpass_hz", [](HapticModel& m) -> double& { return m.stabiliser.lowpass_hz; }, 1e-3, 1e6},
    {"stabiliser.damping", [](HapticModel& m) -> double& { return m.stabiliser.damping; }, 0.0, 1e6},
    {"stabiliser.turn_rate", [](HapticModel& m) -> double& { return m.stabiliser.turn_rate; }, kSmallest,
     1e6},
    {"stabiliser.coupling_stiffness",
     [](HapticModel& m) -> double& { return m.stabiliser.coupling_stiffness; }, 1e-3, 1e9},
    {"stabiliser.coupling_damping", [](HapticModel& m) -> double& { return m.stabiliser.coupling_damping; },
     0.0, 1e6},
    {"stabiliser.passivity_damping_max",
     [](HapticModel& m) -> double& { return m.stabiliser.passivity_damping_max; }, 0.0, 1e6},
    {"stabiliser.device_damping", [](HapticModel& m) -> double& { return m.stabiliser.device_damping; }, 0.0,
     1e6},
    {"stabiliser.wall_valid", [](HapticModel& m) -> double& { return m.stabiliser.wall_valid; }, kSmallest,
     1.0},
    {"oscillation.swing", [](HapticModel& m) -> double& { return m.oscillation.swing; }, 1e-3, 1e3},
    {"smoothing.min_rate", [](HapticModel& m) -> double& { return m.smoothing.min_rate; }, -kInfinity,
     -kSmallest},
    {"smoothing.max_rate", [](HapticModel& m) -> double& { return m.smoothing.max_rate; }, kSmallest,
     kInfinity},
    {"limits.fingertip_force", [](HapticModel& m) -> double& { return m.limits.fingertip_force; }, kSmallest,
     15.0},
    {"limits.joint_torque", [](HapticModel& m) -> double& { return m.limits.joint_torque; }, kSmallest, 5.0},
    {"limits.torque_rate", [](HapticModel& m) -> double& { return m.limits.torque_rate; }, kSmallest, 1e4},
    {"limits.joint_speed", [](HapticModel& m) -> double& { return m.limits.joint_speed; }, kSmallest, 1e4},
};

TEST(CheckParameters, TakesEachNumberUpToItsBoundAndNoFurther) {
  HapticModel model = floor_model();
  for (const Range& range : kRanges) {
    const double usual = range.of(model);
    for (const double good : {range.low, range.high}) {
      range.of(model) = good;
      EXPECT_NO_THROW(check_parameters(model)) << range.name << " = " << good;
    }
    for (const double bad : {std::nextafter(range.low, -kInfinity), std::nextafter(range.high, kInfinity)}) {
      if (bad == range.low || bad == range.high) continue;  // infinity: nothing is beyond it
      range.of(model) = bad;
      expect_refused(model, range.name, bad);
    }
    range.of(model) = kNan;
    expect_refused(model, range.name, kNan);
    range.of(model) = usual;
  }
}

TEST(CheckParameters, SaysTheRangeOfWhatItRefuses) {
  HapticModel model = floor_model();
  model.contact.slid_distance = -1.0;
  expect_refused(model, "contact.slid_distance [m] = -1.000000 is outside 0.000000 .. any finite number",
                 -1.0);
  model.contact.slid_distance = 0.0;
  model.rate_hz = 5000.0;
  expect_refused(model, "rate_hz = 5000.000000 is outside 1.000000 .. 4000.000000", 5000.0);
}

TEST(CheckParameters, ALimitThatIsOffMayBeAnything) {
  HapticModel model = floor_model();
  model.limits = {.fingertip_force_enabled = false,
                  .fingertip_force = -1.0,
                  .joint_torque_enabled = false,
                  .joint_torque = -1.0,
                  .torque_rate_enabled = false,
                  .torque_rate = -1.0,
                  .joint_speed = kInfinity};
  EXPECT_NO_THROW(check_parameters(model));
}

TEST(CheckParameters, TheBoundsOfSmoothingCountWhereTheyAreUsed) {
  HapticModel model = floor_model();
  model.smoothing = {.enabled = false, .max_rate = -1.0};
  model.stabiliser.method = Stabiliser::kRiseOnly;
  expect_refused(model, "smoothing.max_rate", -1.0);
  model.stabiliser.method = Stabiliser::kLowPass;
  EXPECT_NO_THROW(check_parameters(model));
  model.smoothing.enabled = true;
  expect_refused(model, "smoothing.max_rate", -1.0);
}

TEST(CheckParameters, ThereIsNoMethodBeyondTheLast) {
  HapticModel model = floor_model();
  model.stabiliser.method = Stabiliser::kLocalWall;
  EXPECT_NO_THROW(check_parameters(model));
  for (const int method : {static_cast<int>(Stabiliser::kLocalWall) + 1, -1, 77}) {
    model.stabiliser.method = static_cast<Stabiliser>(method);
    expect_refused(model, "stabiliser.method", method);
  }
}

TEST(CheckParameters, ThereIsNoLawAndNoReactionBeyondTheLast) {
  HapticModel model = floor_model();
  model.force.law = ForceLaw::kLinearThenCubic;
  model.oscillation.reaction = OscillationReaction::kHalve;
  EXPECT_NO_THROW(check_parameters(model));
  for (const int number : {static_cast<int>(ForceLaw::kLinearThenCubic) + 1, -1}) {
    HapticModel unknown = floor_model();
    unknown.force.law = static_cast<ForceLaw>(number);
    expect_refused(unknown, "force.law", number);
  }
  for (const int number : {static_cast<int>(OscillationReaction::kHalve) + 1, -1}) {
    HapticModel unknown = floor_model();
    unknown.oscillation.reaction = static_cast<OscillationReaction>(number);
    expect_refused(unknown, "oscillation.reaction", number);
  }
}

TEST(CheckParameters, AStateIsNotMadeWithoutIt) {
  HapticModel model = floor_model();
  model.force.stiffness = -1.0;
  EXPECT_THAT([&] { HapticState state(model); },
              ::testing::ThrowsMessage<std::invalid_argument>(::testing::HasSubstr("force.stiffness")));
}

}  // namespace
}  // namespace phalanx

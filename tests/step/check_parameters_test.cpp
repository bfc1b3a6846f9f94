// SPDX-License-Identifier: Apache-2.0
#include "step/check_parameters.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <string>

#include "phalanx/core/constants.h"
#include "phalanx/mesh/primitives.h"
#include "support/simple_hand.h"

namespace phalanx {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kSmallest = std::numeric_limits<double>::denorm_min();

void expect_refused(const HapticParameters& parameters, const char* name, double value) {
  EXPECT_THAT([&] { check_parameters(parameters); },
              ::testing::ThrowsMessage<std::invalid_argument>(::testing::HasSubstr(name)))
      << name << " = " << value;
}

/// A parameter and the smallest and largest value that it may have.
struct Range {
  const char* name;
  double& (*of)(HapticParameters&);
  double low;
  double high;
};

const Range kRanges[] = {
    {"rate_hz", [](HapticParameters& p) -> double& { return p.rate_hz; }, 1.0, 4000.0},
    {"contact.margin", [](HapticParameters& p) -> double& { return p.contact.margin; }, 1e-6, 1e-3},
    {"contact.slid_distance", [](HapticParameters& p) -> double& { return p.contact.slid_distance; },
     kSmallest, 0.1},
    {"contact.friction", [](HapticParameters& p) -> double& { return p.contact.friction; }, 0.0, 2.0},
    {"contact.tangential_stiffness_ratio",
     [](HapticParameters& p) -> double& { return p.contact.tangential_stiffness_ratio; }, 0.05, 1.0},
    {"contact.spin_radius", [](HapticParameters& p) -> double& { return p.contact.spin_radius; }, 0.0, 0.02},
    {"force.stiffness", [](HapticParameters& p) -> double& { return p.force.stiffness; }, 0.0, 1e5},
    {"force.damping", [](HapticParameters& p) -> double& { return p.force.damping; }, 0.0, 1000.0},
    {"force.velocity_lowpass_hz", [](HapticParameters& p) -> double& { return p.force.velocity_lowpass_hz; },
     1e-3, 2000.0},
    {"force.hunt_crossley_exponent",
     [](HapticParameters& p) -> double& { return p.force.hunt_crossley_exponent; }, 1.0, 5.0},
    {"force.hunt_crossley_damping",
     [](HapticParameters& p) -> double& { return p.force.hunt_crossley_damping; }, 0.0, 100.0},
    {"force.cubic", [](HapticParameters& p) -> double& { return p.force.cubic; }, 0.0, 1e11},
    {"force.linear_depth", [](HapticParameters& p) -> double& { return p.force.linear_depth; }, 0.0, 0.05},
    {"stabiliser.min_rate", [](HapticParameters& p) -> double& { return p.stabiliser.min_rate; }, -1e6,
     -kSmallest},
    {"stabiliser.max_rate", [](HapticParameters& p) -> double& { return p.stabiliser.max_rate; }, kSmallest,
     1e6},
    {"stabiliser.lowpass_hz", [](HapticParameters& p) -> double& { return p.stabiliser.lowpass_hz; }, 1e-3,
     2000.0},
    {"stabiliser.damping", [](HapticParameters& p) -> double& { return p.stabiliser.damping; }, 0.0, 1000.0},
    {"stabiliser.turn_rate", [](HapticParameters& p) -> double& { return p.stabiliser.turn_rate; }, kSmallest,
     1e6 * kDeg},
    {"stabiliser.coupling_stiffness",
     [](HapticParameters& p) -> double& { return p.stabiliser.coupling_stiffness; }, 1.0, 1e6},
    {"stabiliser.coupling_damping",
     [](HapticParameters& p) -> double& { return p.stabiliser.coupling_damping; }, 0.0, 1000.0},
    {"stabiliser.passivity_damping_max",
     [](HapticParameters& p) -> double& { return p.stabiliser.passivity_damping_max; }, 0.0, 1000.0},
    {"stabiliser.device_damping", [](HapticParameters& p) -> double& { return p.stabiliser.device_damping; },
     0.0, 1000.0},
    {"stabiliser.wall_valid", [](HapticParameters& p) -> double& { return p.stabiliser.wall_valid; }, 1e-4,
     1.0},
    {"oscillation.swing", [](HapticParameters& p) -> double& { return p.oscillation.swing; }, 0.01, 15.0},
    {"limits.fingertip_force", [](HapticParameters& p) -> double& { return p.limits.fingertip_force; },
     kSmallest, 15.0},
    {"limits.joint_torque", [](HapticParameters& p) -> double& { return p.limits.joint_torque; }, kSmallest,
     5.0},
    {"limits.torque_rate", [](HapticParameters& p) -> double& { return p.limits.torque_rate; }, kSmallest,
     1e4},
    {"limits.joint_speed", [](HapticParameters& p) -> double& { return p.limits.joint_speed; }, kSmallest,
     1000.0},
};

TEST(CheckParameters, TakesEachNumberUpToItsBoundAndNoFurther) {
  HapticParameters parameters;
  for (const Range& range : kRanges) {
    const double usual = range.of(parameters);
    for (const double good : {range.low, range.high}) {
      range.of(parameters) = good;
      EXPECT_NO_THROW(check_parameters(parameters)) << range.name << " = " << good;
    }
    for (const double bad : {std::nextafter(range.low, -kInfinity), std::nextafter(range.high, kInfinity)}) {
      range.of(parameters) = bad;
      expect_refused(parameters, range.name, bad);
    }
    for (const double bad : {kNan, kInfinity}) {
      if (bad == kInfinity && range.name == std::string("limits.joint_speed")) continue;  // the limit is off
      range.of(parameters) = bad;
      expect_refused(parameters, range.name, bad);
    }
    range.of(parameters) = usual;
  }
}

TEST(CheckParameters, RefusesMoreContactsThanThereIsRoomFor) {
  for (const int most : {0, 5, -1}) {
    HapticParameters parameters;
    parameters.contact.max_contacts = most;
    EXPECT_THROW(check_parameters(parameters), std::invalid_argument) << most;
  }
}

TEST(CheckParameters, TakesAFallWithoutBound) {
  HapticParameters parameters;
  parameters.stabiliser.min_rate = -kInfinity;
  EXPECT_NO_THROW(check_parameters(parameters));
}

TEST(CheckParameters, SaysTheRangeOfWhatItRefuses) {
  HapticParameters parameters;
  parameters.contact.slid_distance = -1.0;
  expect_refused(parameters, "contact.slid_distance [m] = -1: must be > 0, <= 0.1", -1.0);
  parameters.contact.slid_distance = 0.1;
  parameters.rate_hz = 5000.0;
  expect_refused(parameters, "rate_hz = 5000: must be >= 1, <= 4000", 5000.0);
}

TEST(CheckParameters, ALimitThatIsOffMayBeAnything) {
  HapticParameters parameters;
  parameters.limits = {.fingertip_force_enabled = false,
                       .fingertip_force = -1.0,
                       .joint_torque_enabled = false,
                       .joint_torque = -1.0,
                       .torque_rate_enabled = false,
                       .torque_rate = -1.0,
                       .joint_speed = kInfinity};
  EXPECT_NO_THROW(check_parameters(parameters));
}

TEST(CheckParameters, TheBoundsCountWhateverTheMethod) {
  HapticParameters parameters;
  parameters.stabiliser.max_rate = -1.0;
  for (const Stabiliser method : {Stabiliser::kNone, Stabiliser::kRiseOnly, Stabiliser::kLowPass}) {
    parameters.stabiliser.method = method;
    expect_refused(parameters, "stabiliser.max_rate", -1.0);
  }
}

TEST(CheckParameters, ThereIsNoMethodBeyondTheLast) {
  HapticParameters parameters;
  parameters.stabiliser.method = Stabiliser::kLocalWall;
  EXPECT_NO_THROW(check_parameters(parameters));
  for (const int method : {static_cast<int>(Stabiliser::kOwn) + 1, -1, 77}) {
    parameters.stabiliser.method = static_cast<Stabiliser>(method);
    expect_refused(parameters, "stabiliser.method", method);
  }
}

TEST(CheckParameters, ThereIsNoLawAndNoReactionBeyondTheLast) {
  HapticParameters parameters;
  parameters.force.law = ForceLaw::kLinearThenCubic;
  parameters.oscillation.reaction = OscillationReaction::kHalve;
  EXPECT_NO_THROW(check_parameters(parameters));
  for (const int number : {static_cast<int>(ForceLaw::kOwn) + 1, -1}) {
    HapticParameters unknown;
    unknown.force.law = static_cast<ForceLaw>(number);
    expect_refused(unknown, "force.law", number);
  }
  for (const int number : {static_cast<int>(OscillationReaction::kHalve) + 1, -1}) {
    HapticParameters unknown;
    unknown.oscillation.reaction = static_cast<OscillationReaction>(number);
    expect_refused(unknown, "oscillation.reaction", number);
  }
}

TEST(CheckParameters, AStateIsNotMadeWithoutIt) {
  HapticParameters parameters;
  parameters.force.stiffness = -1.0;
  const HapticModel model(test::simple_hand(), ObjectModel(test::moved(make_box(Vec3(0.3, 0.02, 0.3), 4),
                                                                       test::at(0.0, -0.05, 0.0))));
  EXPECT_THAT([&] { HapticState state(model, parameters); },
              ::testing::ThrowsMessage<std::invalid_argument>(::testing::HasSubstr("force.stiffness")));
}

}  // namespace
}  // namespace phalanx

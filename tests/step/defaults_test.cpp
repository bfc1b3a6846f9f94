// SPDX-License-Identifier: Apache-2.0
// Default values of the public structures of contact, force, hand and step.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "phalanx/contact/contact_parameters.h"
#include "phalanx/contact/gdp.h"
#include "phalanx/contact/proximity.h"
#include "phalanx/contact/segment_motion.h"
#include "phalanx/contact/triangle_distance.h"
#include "phalanx/force/force_parameters.h"
#include "phalanx/force/force_stage.h"
#include "phalanx/force/local_wall.h"
#include "phalanx/force/oscillation.h"
#include "phalanx/force/stabiliser.h"
#include "phalanx/hand/anthropometry.h"
#include "phalanx/hand/hand_parameters.h"
#include "phalanx/step/snapshot.h"
#include "support/zero_bytes.h"

namespace phalanx {
namespace {

TEST(Defaults, NothingUnlessSet) {
  EXPECT_TRUE(test::begins_as_zero<ContactRecord>());
  EXPECT_TRUE(test::begins_as_zero<ContactPatch>());
  EXPECT_TRUE(test::begins_as_zero<SegmentMotion>());
  EXPECT_TRUE(test::begins_as_zero<TriangleDistance>());
  EXPECT_TRUE(test::begins_as_zero<TiedRegion>());
  EXPECT_TRUE(test::begins_as_zero<SegmentForce>());
  EXPECT_TRUE(test::begins_as_zero<RememberedWall>());
  EXPECT_TRUE(test::begins_as_zero<LocalWall>());
  EXPECT_TRUE(test::begins_as_zero<StabiliserMemory>());
  EXPECT_TRUE(test::begins_as_zero<DhRow>());
  EXPECT_TRUE(test::begins_as_zero<SegmentShape>());
  EXPECT_TRUE(test::begins_as_zero<PalmShape>());
  EXPECT_TRUE(test::begins_as_zero<Norm>());
  EXPECT_TRUE(test::begins_as_zero<PlausibleRange>());
  EXPECT_TRUE(test::begins_as_zero<SegmentSnapshot>());
}

TEST(Defaults, AWallWithoutALargestForcePushesWithNone) {
  LocalWall wall;
  wall.active = true;
  wall.d_ref = 1e-3;
  wall.stiffness = 500.0;
  EXPECT_EQ(local_wall_force(wall, {}, {}), 0.0);
  wall.force_max = 0.2;
  EXPECT_EQ(local_wall_force(wall, {}, {}), 0.2);
}

TEST(Defaults, OfContact) {
  const ContactParameters contact;
  EXPECT_EQ(contact.margin, 50e-6);
  EXPECT_EQ(contact.slid_distance, 5e-3);
  EXPECT_EQ(contact.mode, ContactMode::kStatic);
  EXPECT_EQ(contact.friction, 0.6);
  EXPECT_EQ(contact.tangential_stiffness_ratio, 0.5);
  EXPECT_EQ(contact.spin_radius, 4e-3);
  EXPECT_EQ(contact.max_contacts, 4);
  EXPECT_EQ(contact.method, GdpMethod::kContinuous);
  EXPECT_EQ(contact.depth, DepthOrigin::kContinuous);
  EXPECT_EQ(contact.normal, ForceNormal::kInterpolated);
}

TEST(Defaults, OfForceAndLimits) {
  const ForceLawParameters law;
  EXPECT_EQ(law.law, ForceLaw::kHooke);
  EXPECT_EQ(law.stiffness, 500.0);
  EXPECT_EQ(law.damping, 2.0);
  EXPECT_EQ(law.velocity_lowpass_hz, 30.0);
  EXPECT_EQ(law.hunt_crossley_exponent, 1.5);
  EXPECT_EQ(law.hunt_crossley_damping, 2.0);
  EXPECT_EQ(law.cubic, 5e7);
  EXPECT_EQ(law.linear_depth, 2e-3);
  const LimitParameters limits;
  EXPECT_TRUE(limits.fingertip_force_enabled && limits.joint_torque_enabled && limits.torque_rate_enabled);
  EXPECT_EQ(limits.fingertip_force, 5.0);
  EXPECT_EQ(limits.joint_torque, 0.5);
  EXPECT_EQ(limits.torque_rate, 10.0);
  EXPECT_EQ(limits.joint_speed, 40.0);
}

TEST(Defaults, OfStabilisersAndTheObserver) {
  const StabiliserParameters stabiliser;
  EXPECT_EQ(stabiliser.method, Stabiliser::kRiseOnly);
  EXPECT_EQ(stabiliser.min_rate, -20.0);
  EXPECT_EQ(stabiliser.max_rate, 20.0);
  EXPECT_EQ(stabiliser.lowpass_hz, 3.0);
  EXPECT_EQ(stabiliser.damping, 4.0);
  EXPECT_DOUBLE_EQ(stabiliser.turn_rate, std::numbers::pi / 2);
  EXPECT_EQ(stabiliser.coupling_stiffness, 1000.0);
  EXPECT_EQ(stabiliser.coupling_damping, 4.0);
  EXPECT_EQ(stabiliser.passivity_damping_max, 10.0);
  EXPECT_EQ(stabiliser.device_damping, 1.6);
  EXPECT_EQ(stabiliser.wall_valid, 14e-3);
  const StabiliserInput input;
  for (const double number : {input.force, input.depth, input.speed, input.speed_now, input.sent})
    EXPECT_EQ(number, 0.0);
  EXPECT_FALSE(input.pressing);
  EXPECT_EQ(input.period, 0.005);
  const OscillationParameters oscillation;
  EXPECT_EQ(oscillation.reaction, OscillationReaction::kReport);
  EXPECT_EQ(oscillation.swing, 0.5);
}

TEST(Defaults, WhatASampleDoesNotMeasureIsNotANumber) {
  const Sample sample;
  EXPECT_EQ(sample.time_s, 0.0);
  for (const double torque : sample.measured_torque) EXPECT_TRUE(std::isnan(torque));
  for (const double force : sample.measured_force) EXPECT_TRUE(std::isnan(force));
  const Snapshot snapshot;
  EXPECT_EQ(snapshot.tick, 0U);
  EXPECT_EQ(snapshot.time_s, 0.0);
  EXPECT_EQ(snapshot.status, Status::kOk);
  EXPECT_EQ(snapshot.stiffness_factor, 1.0);
  EXPECT_EQ(snapshot.wall_valid_for, 0.0);
  for (const double torque : snapshot.measured_torque) EXPECT_TRUE(std::isnan(torque));
  for (const double force : snapshot.measured_force) EXPECT_TRUE(std::isnan(force));
}

}  // namespace
}  // namespace phalanx

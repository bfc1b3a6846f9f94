// SPDX-License-Identifier: Apache-2.0
#include "record/recording/view_message.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "serve/state_message.h"

namespace phalanx {
namespace {

StationView a_view() {
  StationView view;
  view.time = 12.5;
  view.snapshot.tick = 2500;
  for (std::size_t j = 0; j < kJoints; ++j) {
    view.snapshot.hcp_angle[j] = 0.01 * static_cast<double>(j);
    view.snapshot.gdp_angle[j] = -0.01 * static_cast<double>(j);
    view.sent[j] = 0.001 * static_cast<double>(j);
    view.snapshot.measured_torque[j] = std::numeric_limits<double>::quiet_NaN();
  }
  view.snapshot.measured_force.fill(std::numeric_limits<double>::quiet_NaN());
  view.stiffness = 700.0;
  view.duration = 123e-6;
  view.state = SafetyState::kStopping;
  view.factor = 0.25;
  return view;
}

TEST(TickMessage, HasTheOrderAndUnitsOfTheSchema) {
  StationView view = a_view();
  view.snapshot.hcp_pose[3].p = Vec3(1.0, 2.0, 3.0);
  // A quarter turn about z: x y z w = 0 0 sin 45 cos 45.
  view.snapshot.hcp_pose[3].R << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  view.snapshot.gdp_pose[3].p = Vec3(4.0, 5.0, 6.0);
  wire::Tick tick;
  write_tick(view, tick);
  EXPECT_EQ(tick.tick(), 2500U);
  EXPECT_EQ(tick.time(), 12.5);
  ASSERT_EQ(tick.hcp_angle_size(), kJoints);
  EXPECT_FLOAT_EQ(tick.hcp_angle(7), 0.07F);
  EXPECT_FLOAT_EQ(tick.gdp_angle(7), -0.07F);
  EXPECT_FLOAT_EQ(tick.torque(7), 0.007F);
  ASSERT_EQ(tick.hcp_pose_size(), 7 * kSegments);
  ASSERT_EQ(tick.gdp_pose_size(), 7 * kSegments);
  const double half = std::sqrt(0.5);
  const double expected[] = {1, 2, 3, 0, 0, half, half};
  for (int i = 0; i < 7; ++i) EXPECT_NEAR(static_cast<double>(tick.hcp_pose(21 + i)), expected[i], 1e-6);
  EXPECT_EQ(tick.gdp_pose(21), 4.0F);
  EXPECT_EQ(tick.gdp_pose(22), 5.0F);
  EXPECT_EQ(tick.gdp_pose(23), 6.0F);
  EXPECT_EQ(tick.stiffness(), 700.0F);
  EXPECT_EQ(tick.state(), wire::SAFETY_STOPPING);
  EXPECT_EQ(tick.factor(), 0.25F);
  EXPECT_TRUE(tick.at_rest());
  EXPECT_NEAR(static_cast<double>(tick.step_us()), 123.0, 1e-3);
}

TEST(TickMessage, SensorsThatAreNotThereAreLeftOutAndOneOfManyIsAllOfThem) {
  StationView view = a_view();
  wire::Tick tick;
  write_tick(view, tick);
  EXPECT_EQ(tick.measured_torque_size(), 0);
  EXPECT_EQ(tick.measured_force_size(), 0);
  view.snapshot.measured_torque[4] = 0.5;
  write_tick(view, tick);
  ASSERT_EQ(tick.measured_torque_size(), kJoints);
  EXPECT_TRUE(std::isnan(tick.measured_torque(3)));
  EXPECT_EQ(tick.measured_torque(4), 0.5F);
}

TEST(TickMessage, NamesTheDigitsThatStartedInsideTheObject) {
  StationView view = a_view();
  wire::Tick tick;
  write_tick(view, tick);
  EXPECT_EQ(tick.opening_size(), 0);
  view.snapshot.opening[1] = {.phase = OpeningPhase::kUnconfirmed, .way = 0.014};
  view.snapshot.opening[3] = {.phase = OpeningPhase::kConfirmed, .way = 0.002, .force = 0.5};
  view.snapshot.opening[4].phase = OpeningPhase::kNotFollowed;
  view.running = 6;
  write_tick(view, tick);
  ASSERT_EQ(tick.opening_size(), 3);
  EXPECT_EQ(tick.opening(0).digit(), 1U);
  EXPECT_EQ(tick.opening(0).phase(), wire::Opening::UNCONFIRMED);
  EXPECT_EQ(tick.opening(0).way(), 0.014F);
  EXPECT_EQ(tick.opening(0).running(), 6U);
  EXPECT_EQ(tick.opening(1).digit(), 3U);
  EXPECT_EQ(tick.opening(1).phase(), wire::Opening::CONFIRMED);
  EXPECT_EQ(tick.opening(2).phase(), wire::Opening::NOT_FOLLOWED);
}

TEST(TickMessage, OnlySegmentsThatTouchOrStillPushOrSwingAreContacts) {
  StationView view = a_view();
  view.snapshot.segment[5].contact = true;
  view.snapshot.segment[5].depth = 0.002;
  view.snapshot.segment[5].point = Vec3(0.1, 0.2, 0.3);
  view.snapshot.segment[5].normal = Vec3::UnitZ();
  view.snapshot.segment[5].force_raw = 2.0;
  view.snapshot.segment[5].force = 1.5;
  view.snapshot.segment[9].force = 0.1;  // decays
  view.snapshot.segment[11].depth = 1.0;
  view.snapshot.segment[12].oscillating = true;
  wire::Tick tick;
  write_tick(view, tick);
  write_tick(view, tick);  // the second time nothing is left of the first
  ASSERT_EQ(tick.contact_size(), 3);
  EXPECT_EQ(tick.contact(0).segment(), 5U);
  EXPECT_TRUE(tick.contact(0).touching());
  EXPECT_EQ(tick.contact(0).force_raw(), 2.0F);
  EXPECT_EQ(tick.contact(0).force(), 1.5F);
  ASSERT_EQ(tick.contact(0).point_size(), 3);
  EXPECT_FLOAT_EQ(tick.contact(0).point(1), 0.2F);
  EXPECT_EQ(tick.contact(0).normal(2), 1.0F);
  EXPECT_EQ(tick.contact(1).segment(), 9U);
  EXPECT_FALSE(tick.contact(1).touching());
  EXPECT_EQ(tick.contact(2).segment(), 12U);
  EXPECT_EQ(tick.hcp_angle_size(), kJoints);
}

// Every number another, exact in single precision.
TEST(TickMessage, EveryFieldOfAContactHasItsOwnNumber) {
  StationView view = a_view();
  view.snapshot.segment[5] = {.contact = true,
                              .depth = 0.001953125,
                              .force_raw = 2.5,
                              .force = 1.5,
                              .point = Vec3(0.125, 0.25, 0.375),
                              .normal = Vec3(0.5, -0.5, 0.75),
                              .slid = 0.0078125};
  view.snapshot.segment[5].oscillating = true;
  view.snapshot.segment[5].oscillation_frequency = 7.5;
  view.snapshot.segment[5].oscillation_swing = 0.625;
  view.snapshot.segment[5].slips = true;
  view.snapshot.stiffness_factor = 0.875;
  view.snapshot.status = static_cast<Status>(6);
  view.snapshot.measured_force[2] = 3.25;
  wire::Tick tick;
  write_tick(view, tick);
  ASSERT_EQ(tick.contact_size(), 1);
  const wire::Contact& contact = tick.contact(0);
  EXPECT_EQ(contact.depth(), 0.001953125F);
  EXPECT_EQ(contact.force_raw(), 2.5F);
  EXPECT_EQ(contact.force(), 1.5F);
  ASSERT_EQ(contact.point_size(), 3);
  ASSERT_EQ(contact.normal_size(), 3);
  const float point[] = {0.125F, 0.25F, 0.375F};
  const float normal[] = {0.5F, -0.5F, 0.75F};
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(contact.point(k), point[k]) << k;
    EXPECT_EQ(contact.normal(k), normal[k]) << k;
  }
  EXPECT_EQ(contact.slid(), 0.0078125F);
  EXPECT_TRUE(contact.oscillating());
  EXPECT_EQ(contact.frequency(), 7.5F);
  EXPECT_EQ(contact.swing(), 0.625F);
  EXPECT_TRUE(contact.slips());
  EXPECT_EQ(tick.stiffness_factor(), 0.875F);
  EXPECT_EQ(tick.status(), 6U);
  ASSERT_GT(tick.measured_force_size(), 2);
  EXPECT_EQ(tick.measured_force(2), 3.25F);
}

TEST(TickMessage, EveryFieldOfAContactPointHasItsOwnNumber) {
  StationView view = a_view();
  wire::Tick tick;
  write_tick(view, tick);
  EXPECT_EQ(tick.contact_point_size(), 0);
  view.snapshot.contact_points.count = 2;
  view.snapshot.contact_points.point[0].segment = 3;
  view.snapshot.contact_points.point[1] = {.segment = 5,
                                           .point = Vec3(0.125, 0.25, 0.375),
                                           .normal = Vec3(0.5, -0.5, 0.75),
                                           .force = 1.5,
                                           .friction = Vec3(-0.125, 2.5, 3.25),
                                           .spin = 0.0078125,
                                           .coefficient = 0.625,
                                           .slips = true};
  write_tick(view, tick);
  write_tick(view, tick);  // the second time nothing is left of the first
  ASSERT_EQ(tick.contact_point_size(), 2);
  EXPECT_EQ(tick.contact_point(0).segment(), 3U);
  EXPECT_FALSE(tick.contact_point(0).slips());
  const wire::ContactPoint& point = tick.contact_point(1);
  EXPECT_EQ(point.segment(), 5U);
  const float numbers[] = {0.125F, 0.25F, 0.375F, 0.5F, -0.5F, 0.75F, -0.125F, 2.5F, 3.25F};
  ASSERT_EQ(point.point_size(), 3);
  ASSERT_EQ(point.normal_size(), 3);
  ASSERT_EQ(point.friction_size(), 3);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(point.point(k), numbers[k]) << k;
    EXPECT_EQ(point.normal(k), numbers[3 + k]) << k;
    EXPECT_EQ(point.friction(k), numbers[6 + k]) << k;
  }
  EXPECT_EQ(point.force(), 1.5F);
  EXPECT_EQ(point.spin(), 0.0078125F);
  EXPECT_EQ(point.coefficient(), 0.625F);
  EXPECT_TRUE(point.slips());
}

TEST(StateMessage, EveryCounterOfTheLinkHasItsOwnNumber) {
  wire::Link link;
  write_link({.received = 901,
              .lost = 902,
              .outdated = 903,
              .corrupt = 904,
              .refused = 905,
              .overflowed = 906,
              .sent = 907},
             link);
  EXPECT_EQ(link.received(), 901U);
  EXPECT_EQ(link.lost(), 902U);
  EXPECT_EQ(link.outdated(), 903U);
  EXPECT_EQ(link.corrupt(), 904U);
  EXPECT_EQ(link.refused(), 905U);
  EXPECT_EQ(link.sent(), 907U);
}

TEST(TickMessage, EveryStateHasItsNameOnTheWire) {
  EXPECT_EQ(wire_state(SafetyState::kWaiting), wire::SAFETY_WAITING);
  EXPECT_EQ(wire_state(SafetyState::kStarting), wire::SAFETY_STARTING);
  EXPECT_EQ(wire_state(SafetyState::kRunning), wire::SAFETY_RUNNING);
  EXPECT_EQ(wire_state(SafetyState::kStopping), wire::SAFETY_STOPPING);
  EXPECT_EQ(wire_state(SafetyState::kStopped), wire::SAFETY_STOPPED);
  EXPECT_EQ(wire_state(SafetyState::kFault), wire::SAFETY_FAULT);
}

}  // namespace
}  // namespace phalanx

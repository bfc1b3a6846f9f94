// SPDX-License-Identifier: Apache-2.0
#include "record/recording/setup_message.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "phalanx/device/exoskeleton.h"
#include "phalanx/device/moment_arm.h"
#include "phalanx/recording.pb.h"
#include "phalanx/scene/device_file.h"
#include "phalanx/station/session_change.h"
#include "station/sensor_watch.h"

namespace phalanx {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// A motor with a polynomial, and those of the shipped device `linkages`.
std::vector<MotorWitness> linked_witnesses() {
  Exoskeleton exoskeleton = load_device_file("linkages");
  ExoMotor motor;
  motor.tendon_stiffness = 7000.0;
  add_linkage(motor,
              {.joint = 0, .min_angle = -0.5, .max_angle = 1.5, .polynomial = {-0.012, 0.002, -0.001}});
  exoskeleton.motors.insert(exoskeleton.motors.begin(), motor);
  std::vector<DeviceChannel> channels;
  for (int m = 0; m < static_cast<int>(exoskeleton.motors.size()); ++m)
    channels.push_back({.kind = ChannelKind::kMotor, .index = m});
  return motor_witnesses(exoskeleton, channels, 0.5);
}

wire::Setup setup_with(const std::vector<MotorWitness>& witnesses) {
  SessionChange change;
  change.setup.emplace().witnesses = witnesses;
  change.setup->channels.resize(witnesses.size());
  wire::Setup setup;
  write_change(change, "simulated", setup);
  wire::Setup read;
  EXPECT_TRUE(read.ParseFromString(setup.SerializeAsString()));
  return read;
}

TEST(SetupMessage, LinkagesOfMotorsAreReadAsTheyWereWritten) {
  const std::vector<MotorWitness> before = linked_witnesses();
  const std::vector<MotorWitness> after = read_witnesses(setup_with(before));
  ASSERT_EQ(after.size(), before.size());
  std::size_t polynomials = 0, tables = 0, bars = 0;
  for (std::size_t w = 0; w < before.size(); ++w) {
    EXPECT_EQ(after[w].channel, before[w].channel);
    EXPECT_EQ(after[w].arm, before[w].arm);
    EXPECT_EQ(after[w].least_arm, before[w].least_arm) << "of motor " << w;
    EXPECT_EQ(after[w].slack, before[w].slack);
    ASSERT_EQ(after[w].linkages.size(), before[w].linkages.size()) << "of motor " << w;
    for (std::size_t l = 0; l < before[w].linkages.size(); ++l) {
      const JointLinkage& a = after[w].linkages[l];
      const JointLinkage& b = before[w].linkages[l];
      EXPECT_EQ(a.joint, b.joint);
      EXPECT_EQ(a.min_angle, b.min_angle);
      EXPECT_EQ(a.max_angle, b.max_angle);
      for (double q = b.min_angle - 0.1; q < b.max_angle + 0.1; q += 0.01) {
        ASSERT_EQ(moment_arm(a, q), moment_arm(b, q)) << "the same bits";
        ASSERT_EQ(excursion(a, q), excursion(b, q));
      }
      polynomials += b.polynomial.empty() ? 0U : 1U;
      tables += b.table.empty() ? 0U : 1U;
      bars += b.four_bar ? 1U : 0U;
    }
  }
  EXPECT_EQ(polynomials, 1U);
  EXPECT_EQ(tables, 1U);
  EXPECT_EQ(bars, 1U);
}

TEST(SetupMessage, WithoutLinkagesEachArmIsConstantAsInEarlierRecordings) {
  wire::Setup setup = setup_with(linked_witnesses());
  for (wire::Setup::Witness& witness : *setup.mutable_witness()) witness.clear_linkage();
  for (const MotorWitness& witness : read_witnesses(setup)) {
    EXPECT_TRUE(witness.linkages.empty());
    EXPECT_EQ(witness.least_arm, MotorWitness{}.least_arm);
    EXPECT_NE(witness.arm, MotorWitness{}.arm);
  }
}

TEST(SetupMessage, ALinkageThatCannotBeIsRefused) {
  const wire::Setup setup = setup_with(linked_witnesses());
  const auto refused = [&setup](auto change, const std::string& words) {
    wire::Setup other = setup;
    wire::Setup::Linkage& linkage = *other.mutable_witness(0)->mutable_linkage(0);
    change(linkage);
    EXPECT_THAT([&] { static_cast<void>(read_witnesses(other)); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(words)));
  };
  refused([](wire::Setup::Linkage& linkage) { linkage.set_joint(kJoints); },
          "a linkage of joint 20; at most 19");
  refused([](wire::Setup::Linkage& linkage) { linkage.add_table(0.1); }, "half a point");
  refused([](wire::Setup::Linkage& linkage) { linkage.clear_polynomial(); }, "state exactly one");
  refused([](wire::Setup::Linkage& linkage) { linkage.set_max_angle(-1.0); }, "must increase");
}

}  // namespace
}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "device/controller_faults.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>

namespace phalanx {
namespace {

using Kind = ControllerFaultKind;

std::string refusal(const std::string& text) {
  try {
    static_cast<void>(parse_controller_fault(text));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

ControllerFaultPlan plan_of(const std::vector<std::string>& texts, std::size_t channels = 16,
                            std::size_t motors = 8) {
  std::vector<ControllerFault> faults;
  for (const std::string& text : texts) faults.push_back(parse_controller_fault(text));
  return {faults, channels, motors};
}

TEST(ControllerFaults, AreReadFromNameValueStartAndLength) {
  const ControllerFault plain = parse_controller_fault("drop=0.25");
  EXPECT_EQ(plain.kind, Kind::kDrop);
  EXPECT_EQ(plain.value, 0.25);
  EXPECT_EQ(plain.start, 0.0);
  EXPECT_EQ(plain.end, std::numeric_limits<double>::infinity());
  const ControllerFault timed = parse_controller_fault("stuck=3@2.5+0.5");
  EXPECT_EQ(timed.kind, Kind::kStuck);
  EXPECT_EQ(timed.value, 3.0);
  EXPECT_EQ(timed.start, 2.5);
  EXPECT_EQ(timed.end, 3.0);
  const ControllerFault open_ended = parse_controller_fault("silence@1e-1");
  EXPECT_EQ(open_ended.kind, Kind::kSilence);
  EXPECT_EQ(open_ended.start, 0.1);
  EXPECT_EQ(open_ended.end, std::numeric_limits<double>::infinity());
}

TEST(ControllerFaults, WhatCannotBeMeantIsRefusedWithWhatCan) {
  EXPECT_NE(refusal("dorp=0.1").find("clock-backwards"), std::string::npos) << "names all";
  for (const char* text : {"",
                           "=",
                           "@1",
                           "drop",
                           "drop=",
                           "drop=1.1",
                           "drop=-0.1",
                           "drop=nan",
                           "drop=0.1x",
                           "delay=2",
                           "jitter=inf",
                           "stuck=1.5",
                           "stuck=-1",
                           "stuck=256",
                           "silence=1",
                           "drop=0.1@",
                           "drop=0.1@-1",
                           "drop=0.1@1+",
                           "drop=0.1@1+0",
                           "drop=0.1@1+-1",
                           "drop=0.1@1+2+3",
                           "drop=0.1@1@2"})
    EXPECT_NE(refusal(text), "") << text;
  EXPECT_NE(refusal("open").find("open=CHANNEL"), std::string::npos) << refusal("open");
}

TEST(ControllerFaults, EveryFaultOfTheListCanBeTyped) {
  const std::string list = controller_fault_list();
  int count = 0;
  for (std::size_t at = 0; list[at] != 'E'; at = list.find('\n', at) + 1) {
    std::string spec = list.substr(at, list.find(' ', at) - at);
    if (const std::size_t equals = spec.find('='); equals != std::string::npos)
      spec = spec.substr(0, equals) + "=1";
    EXPECT_EQ(refusal(spec), "") << spec;
    ++count;
  }
  EXPECT_EQ(count, static_cast<int>(Kind::kSlowClock) + 1);
}

TEST(ControllerFaults, ASlowControllerMakesEveryNthTick) {
  const ControllerFaultPlan plan = plan_of({"slow=5@1+1", "slow-clock=3@3"});
  EXPECT_EQ(plan.slowness(0.5).every, 1);
  EXPECT_EQ(plan.slowness(1.5).every, 5);
  EXPECT_FALSE(plan.slowness(1.5).clock);
  EXPECT_EQ(plan.slowness(3.5).every, 3);
  EXPECT_TRUE(plan.slowness(3.5).clock);
  for (const char* text : {"slow", "slow=0", "slow=1.5", "slow-clock=256"})
    EXPECT_NE(refusal(text).find("a whole number from 1 to 255"), std::string::npos) << text;
}

TEST(ControllerFaults, AreInForceFromStartToEnd) {
  const ControllerFaultPlan plan = plan_of({"drop=0.1@1+0.5", "drop=0.3@1.2+0.1", "estop@2", "noise=4"});
  EXPECT_EQ(plan.packets(0.999).drop, 0.0);
  EXPECT_EQ(plan.packets(1.0).drop, 0.1);
  EXPECT_EQ(plan.packets(1.25).drop, 0.3) << "the later on the line counts";
  EXPECT_EQ(plan.packets(1.5).drop, 0.0);
  EXPECT_FALSE(plan.breakage(1.999).estop);
  EXPECT_TRUE(plan.breakage(100.0).estop);
  EXPECT_EQ(plan.breakage(0.0).noise_channel, 4);
  EXPECT_EQ(plan.breakage(0.0).noise_counts, 20.0);
  EXPECT_EQ(plan.breakage(0.0).stuck_channel, -1);
}

TEST(ControllerFaults, ARestartComesOnceAndIsNotMissed) {
  ControllerFaultPlan plan = plan_of({"restart@1", "restart@2"});
  EXPECT_FALSE(plan.restarts(0.999));
  EXPECT_TRUE(plan.restarts(1.003)) << "the tick at 1 s was left out";
  EXPECT_FALSE(plan.restarts(1.004));
  EXPECT_TRUE(plan.restarts(2.0));
  EXPECT_FALSE(plan.restarts(2.001));
}

TEST(ControllerFaults, ChannelsAndMotorsMustBeThere) {
  EXPECT_NO_THROW(plan_of({"stuck=15", "dead-motor=7"}));
  EXPECT_THROW(plan_of({"stuck=16"}), std::invalid_argument);
  EXPECT_THROW(plan_of({"dead-motor=8"}), std::invalid_argument);
  EXPECT_THROW(plan_of({"dead-motor=0"}, 16, 0), std::invalid_argument);
}

}  // namespace
}  // namespace phalanx

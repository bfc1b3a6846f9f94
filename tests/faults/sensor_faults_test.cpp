// SPDX-License-Identifier: Apache-2.0
// Sensors and motors that cannot be believed: a fault that has a name, and torque that stays finite and
// within limits on the way to zero.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "faults/fault_suite.h"
#include "faults/reactions.h"

namespace phalanx::testing {
namespace {

// Channels of the scene's device: angles of its 8 joints, what its 8 motors have wound, torque sensors.
// The thumb carries the force, the index finger moves most.
const std::string kThumbCmcFlexion = "0";
const std::string kThumbIpFlexion = "3";
const std::string kIndexMcpFlexion = "4";
const std::string kMotorOfIndexMcp = "2";  // motors are in the order of their names
constexpr double kAt = 2.4;                ///< when it breaks: mid-contact [s]

std::string at(const std::string& fault, double time = kAt) { return fmt::format("{}@{}", fault, time); }

/// A sensor's fault is told by the first step that has seen the third bad sample: counted in samples, however
/// many of them a step of the host gets at once.
struct Found {
  std::string fault;
  std::int64_t seen_before = 0;  ///< bad samples that the step before knew
  std::int64_t seen = 0;         ///< bad samples that the step knew which told the fault
  std::size_t to_zero = 0;       ///< ticks of the controller from the first bad sample to zero torque
  double before = 0.0;           ///< torque [Nm]
};

Found found_by_host(const Outcome& outcome, double time = kAt) {
  const ControllerRows& rows = outcome.logs.controller;
  const HostRows& host = outcome.logs.host;
  Found out;
  const std::size_t begin = row_at(rows, time);
  const std::size_t fault = first_row(host, 1, in_fault);
  if (begin >= rows.size() || fault >= host.size()) return out;
  const auto bad_until = [&](std::int64_t sample_time) {
    std::int64_t count = 0;
    for (std::size_t i = begin; i < rows.size() && rows[i].time_us <= sample_time; ++i) ++count;
    return count;
  };
  out.fault = host[fault].fault;
  out.seen = bad_until(host[fault].sample_time_us);
  out.seen_before = bad_until(host[fault - 1].sample_time_us);
  out.before = torque_before(rows, begin);
  const std::size_t zero =
      first_row(rows, begin, [](const ControllerRow& row) { return row.largest == 0.0; });
  out.to_zero = zero - begin;
  for (std::size_t i = zero; i < rows.size(); ++i) EXPECT_EQ(rows[i].largest, 0.0) << "tick " << rows[i].tick;
  return out;
}

void expect_found(const std::string& test, const std::string& fault, const std::string& what) {
  const Outcome& o = outcome(test);
  expect_sane(o);
  const Found found = found_by_host(o);
  EXPECT_GT(found.before, 0.02);
  EXPECT_EQ(found.fault, fault);
  EXPECT_EQ(o.faults, std::vector<std::string>{fault});
  EXPECT_LT(found.seen_before, 3);
  EXPECT_GE(found.seen, 3);
  EXPECT_EQ(o.host_exit, 1);
  print_row(what, "fault within 3 samples; command finite and within limits",
            fmt::format("`{}` by the host's first step that had 3 bad samples (it had {}); from {:.0f} mNm "
                        "to zero {} ticks "
                        "after the first",
                        found.fault, found.seen, 1e3 * found.before, found.to_zero));
}

void expect_latched_by_controller(const std::string& test, const std::string& what) {
  const Outcome& o = outcome(test);
  expect_sane(o);
  const ControllerRows& rows = o.logs.controller;
  const std::size_t begin = row_at(rows, kAt);
  const std::size_t latch = first_row(rows, begin, is_latched);
  ASSERT_LT(latch, rows.size());
  EXPECT_GT(torque_before(rows, begin), 0.02);
  EXPECT_LE(latch - begin + 1, 3U);
  for (std::size_t i = latch; i < rows.size(); ++i)
    ASSERT_EQ(rows[i].largest, 0.0) << "tick " << rows[i].tick;
  EXPECT_EQ(rows[latch].fault, "sensor_range");
  EXPECT_EQ(o.faults, std::vector<std::string>{"sensor_range"});
  EXPECT_EQ(o.host_exit, 1);
  print_row(what, "fault within 3 samples; command finite and within limits",
            fmt::format("`{}` by the controller at sample {}, from {:.0f} mNm to zero in the same tick",
                        rows[latch].fault, latch - begin + 1, 1e3 * torque_before(rows, begin)));
}

/// A rate is judged over windows of 0.5 s, which begin with the first sample. A slow clock needs one window
/// more.
void expect_slow_found(const std::string& test, const std::string& what, std::int64_t within_us) {
  const Outcome& o = outcome(test);
  expect_sane(o);
  const ControllerRows& rows = o.logs.controller;
  const HostRows& host = o.logs.host;
  const std::size_t begin = row_at(rows, kAt);
  const std::size_t fault = first_row(host, 1, in_fault);
  ASSERT_LT(begin, rows.size());
  ASSERT_LT(fault, host.size()) << "not noticed";
  EXPECT_EQ(o.faults, std::vector<std::string>{"sample_rate"});
  const std::size_t last = row_after_sample(rows, host[fault].sample_time_us);
  EXPECT_GT(torque_before(rows, last), 0.02);
  EXPECT_LE(rows[last].time_us - rows[begin].time_us, within_us);
  const std::size_t zero = first_row(rows, last, [](const ControllerRow& row) { return row.largest == 0.0; });
  EXPECT_LE(zero - last, 4U) << "5 ms of the controller are one or two of its ticks";
  for (std::size_t i = zero; i < rows.size(); ++i) ASSERT_EQ(rows[i].largest, 0.0) << "tick " << rows[i].tick;
  EXPECT_EQ(o.host_exit, 1);
  print_row(what, "fault that names both rates; torque off",
            fmt::format("`{}` {} ms of the controller's clock after it became slow, at {:.0f} mNm; zero {} "
                        "of its ticks later",
                        host[fault].fault, (rows[last].time_us - rows[begin].time_us) / 1000,
                        1e3 * torque_before(rows, last), zero - last));
}

const Registered kSlow("AControllerAtAFifthOfItsRateIsAFault", "",
                       {.controller = {"--fault", at("slow=5")}, .seconds = 4.0});
TEST(Faults, AControllerAtAFifthOfItsRateIsAFault) {
  expect_slow_found("AControllerAtAFifthOfItsRateIsAFault",
                    "controller at a fifth of the rate that it promises", 1'000'000);
  EXPECT_NE(outcome("AControllerAtAFifthOfItsRateIsAFault").host_output.find("promises 1000 Hz"),
            std::string::npos);
}

const Registered kSlowClock("AControllerWhoseClockIsFiveTimesTooSlowIsAFault", "",
                            {.controller = {"--fault", at("slow-clock=5")}, .seconds = 4.0});
TEST(Faults, AControllerWhoseClockIsFiveTimesTooSlowIsAFault) {
  expect_slow_found("AControllerWhoseClockIsFiveTimesTooSlowIsAFault",
                    "the same, with a clock five times too slow", 300'000);
}

const Registered kOpen("AnOpenSensorIsAFault", "",
                       {.controller = {"--fault", at("open=" + kThumbCmcFlexion)}, .seconds = 3.0});
TEST(Faults, AnOpenSensorIsAFault) { expect_latched_by_controller("AnOpenSensorIsAFault", "open sensor"); }

const Registered kShorted("AShortedSensorIsAFault", "",
                          {.controller = {"--fault", at("short=" + kThumbCmcFlexion)}, .seconds = 3.0});
TEST(Faults, AShortedSensorIsAFault) {
  expect_latched_by_controller("AShortedSensorIsAFault", "shorted sensor");
}

const Registered kJump("AJumpOf50DegreesIsAFault", "",
                       {.controller = {"--fault", at("jump=" + kIndexMcpFlexion)},
                        .host = {"--rate-hz", "1000"},
                        .seconds = 3.0});
TEST(Faults, AJumpOf50DegreesIsAFault) {
  expect_found("AJumpOf50DegreesIsAFault", "jump", "50-degree jump of a sensor (host at 1 kHz)");
}

// The controller's hand can do what this patient's cannot.
const Registered kRange("AnAngleOutOfThePatientsRangeIsAFault", "",
                        {.controller = {"--fault", at("jump=" + kThumbIpFlexion)},
                         .host = {"--rate-hz", "1000", "--profile", "stiff-hand"},
                         .seconds = 3.0});
TEST(Faults, AnAngleOutOfThePatientsRangeIsAFault) {
  expect_found("AnAngleOutOfThePatientsRangeIsAFault", "out_of_range",
               "angle out of the patient's range (profile stiff-hand, host at 1 kHz)");
}

const Registered kClock("AClockThatRunsBackwardsIsAFault", "",
                        {.controller = {"--fault", at("clock-backwards")},
                         .host = {"--rate-hz", "1000"},
                         .seconds = 3.0});
TEST(Faults, AClockThatRunsBackwardsIsAFault) {
  const Outcome& o = outcome("AClockThatRunsBackwardsIsAFault");
  expect_sane(o);
  const ControllerRows& rows = o.logs.controller;
  std::size_t begin = 1;
  while (begin < rows.size() && rows[begin].time_us > rows[begin - 1].time_us) ++begin;
  ASSERT_LT(begin, rows.size());
  EXPECT_GT(torque_before(rows, begin), 0.02);
  const HostRows& host = o.logs.host;
  const std::size_t fault = first_row(host, 1, in_fault);
  ASSERT_LT(fault, host.size());
  // With a step as young as here the controller soon cannot tell its age any more, and latches before the
  // host has seen three such samples.
  EXPECT_EQ(host[fault].fault, "step_too_old");
  // The newest sample at a step is the k-th of the bad ones if its time is k ticks before the last good one.
  const std::int64_t good = rows[begin - 1].time_us;
  const std::int64_t seen_before = (good - host[fault - 1].sample_time_us + 500) / 1000;
  EXPECT_LT(seen_before, 3);
  const std::size_t zero =
      first_row(rows, begin, [](const ControllerRow& row) { return row.largest == 0.0; });
  ASSERT_LT(zero, rows.size());
  for (std::size_t i = zero; i < rows.size(); ++i) ASSERT_EQ(rows[i].largest, 0.0) << "tick " << rows[i].tick;
  EXPECT_EQ(o.host_exit, 1);
  print_row("clock running backwards (host at 1 kHz)",
            "fault within 3 samples; command finite and within limits",
            fmt::format("host `{}`, controller `{}`; from {:.0f} mNm to zero at sample {}", host[fault].fault,
                        rows[zero].fault, 1e3 * torque_before(rows, begin), zero - begin + 1));
}

// From here to the next squeeze the hand opens and closes: the sensor should move.
constexpr double kStuckAt = 4.25;

const Registered kStuck("AStuckSensorIsAFault", "",
                        {.controller = {"--fault", at("stuck=" + kIndexMcpFlexion, kStuckAt)},
                         .seconds = 6.6});
TEST(Faults, AStuckSensorIsAFault) {
  const Outcome& o = outcome("AStuckSensorIsAFault");
  expect_sane(o);
  const Found found = found_by_host(o, kStuckAt);
  EXPECT_EQ(found.fault, "stuck_sensor");
  EXPECT_EQ(o.faults, std::vector<std::string>{"stuck_sensor"});
  EXPECT_GT(found.seen, 0);  // it may have stood still by chance before it stuck
  EXPECT_LE(found.seen, 1000);
  EXPECT_EQ(o.host_exit, 1);
  print_row("stuck sensor", "fault when unchanged for 500 ms while the motor moves by more than 10 counts",
            fmt::format("`{}` {} ticks after it stuck", found.fault, found.seen));
}

const Registered kDead("ADeadMotorIsAFault", "",
                       {.controller = {"--fault", at("dead-motor=" + kMotorOfIndexMcp)},
                        .both = {"--set", "device.joints.index_mcp_flexion.torque_sensor=true", "--set",
                                 "patient.press_n=8"},
                        .scene = "press_teapot",
                        .seconds = 4.2});
TEST(Faults, ADeadMotorIsAFault) {
  const Outcome& o = outcome("ADeadMotorIsAFault");
  expect_sane(o);
  const Found found = found_by_host(o);
  EXPECT_GT(found.before, 0.02);
  EXPECT_EQ(found.fault, "torque_disagrees");
  EXPECT_EQ(o.faults, std::vector<std::string>{"torque_disagrees"});
  EXPECT_GE(found.seen, 200);
  EXPECT_EQ(o.host_exit, 1);
  print_row(
      "commanded and measured torque disagree (dead motor of the index finger's MCP joint, torque sensor, "
      "`press_teapot` pressed with 8 N)",
      "fault; bound: 150 mNm + 50 % of the command for 200 ms",
      fmt::format("`{}` {} ticks after the motor died at {:.0f} mNm; zero after {} ticks", found.fault,
                  found.seen, 1e3 * found.before, found.to_zero));
}

const Registered kEstop("TheEmergencyStopIsAFault", "",
                        {.controller = {"--fault", at("estop")}, .seconds = 3.0});
TEST(Faults, TheEmergencyStopIsAFault) {
  const Outcome& o = outcome("TheEmergencyStopIsAFault");
  expect_sane(o);
  const ControllerRows& rows = o.logs.controller;
  const std::size_t begin = row_at(rows, kAt);
  ASSERT_LT(begin, rows.size());
  EXPECT_GT(torque_before(rows, begin), 0.02);
  for (std::size_t i = begin; i < rows.size(); ++i)
    ASSERT_EQ(rows[i].largest, 0.0) << "tick " << rows[i].tick;
  EXPECT_EQ(rows[begin].fault, "emergency_stop");
  EXPECT_EQ(o.faults, std::vector<std::string>{"emergency_stop"});
  print_row("emergency stop pressed", "zero torque, fault",
            fmt::format("`{}`, from {:.0f} mNm to zero in the tick that sees it", rows[begin].fault,
                        1e3 * torque_before(rows, begin)));
}

}  // namespace
}  // namespace phalanx::testing

// SPDX-License-Identifier: Apache-2.0
// Who speaks no more: the controller, the cable, the host; and who speaks but may not.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "faults/fault_suite.h"
#include "faults/reactions.h"

namespace phalanx::testing {
namespace {

using Names = std::vector<std::string>;

double ms(std::int64_t us) { return 1e-3 * static_cast<double>(us); }

const Registered kSilence("ASilentControllerStopsTheHost", "",
                          {.controller = {"--fault", "silence@2.2+0.2"},
                           .events = {type_at(2.9, "reset")},
                           .seconds = 4.6});
TEST(Faults, ASilentControllerStopsTheHost) {
  const Outcome& o = outcome("ASilentControllerStopsTheHost");
  expect_sane(o);
  const ControllerRows& rows = o.logs.controller;
  const std::size_t begin = row_at(rows, 2.2);
  ASSERT_GT(torque_before(rows, begin), 0.02);
  const Fade fade = fade_after(rows, begin);
  EXPECT_LT(fade.active_age, kLatchAge);
  EXPECT_EQ(o.faults, Names{"no_sample"});
  expect_fresh_start_after(rows, fade.zero, 400);
  EXPECT_EQ(o.host_exit, 0) << o.host_output;
  print_row(
      "controller silent for 200 ms", "zero torque by 20 ms, fault named, only reset and a fresh ramp resume",
      fmt::format(
          "from {:.0f} mNm to zero {} ticks after the silence began, step {:.0f} ms old; `no_sample`; zero "
          "until reset, then a ramp of 1 s",
          1e3 * torque_before(rows, begin), fade.zero - begin + 1, ms(fade.zero_age)));
}

/// Steps of the host from its newest sample to zero torque.
struct HostStop {
  std::string fault;
  std::size_t steps = 0;
  double before = 0.0;  ///< torque [Nm]
};
HostStop host_stop(const HostRows& rows) {
  HostStop out;
  const std::size_t fault = first_row(rows, 0, in_fault);
  if (fault >= rows.size() || fault == 0) return out;
  out.fault = rows[fault].fault;
  std::size_t heard = fault;
  while (heard > 0 && rows[heard].samples == 0) --heard;
  out.before = rows[fault - 1].largest;
  const std::size_t zero = first_row(rows, fault, [](const HostRow& row) { return row.largest == 0.0; });
  out.steps = zero - heard;
  for (std::size_t i = zero; i < rows.size(); ++i) EXPECT_EQ(rows[i].largest, 0.0) << "step " << rows[i].tick;
  return out;
}

void kill_controller(TwoProcesses& both) { both.controller().signal(SIGKILL); }

const Registered kPulledUdp("ACableThatIsPulledStopsTheHost", "udp",
                            {.events = {{2.4, kill_controller}}, .seconds = 3.0});
const Registered kPulledPty("ACableThatIsPulledStopsTheHost", "pty",
                            {.pty = true, .events = {{2.4, kill_controller}}, .seconds = 3.0});
TEST(Faults, ACableThatIsPulledStopsTheHost) {
  const HostStop udp = host_stop(outcome("ACableThatIsPulledStopsTheHost", "udp").logs.host);
  const HostStop pty = host_stop(outcome("ACableThatIsPulledStopsTheHost", "pty").logs.host);
  EXPECT_GT(udp.before, 0.02);
  EXPECT_GT(pty.before, 0.02);
  EXPECT_EQ(udp.fault, "no_sample");
  EXPECT_EQ(pty.fault, "device_lost");
  // 10 ms without a sample and 5 ms of ramp are three steps; and the one in which the last sample was read.
  EXPECT_LE(udp.steps, 4U);
  EXPECT_LE(pty.steps, 4U);
  EXPECT_EQ(outcome("ACableThatIsPulledStopsTheHost", "udp").faults, Names{"no_sample"});
  EXPECT_EQ(outcome("ACableThatIsPulledStopsTheHost", "pty").faults, Names{"device_lost"});
  print_row("cable pulled (the controller's end gone): UDP, serial", "fault named; the host commands zero",
            fmt::format("`{}`, zero {} steps of 5 ms after the last sample; `{}`, {} steps", udp.fault,
                        udp.steps, pty.fault, pty.steps));
}

const Registered kRestart("ARestartedControllerStaysAtZero", "",
                          {.controller = {"--fault", "restart@2.2"},
                           .events = {type_at(2.9, "reset")},
                           .seconds = 4.6});
TEST(Faults, ARestartedControllerStaysAtZero) {
  const Outcome& o = outcome("ARestartedControllerStaysAtZero");
  expect_sane(o);
  const ControllerRows& rows = o.logs.controller;
  std::size_t begin = 1;
  while (begin < rows.size() && rows[begin].time_us > rows[begin - 1].time_us) ++begin;
  ASSERT_LT(begin, rows.size());
  ASSERT_GT(torque_before(rows, begin), 0.02);
  EXPECT_EQ(rows[begin].largest, 0.0);
  EXPECT_EQ(o.faults, Names{"controller_restarted"});
  std::uint64_t refused = 0;
  for (const ControllerRow& row : rows) refused = std::max(refused, row.refused);
  EXPECT_GT(refused, 0U);
  expect_fresh_start_after(rows, begin, 400);
  EXPECT_EQ(o.host_exit, 0) << o.host_output;
  print_row(
      "controller restarted mid-contact",
      "zero torque by 20 ms, fault named, stale epoch refused, only reset and a fresh ramp resume",
      fmt::format("from {:.0f} mNm to zero at its first tick; `controller_restarted`; {} commands of the "
                  "old session refused; zero until reset, then a ramp of 1 s",
                  1e3 * torque_before(rows, begin), refused));
}

void stall_host(TwoProcesses& both) {
  both.host().signal(SIGSTOP);
  both.pass(0.05);
  both.host().signal(SIGCONT);
}

const Registered kStall("AStalledHostLeavesZeroTorque", "",
                        {.events = {{2.2, stall_host}, type_at(2.9, "reset")}, .seconds = 4.6});
TEST(Faults, AStalledHostLeavesZeroTorque) {
  const Outcome& o = outcome("AStalledHostLeavesZeroTorque");
  expect_sane(o);
  expect_no_older_step(o.logs.controller);
  const ControllerRows& rows = o.logs.controller;
  const std::size_t latch = first_row(rows, 0, is_latched);
  ASSERT_LT(latch, rows.size());
  ASSERT_GT(torque_before(rows, latch), 0.02);
  const Fade fade = fade_after(rows, latch);
  EXPECT_EQ(fade.zero, latch);
  EXPECT_LT(fade.active_age, kLatchAge);
  EXPECT_EQ(rows[latch].fault, "step_too_old");
  ASSERT_EQ(o.faults.size(), 1U);
  expect_fresh_start_after(rows, latch, 400);
  EXPECT_EQ(o.host_exit, 0) << o.host_output;
  print_row("host stalled 50 ms (SIGSTOP)",
            "controller at zero by 20 ms from its last fresh step; no burst afterwards",
            fmt::format("from {:.0f} mNm to zero at {:.0f} ms of age; controller `step_too_old`, host `{}`; "
                        "no torque until "
                        "reset, then a ramp of 1 s",
                        1e3 * torque_before(rows, latch), ms(fade.zero_age), o.faults.front()));
}

void freeze_host(TwoProcesses& both) { both.host().signal(SIGSTOP); }
void kill_host(TwoProcesses& both) { both.host().signal(SIGKILL); }

/// The host spoke no more from some moment of contact on.
void expect_zero_torque_for_good(const Outcome& o, const std::string& fault) {
  expect_sane(o);
  const ControllerRows& rows = o.logs.controller;
  const std::size_t latch = first_row(rows, 0, is_latched);
  ASSERT_LT(latch, rows.size());
  ASSERT_GT(torque_before(rows, latch), 0.02);
  const Fade fade = fade_after(rows, latch);
  EXPECT_EQ(fade.zero, latch);
  EXPECT_LT(fade.active_age, kLatchAge);
  for (std::size_t i = latch; i < rows.size(); ++i)
    ASSERT_EQ(rows[i].largest, 0.0) << "tick " << rows[i].tick;
  EXPECT_EQ(o.host_exit, 128 + SIGKILL);
  print_row(fault, "controller at zero by 20 ms from its last fresh step",
            fmt::format(
                "from {:.0f} mNm to zero at {:.0f} ms of age; `{}`; zero for the {} ticks until the end",
                1e3 * torque_before(rows, latch), ms(fade.zero_age), rows[latch].fault, rows.size() - latch));
}

const Registered kFrozen("AFrozenHostLeavesZeroTorque", "",
                         {.events = {{2.4, freeze_host}, {3.3, kill_host}}, .seconds = 3.4});
TEST(Faults, AFrozenHostLeavesZeroTorque) {
  expect_zero_torque_for_good(outcome("AFrozenHostLeavesZeroTorque"), "host frozen mid-contact (SIGSTOP)");
}

const Registered kKilled("AKilledHostLeavesZeroTorque", "", {.events = {{2.4, kill_host}}, .seconds = 3.4});
TEST(Faults, AKilledHostLeavesZeroTorque) {
  expect_zero_torque_for_good(outcome("AKilledHostLeavesZeroTorque"), "host killed mid-contact (SIGKILL)");
}

constexpr const char* kGloveTest = "AGloveHoldsTheFingerOfAHostThatIsGoneUntilItsFirmwareLetsGo";
constexpr double kGone = 2.8;      ///< when the host is frozen or killed [s]
constexpr double kWatchdog = 0.2;  ///< of the firmware that has one [s]
const std::vector<std::string> kStated = {"--watchdog-ms", "200"};
Scenario with_glove(bool watchdog, void (*end)(TwoProcesses&)) {
  return {.host = watchdog ? kStated : std::vector<std::string>{},
          .glove_watchdog_ms = watchdog ? "200" : "0",
          .events = {{kGone, end}, {3.8, kill_host}},
          .seconds = 3.9};
}
const Registered kFrozenHolds(kGloveTest, "frozen", with_glove(false, freeze_host));
const Registered kKilledHolds(kGloveTest, "killed", with_glove(false, kill_host));
const Registered kFrozenLetsGo(kGloveTest, "frozen, watchdog", with_glove(true, freeze_host));
const Registered kKilledLetsGo(kGloveTest, "killed, watchdog", with_glove(true, kill_host));
TEST(Faults, AGloveHoldsTheFingerOfAHostThatIsGoneUntilItsFirmwareLetsGo) {
  constexpr double kLoops = 0.025;  // two of the firmware's, and what the test reads late [s]
  for (const std::string how : {"frozen", "killed"}) {
    SCOPED_TRACE(how);
    const std::vector<GloveRow>& holds = outcome(kGloveTest, how).logs.glove;
    const std::vector<GloveRow>& lets_go = outcome(kGloveTest, how + ", watchdog").logs.glove;
    constexpr const char* kTold = "this device has no watchdog";
    EXPECT_NE(outcome(kGloveTest, how).host_errors.find(kTold), std::string::npos);
    EXPECT_EQ(outcome(kGloveTest, how + ", watchdog").host_errors.find(kTold), std::string::npos);
    ASSERT_FALSE(holds.empty());
    ASSERT_FALSE(lets_go.empty());
    ASSERT_GT(holds.back().time, kGone + 0.9);
    ASSERT_GT(lets_go.back().time, kGone + 0.9);
    ASSERT_NE(holds.back().held, "A0B0C0D0E0") << "it held nothing";
    for (const GloveRow& row : holds)
      EXPECT_TRUE(row.time <= kGone + kLoops || row.held == holds.back().held) << row.time;
    for (const GloveRow& row : lets_go) {
      const bool before = row.time > kGone + kLoops && row.time < kGone + kWatchdog - kLoops;
      const bool after = row.time > kGone + kWatchdog + kLoops;
      EXPECT_TRUE(!before || row.held == holds.back().held) << row.time << ": " << row.held;
      EXPECT_TRUE(!after || row.held == "A0B0C0D0E0") << row.time << ": " << row.held;
    }
    print_row(
        fmt::format("glove's host {} mid-contact", how),
        "without a watchdog in its firmware it is refused for a patient's session",
        fmt::format("the stops {} held for the {:.1f} s until the end; with a watchdog of {:.0f} ms let go "
                    "in that time",
                    holds.back().held, holds.back().time - kGone, 1e3 * kWatchdog));
  }
}

constexpr const char* kPatientTest = "AGloveServesAPatientOnlyIfItsFirmwareIsSaidToLetGo";
const Registered kRefusedPatient(kPatientTest, "no watchdog",
                                 {.host = {"--profile", "small-woman"},
                                  .glove_watchdog_ms = "0",
                                  .seconds = 1.5});
const Registered kServedPatient(kPatientTest, "watchdog",
                                {.host = {"--profile", "small-woman", kStated[0], kStated[1]},
                                 .glove_watchdog_ms = "200",
                                 .seconds = 1.5});
TEST(Faults, AGloveServesAPatientOnlyIfItsFirmwareIsSaidToLetGo) {
  const Outcome& refused = outcome(kPatientTest, "no watchdog");
  EXPECT_EQ(refused.host_exit, 2);
  EXPECT_NE(refused.host_errors.find("hand.profile = small-woman: a patient's session"), std::string::npos)
      << refused.host_errors;
  EXPECT_EQ(std::count(refused.host_errors.begin(), refused.host_errors.end(), '\n'), 1);
  const Outcome& served = outcome(kPatientTest, "watchdog");
  EXPECT_EQ(served.host_exit, 0) << served.host_output << served.host_errors;
}

void second_host(TwoProcesses& both) {
  const auto second = both.start(
      {program(), "run", "grasp_teapot", "--device", both.address(), "--headless", "--no-realtime"},
      "second.txt");
  const auto exit = both.wait_for(*second);
  both.outcome().notes = {exit ? std::to_string(*exit) : "still running", second->errors()};
}

const Registered kSecond("ASecondHostIsRefused", "", {.events = {{1.5, second_host}}, .seconds = 4.2});
TEST(Faults, ASecondHostIsRefused) {
  const Outcome& o = outcome("ASecondHostIsRefused");
  expect_runs_on(o);
  ASSERT_EQ(o.notes.size(), 2U);
  EXPECT_EQ(o.notes[0], "1");
  EXPECT_NE(o.notes[1].find("belongs to another host"), std::string::npos) << o.notes[1];
  print_row(
      "second host tries to take the device", "refused",
      "refused: \"the device belongs to another host\", exit code 1; the first goes on without a fault");
}

}  // namespace
}  // namespace phalanx::testing

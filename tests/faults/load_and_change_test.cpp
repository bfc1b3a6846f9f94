// SPDX-License-Identifier: Apache-2.0
// Steps that end too late, and changes while the patient feels the object.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "faults/fault_suite.h"
#include "faults/reactions.h"

namespace phalanx::testing {
namespace {

/// The loop wakes up so much too late from here on [s].
Event delay_loop_at(double at, double seconds) {
  return {at, [seconds](TwoProcesses& both) { both.delay_loop(seconds); }};
}

// First a short overload, which is shown and goes by, then one that lasts.
const Registered kOverload("AnOverloadIsShownAndThenStops", "",
                           {.events = {delay_loop_at(1.9, 0.008), delay_loop_at(1.94, 0.0),
                                       delay_loop_at(3.2, 0.008), delay_loop_at(3.6, 0.0)},
                            .seconds = 4.0});
TEST(Faults, AnOverloadIsShownAndThenStops) {
  const Outcome& o = outcome("AnOverloadIsShownAndThenStops");
  expect_sane(o);
  const HostRows& rows = o.logs.host;
  const std::size_t first = first_row(rows, 0, [](const HostRow& row) { return row.overrun; });
  const std::size_t fault = first_row(rows, 0, in_fault);
  ASSERT_LT(fault, rows.size());
  EXPECT_LT(first + 20, fault) << "the short overload was a fault already";
  EXPECT_GT(rows[fault - 1].largest, 0.02);
  EXPECT_EQ(rows[fault].fault, "overload");
  std::size_t in_a_row = 0;
  while (in_a_row < fault && rows[fault - in_a_row].overrun) ++in_a_row;
  EXPECT_EQ(in_a_row, 10U);
  EXPECT_EQ(o.faults, std::vector<std::string>{"overload"});
  EXPECT_NE(o.host_output.find("DEGRADED"), std::string::npos) << o.host_output;
  const auto overruns = nlohmann::json::parse(o.summary).at("overruns").get<std::uint64_t>();
  EXPECT_GE(overruns, 10U);
  EXPECT_EQ(o.host_exit, 1);
  print_row("overload: the loop wakes up 8 ms late at 200 Hz",
            "overruns counted, degraded shown, stop after 10 in a row",
            fmt::format("{} overruns counted; DEGRADED shown; `{}` after {} in a row at {:.0f} mNm", overruns,
                        rows[fault].fault, in_a_row, 1e3 * rows[fault - 1].largest));
}

/// Largest change of a joint's torque from a step to the next, as commanded and as applied.
double largest_step(const HostRows& rows) {
  double largest = 0.0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < rows[i].torque.size(); ++j)
      largest = std::max(largest, std::abs(rows[i].torque[j] - rows[i - 1].torque[j]));
  }
  return largest;
}
double fastest_change(const ControllerRows& rows) {
  double fastest = 0.0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (rows[i].state == "fading" || rows[i - 1].state == "fading") continue;
    const double period = 1e-6 * static_cast<double>(rows[i].time_us - rows[i - 1].time_us);
    for (std::size_t j = 0; j < rows[i].torque.size(); ++j)
      fastest = std::max(fastest, (std::abs(rows[i].torque[j] - rows[i - 1].torque[j]) - kFloat) / period);
  }
  return fastest;
}

void expect_gentle(const Outcome& o, const std::string& what) {
  expect_runs_on(o);
  const double step = largest_step(o.logs.host);
  const double rate = fastest_change(o.logs.controller);
  EXPECT_LE(step, kTorqueRate * kHostPeriod * (1.0 + 1e-9));
  EXPECT_LE(rate, kTorqueRate);
  print_row(what, "no torque step beyond the rate limit",
            fmt::format("no fault; largest change of a host step {:.1f} mNm (limit {:.0f}), fastest change "
                        "applied {:.1f} Nm/s "
                        "(limit {:.0f})",
                        1e3 * step, 1e3 * kTorqueRate * kHostPeriod, rate, kTorqueRate));
}

const Registered kStiffness("StiffnessChangesInContactWithoutAStep", "",
                            {.events = {type_at(2.4, "set force.stiffness_n_per_mm=1.2")}, .seconds = 4.2});
TEST(Faults, StiffnessChangesInContactWithoutAStep) {
  const Outcome& o = outcome("StiffnessChangesInContactWithoutAStep");
  EXPECT_NE(o.host_output.find("changed: force.stiffness"), std::string::npos) << o.host_errors;
  ASSERT_FALSE(o.logs.host.empty());
  EXPECT_DOUBLE_EQ(o.logs.host.back().stiffness, 1200.0);
  EXPECT_NE(o.logs.host.front().stiffness, 1200.0);
  expect_gentle(o, "stiffness changed in contact");
}

// A stiff wall without smoothing shakes the simulated finger. The first time the force fades and comes back,
// the second time it stays away.
const Registered kOscillation(
    "AnOscillationFadesTheForceAndTheNextOneStopsTheHost", "",
    {.both = {"--set", "stabiliser.method=none", "--set", "force.stiffness_n_per_mm=2.2"}, .seconds = 8.0});
TEST(Faults, AnOscillationFadesTheForceAndTheNextOneStopsTheHost) {
  const Outcome& o = outcome("AnOscillationFadesTheForceAndTheNextOneStopsTheHost");
  expect_sane(o);
  const HostRows& rows = o.logs.host;
  const auto is = [](const char* state) {
    return [state](const HostRow& row) { return row.state == state; };
  };
  const auto at_zero = [](const HostRow& row) { return row.largest == 0.0; };
  const auto largest_of = [](HostRows::const_iterator from, HostRows::const_iterator to) {
    double largest = 0.0;
    for (; from != to; ++from) largest = std::max(largest, from->largest);
    return largest;
  };
  const std::size_t seen = first_row(rows, 0, is("stopping"));
  const std::size_t zero = first_row(rows, seen, at_zero);
  const std::size_t back = first_row(rows, zero, is("starting"));
  const std::size_t fault = first_row(rows, 0, in_fault);
  ASSERT_LT(fault, rows.size());
  ASSERT_LT(back, fault) << "it did not fade first";
  ASSERT_GT(seen, 100U);
  const auto row = [&](std::size_t i) { return rows.begin() + static_cast<std::ptrdiff_t>(i); };
  const double first = largest_of(row(seen - 100), row(seen));
  EXPECT_GT(first, 0.02);
  EXPECT_LE(static_cast<double>(zero - seen) * kHostPeriod, 0.2 + 1e-9);
  EXPECT_EQ(largest_of(row(zero), row(back)), 0.0) << "torque while the force still oscillates";
  EXPECT_EQ(rows[fault].fault, "oscillation");
  EXPECT_NE(o.host_output.find("the force oscillates: it fades"), std::string::npos) << o.host_output;
  EXPECT_LE(static_cast<double>(fault - back) * kHostPeriod, 10.0);
  EXPECT_EQ(largest_of(row(fault + 1), rows.end()), 0.0);
  EXPECT_EQ(o.faults, std::vector<std::string>{"oscillation"});
  EXPECT_EQ(o.host_exit, 1);
  print_row(
      "oscillation: 2.2 N/mm without smoothing",
      "the force fades within 200 ms; fault if it comes back within 10 s",
      fmt::format(
          "from {:.0f} mNm to zero {:.0f} ms after the observer fired, no fault; back after {:.1f} s, "
          "`oscillation` {:.1f} s later at {:.0f} mNm",
          1e3 * first, 1e3 * kHostPeriod * static_cast<double>(zero - seen),
          kHostPeriod * static_cast<double>(back - zero), kHostPeriod * static_cast<double>(fault - back),
          1e3 * largest_of(row(fault - 100), row(fault))));
}

// The patient's hand is in the new object when it appears: it is felt from the next squeeze on, at 6.3 s.
const Registered kSwap("AnObjectIsSwappedWithoutAStep", "",
                       {.events = {type_at(2.0, "set objects.0.size_mm=125")}, .seconds = 7.6});
TEST(Faults, AnObjectIsSwappedWithoutAStep) {
  const Outcome& o = outcome("AnObjectIsSwappedWithoutAStep");
  EXPECT_NE(o.host_output.find("changed: objects"), std::string::npos) << o.host_errors;
  expect_gentle(o, "object swapped in contact");
  const ControllerRows& rows = o.logs.controller;
  const auto is = [](const char* state) {
    return [state](const ControllerRow& row) { return row.state == state; };
  };
  const std::size_t down = first_row(rows, row_at(rows, 2.0), is("ready"));
  const std::size_t up = first_row(rows, down, is("starting"));
  ASSERT_LT(up, rows.size()) << "no start after the swap";
  EXPECT_LE(up - down, 100U) << "ticks until the controller takes commands for the new object";
  EXPECT_LT(first_row(rows, up, at_work), rows.size()) << "no torque after the swap";
}

}  // namespace
}  // namespace phalanx::testing

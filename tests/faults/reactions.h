// SPDX-License-Identifier: Apache-2.0
// What the tests ask of a scenario's logs. Reactions are counted in the controller's ticks or told by its
// clock.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "faults/two_processes.h"

namespace phalanx::testing {

inline constexpr double kTorqueLimit = 0.5;       ///< limits.joint_torque_nm, default [Nm]
inline constexpr double kTorqueRate = 10.0;       ///< limits.torque_rate_nm_per_s, default [Nm/s]
inline constexpr double kHostPeriod = 0.005;      ///< of the scene grasp_teapot [s]
inline constexpr std::int64_t kLatchAge = 20000;  ///< PHX_LATCH_AGE_US
inline constexpr double kFloat = 1e-6;            ///< the wire has 32-bit floats: of up to 0.5 Nm [Nm]

using ControllerRows = std::vector<ControllerRow>;
using HostRows = std::vector<HostRow>;

inline bool at_work(const ControllerRow& row) { return row.largest > 0.02; }
inline bool is_latched(const ControllerRow& row) { return row.state == "latched"; }
inline bool in_fault(const HostRow& row) { return row.state == "fault"; }

/// Index of the controller's first row at or after a time of its process [s]; before any restart only.
inline std::size_t row_at(const ControllerRows& rows, double time) {
  return first_row(rows, 0, [&](const ControllerRow& row) {
    return 1e-6 * static_cast<double>(row.time_us) >= time - 1e-9;
  });
}

/// Index of the controller's first row after the sample of this time [us].
inline std::size_t row_after_sample(const ControllerRows& rows, std::int64_t time_us) {
  return first_row(rows, 0, [&](const ControllerRow& row) { return row.time_us > time_us; });
}

/// The largest torque in the 50 ticks before a row [Nm]: a fault without contact would prove nothing.
inline double torque_before(const ControllerRows& rows, std::size_t i) {
  double largest = 0.0;
  for (std::size_t k = i > 50 ? i - 50 : 0; k < i && k < rows.size(); ++k)
    largest = std::max(largest, rows[k].largest);
  return largest;
}

/// Finite, within limit, on both sides; and whatever happens, no torque from a step of 20 ms or more.
inline void expect_sane(const Outcome& outcome) {
  ASSERT_FALSE(outcome.logs.controller.empty());
  for (const ControllerRow& row : outcome.logs.controller) {
    ASSERT_TRUE(std::isfinite(row.largest)) << "tick " << row.tick;
    ASSERT_LE(row.largest, kTorqueLimit + kFloat) << "tick " << row.tick;
    if (row.age_us >= kLatchAge) {
      ASSERT_EQ(row.largest, 0.0) << "tick " << row.tick;
    }
  }
  for (const HostRow& row : outcome.logs.host) {
    ASSERT_TRUE(std::isfinite(row.largest)) << "step " << row.tick;
    ASSERT_LE(row.largest, kTorqueLimit) << "step " << row.tick;
  }
}

/// No step that is older than one before it is ever acted on, within a session.
inline void expect_no_older_step(const ControllerRows& rows) {
  std::uint64_t newest = 0;
  for (const ControllerRow& row : rows) {
    if (row.state == "no_session") newest = 0;
    if (row.acted_tick == 0) continue;
    ASSERT_GE(row.acted_tick, newest) << "tick " << row.tick;
    newest = row.acted_tick;
  }
}

/// It ran to the end without a fault on either side, and there was something to feel.
inline void expect_runs_on(const Outcome& outcome) {
  expect_sane(outcome);
  expect_no_older_step(outcome.logs.controller);
  EXPECT_EQ(outcome.host_exit, 0) << outcome.host_output << outcome.host_errors;
  EXPECT_EQ(outcome.controller_exit, 0) << outcome.controller_errors;
  EXPECT_TRUE(outcome.faults.empty()) << outcome.faults.front();
  EXPECT_EQ(first_row(outcome.logs.controller, 0, is_latched), outcome.logs.controller.size());
  EXPECT_GT(std::count_if(outcome.logs.controller.begin(), outcome.logs.controller.end(), at_work), 1000);
}

/// After the fault in row `fault`: zero torque until a start that somebody asked for more than `least` ticks
/// later, then a ramp of 1 s from zero, then torque again.
inline void expect_fresh_start_after(const ControllerRows& rows, std::size_t fault, std::size_t least) {
  ASSERT_LT(fault, rows.size());
  const std::size_t zero =
      first_row(rows, fault, [](const ControllerRow& row) { return row.largest == 0.0; });
  const std::size_t start =
      first_row(rows, zero, [](const ControllerRow& row) { return row.state == "starting"; });
  ASSERT_LT(start, rows.size()) << "it never starts again";
  ASSERT_GT(start - zero, least) << "it starts again before the reset";
  for (std::size_t i = zero; i < start; ++i) ASSERT_EQ(rows[i].largest, 0.0) << "tick " << rows[i].tick;
  for (std::size_t i = start; i < rows.size() && rows[i].state == "starting"; ++i) {
    // The command that starts the ramp may come in up to a tick before the first row that says so.
    const double since = 1e-6 * static_cast<double>(rows[i].time_us - rows[start].time_us) + 1.5e-3;
    ASSERT_LE(rows[i].factor, since) << "tick " << rows[i].tick;
    ASSERT_LE(rows[i].largest, since * kTorqueLimit + kFloat) << "tick " << rows[i].tick;
  }
  EXPECT_LT(first_row(rows, start, at_work), rows.size()) << "no torque after the reset";
}

/// How the step acted on aged until the torque was zero, from row `from` on.
struct Fade {
  std::size_t zero = 0;         ///< row of the first zero torque
  std::int64_t zero_age = 0;    ///< age of the step there [us]
  std::int64_t active_age = 0;  ///< age at the last torque that was not zero [us]
};
inline Fade fade_after(const ControllerRows& rows, std::size_t from) {
  Fade fade;
  fade.zero = first_row(rows, from, [](const ControllerRow& row) { return row.largest == 0.0; });
  if (fade.zero >= rows.size() || fade.zero == 0) return fade;
  fade.zero_age = rows[fade.zero].age_us;
  fade.active_age = rows[fade.zero - 1].age_us;
  return fade;
}

}  // namespace phalanx::testing

// SPDX-License-Identifier: Apache-2.0
// The checks of the conformance test, one a row. Each begins with a session of its own, if it needs one.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <utility>

#include "device/conform/conform_row.h"
#include "phalanx/device/link/phalanx_link.h"

namespace phalanx {

template <typename... Args>
ConformFinding conform_if(bool passes, fmt::format_string<Args...> text, Args&&... args) {
  return {passes ? ConformOutcome::kPass : ConformOutcome::kFail,
          fmt::format(text, std::forward<Args>(args)...)};
}
inline ConformFinding not_applicable(std::string reason) {
  return {ConformOutcome::kNotApplicable, std::move(reason)};
}

/// @returns true if a command acts.
inline bool conform_acts(const phx_sample& sample) {
  return sample.state == PHX_STATE_STARTING || sample.state == PHX_STATE_ACTIVE;
}
/// @returns the age of a step at a sample [us].
inline std::int64_t conform_age(const phx_sample& sample, std::uint64_t step_us) {
  return static_cast<std::int64_t>(sample.time_us - step_us);
}
inline double in_ms(std::int64_t us) { return 1e-3 * static_cast<double>(us); }

// conform_device_checks.cpp
ConformFinding check_ping(ConformHost& host);
ConformFinding check_hello(ConformHost& host);
ConformFinding check_descriptor(ConformHost& host);
ConformFinding check_channels(ConformHost& host);
ConformFinding check_resolution(ConformHost& host);
ConformFinding check_rate(ConformHost& host);
ConformFinding check_jitter(ConformHost& host);
ConformFinding check_sequence(ConformHost& host);
ConformFinding check_clock(ConformHost& host);
ConformFinding check_samples(ConformHost& host);

// conform_frame_checks.cpp
ConformFinding check_crc(ConformHost& host);
ConformFinding check_truncated(ConformHost& host);
ConformFinding check_oversize(ConformHost& host);
ConformFinding check_unknown_type(ConformHost& host);
ConformFinding check_reserved_bits(ConformHost& host);
ConformFinding check_own_frames(ConformHost& host);
ConformFinding check_not_finite(ConformHost& host);
ConformFinding check_invalid_values(ConformHost& host);
ConformFinding check_version_hello(ConformHost& host);
ConformFinding check_version_frames(ConformHost& host);
ConformFinding check_random(ConformHost& host);
ConformFinding check_bytewise(ConformHost& host);
ConformFinding check_resync(ConformHost& host);

// conform_session_checks.cpp
ConformFinding check_second_host(ConformHost& host);
ConformFinding check_repeated_hello(ConformHost& host);
ConformFinding check_new_session(ConformHost& host);
ConformFinding check_old_epoch(ConformHost& host);
ConformFinding check_goodbye(ConformHost& host);
ConformFinding check_silence(ConformHost& host);
ConformFinding check_reconnect(ConformHost& host);
ConformFinding check_hands(ConformHost& host);
ConformFinding check_power_cycle(ConformHost& host);

// conform_command_checks.cpp
ConformFinding check_unconfigured(ConformHost& host);
ConformFinding check_enable(ConformHost& host);
ConformFinding check_disable(ConformHost& host);
ConformFinding check_stop(ConformHost& host);
ConformFinding check_watchdog(ConformHost& host);
ConformFinding check_repetition(ConformHost& host);
ConformFinding check_latch(ConformHost& host);
ConformFinding check_reset(ConformHost& host);

// conform_step_checks.cpp
ConformFinding check_stale(ConformHost& host);
ConformFinding check_future(ConformHost& host);
ConformFinding check_older_tick(ConformHost& host);
ConformFinding check_replay(ConformHost& host);
ConformFinding check_walls(ConformHost& host);
ConformFinding check_torque_limit(ConformHost& host);
ConformFinding check_torque_off(ConformHost& host);
ConformFinding check_flood(ConformHost& host);

}  // namespace phalanx

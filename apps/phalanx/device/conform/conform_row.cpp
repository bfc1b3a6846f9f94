// SPDX-License-Identifier: Apache-2.0
#include "device/conform/conform_row.h"

#include <fmt/format.h>

#include <array>

#include "device/conform/conform_checks.h"

namespace phalanx {
namespace {

constexpr std::array kRows{
    // ---- who is there ----
    ConformRow{"ping", "PING, PONG", "PING is answered, with or without a session", "20 PINGs, 10 ms apart",
               "each PONG within 10 ms, with its stamp, its sequence, epoch 0 and a clock that increases",
               check_ping},
    ConformRow{"hello", "The session", "HELLO is answered by WELCOME with a new epoch", "HELLO, every 100 ms",
               "WELCOME within 100 ms, with host_id and sequence of its HELLO; the epoch is not 0",
               check_hello},
    ConformRow{"descriptor", "WELCOME", "the device states serial number, rate and channels", "WELCOME",
               "a printable serial number and at least one channel", check_descriptor},
    ConformRow{"channels", "WELCOME", "each quantity has one channel; ranges of joints are plausible",
               "WELCOME", "no kind and index twice; the counts of an ANGLE channel span 0.1 to 12.6 rad",
               check_channels},
    ConformRow{"resolution", "WELCOME",
               "the counts suffice for a calibration, which needs 50 between two positions", "WELCOME",
               "at least 100 counts from raw_min to raw_max of each ANGLE channel", check_resolution},
    // ---- how it samples ----
    ConformRow{"rate", "WELCOME", "samples come at rate_hz", "a session at rest for 1 s",
               "within 2 % by the device's clock, 5 % by the host's", check_rate},
    ConformRow{"jitter", "SAMPLE", "ticks are regular", "a session at rest for 1 s",
               "99 % of the intervals of time_us within half a period of the period", check_jitter},
    ConformRow{"sequence", "A frame", "samples are numbered one by one", "a session at rest for 1 s",
               "each number one above the last; a gap only with a gap in time_us; at most 1 % lost",
               check_sequence},
    ConformRow{"clock", "SAMPLE", "time_us increases, with the speed of time", "a session at rest for 1 s",
               "each time above the last; speed within 2 % of the host's clock", check_clock},
    ConformRow{"samples", "SAMPLE", "a device at rest is READY, its sensors are in their ranges",
               "a session at rest for 1 s",
               "state READY, no fault, no step acted on; counts in their ranges, 0 for channels that it does "
               "not have",
               check_samples},
    // ---- frames ----
    ConformRow{"crc", "A frame", "a frame with a wrong CRC is dropped and counted",
               "50 commands with one flipped bit, beside good ones",
               "50 counted as corrupt; only good commands act", check_crc},
    ConformRow{"truncated", "A frame", "an incomplete frame is dropped and counted",
               "commands cut to 12 lengths, with and without a CRC for that length",
               "all counted as corrupt; only good commands act", check_truncated},
    ConformRow{"oversize", "The wires", "a frame of another size than its type's is dropped",
               "commands of 118 to 1024 bytes with a right CRC; 2 frames of 1025 and 1400 bytes",
               "those up to 1024 bytes counted as corrupt; the commands act on", check_oversize},
    ConformRow{"unknown_type", "A frame", "a frame of an unknown type is dropped and counted",
               "types 0, 12, 13, 99, 255", "5 counted as corrupt", check_unknown_type},
    ConformRow{"reserved_bits", "A frame", "a command with a flag in its header is dropped and counted",
               "16 commands, each with one bit of the header's flags", "16 counted as corrupt",
               check_reserved_bits},
    ConformRow{"own_frames", "The session", "a controller's own frame is dropped and counted",
               "WELCOME, SAMPLE, REFUSED, PONG, sent to it", "4 counted as corrupt", check_own_frames},
    ConformRow{"not_finite", "A frame", "a number that is not finite is refused",
               "commands and CONFIGURE with NaN and infinity", "15 counted as corrupt; none acts",
               check_not_finite},
    ConformRow{"invalid_values", "CONFIGURE", "negative limits and walls are refused",
               "CONFIGURE and COMMAND_WALLS with negative values", "4 counted as corrupt; none acts",
               check_invalid_values},
    ConformRow{"version_hello", "A frame", "a HELLO of another version is answered with REFUSED",
               "HELLO of version 2 from another host",
               "REFUSED with reason 2 and version 1; the session goes on", check_version_hello},
    ConformRow{"version_frames", "A frame", "other frames of another version are dropped and counted",
               "commands of versions 0, 2 and 255", "3 counted as corrupt", check_version_frames},
    ConformRow{"random", "A frame", "random bytes have no effect", "100 frames of 1 to 300 random bytes",
               "100 counted as corrupt; the commands act on", check_random},
    ConformRow{"bytewise", "The wires", "a frame may come byte by byte (serial)",
               "PING with 1 ms between its bytes; two PINGs in one piece", "each answered", check_bytewise},
    ConformRow{"resync", "The wires", "the receiver continues after each zero byte (serial)",
               "PING after zeros, after half a frame, after 1500 bytes without a zero", "each answered",
               check_resync},
    // ---- sessions ----
    ConformRow{"second_host", "The session", "a second host is refused",
               "HELLO of another host during a session", "REFUSED (busy) to it; the session goes on",
               check_second_host},
    ConformRow{"repeated_hello", "The session", "a copy of a HELLO changes nothing",
               "the HELLO of the session again, and one with the sequence before",
               "the same WELCOME; still configured", check_repeated_hello},
    ConformRow{"new_session", "The session", "a later HELLO opens a new session",
               "HELLO of the same host while commands act", "another epoch; READY, not configured, no step",
               check_new_session},
    ConformRow{"old_epoch", "The session", "commands of an earlier session are refused",
               "5 commands with the epoch before", "5 counted as refused; none acts", check_old_epoch},
    ConformRow{"goodbye", "The session", "GOODBYE ends the session",
               "GOODBYE while commands act, then a command",
               "no more samples; the command counted as refused; no fault", check_goodbye},
    ConformRow{"silence", "The session", "1 s without a frame of its host ends the session",
               "no frame for 1.3 s, nothing enabled", "the last sample after 0.9 to 1.1 s; no fault",
               check_silence},
    ConformRow{"reconnect", "The session", "then another host gets a session, and the first one again",
               "HELLO of another host after 1.2 s; GOODBYE; HELLO of the first",
               "WELCOME to both, of the same device", check_reconnect},
    // ---- commands ----
    ConformRow{"unconfigured", "The session", "a command before CONFIGURE has no effect",
               "30 enabled commands", "READY, no step acted on", check_unconfigured},
    ConformRow{"enable", "One tick", "an enabled command starts the ramp of 1 s",
               "enabled commands for 1.2 s",
               "STARTING, then ACTIVE after 1 s +- 50 ms; the factor never above the ramp", check_enable},
    ConformRow{"disable", "States", "a command without ENABLE ends the torque", "commands without ENABLE",
               "READY within 5 ms, two periods and a round trip; no fault", check_disable},
    ConformRow{"stop", "COMMAND", "the flag FAULT ends the torque, for any ENABLE", "commands with FAULT",
               "READY within 5 ms, two periods and a round trip; no fault", check_stop},
    ConformRow{"watchdog", "Ages", "without commands the torque is zero at 20 ms of age, and latched",
               "the commands stop", "never latched before 20 ms, always from 20 ms on, factor 0, fault 1",
               check_watchdog},
    ConformRow{"repetition", "Ages", "a repetition does not renew a step", "one command repeated for 50 ms",
               "as in `watchdog`", check_repetition},
    ConformRow{"latch", "States", "only RESET clears a latch", "50 enabled commands and a new session",
               "latched, factor 0", check_latch},
    ConformRow{"reset", "States", "RESET clears a latch; a step from before it does not act",
               "RESET, then a command from a sample before it, then enabled commands",
               "READY, no fault; 1 counted as outdated; a new ramp", check_reset},
    ConformRow{"stale", "Ages", "a step older than 20 ms is not used", "5 new steps from samples 22 ms old",
               "5 counted as outdated; none acts", check_stale},
    ConformRow{"future", "Ages", "a step from a sample of the future is not used",
               "5 steps from samples of the next second", "5 counted as corrupt; none acts", check_future},
    ConformRow{"older_tick", "Ages", "a step with an older tick is not used",
               "5 steps with a tick 50 below the newest", "5 counted as outdated; none acts",
               check_older_tick},
    ConformRow{"replay", "Ages", "recorded commands have no effect", "10 commands, sent again later",
               "10 counted as outdated; the step acted on never becomes older", check_replay},
    ConformRow{"walls", "COMMAND_WALLS", "a command with local walls acts",
               "30 steps with walls of no stiffness", "the newest acts", check_walls},
    ConformRow{"torque_limit", "One tick", "the limit of CONFIGURE holds (TORQUE channel)",
               "twice the limit commanded, within the torque of this test",
               "at most 1.25 times the limit and a tolerance", check_torque_limit},
    ConformRow{"torque_off", "COMMAND", "the measured torque goes to zero (TORQUE channel)",
               "commands with FAULT", "within the tolerance 20 ms after the message", check_torque_off},
    ConformRow{"flood", "Firmware with the reference", "other frames do not delay a tick or a command",
               "up to 5 more frames a command for 0.3 s, from another sender",
               "no interval of samples above 5 periods; the commands act on", check_flood},
    ConformRow{"hands", "States", "emergency stop, open sensor and drive fault latch", "by hand",
               "see docs/conform.md", check_hands},
    ConformRow{"power_cycle", "The session", "the first epoch differs from start to start", "by hand",
               "see docs/conform.md", check_power_cycle},
};

}  // namespace

std::span<const ConformRow> conform_rows() { return kRows; }

std::string conform_table() {
  std::string text =
      "| row | requirement | stimulus | expected | in link.md |\n| --- | --- | --- | --- | --- |\n";
  for (const ConformRow& row : kRows)
    text += fmt::format("| `{}` | {} | {} | {} | {} |\n", row.id, row.requirement, row.stimulus, row.expected,
                        row.section);
  return text;
}

}  // namespace phalanx

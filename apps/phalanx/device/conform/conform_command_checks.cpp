// SPDX-License-Identifier: Apache-2.0
// Commands: when they act, and when they no longer do.
#include <algorithm>
#include <cmath>

#include "device/conform/conform_checks.h"
#include "device/conform/conform_host.h"

namespace phalanx {
namespace {

constexpr double kRamp = 1e-6 * PHX_START_RAMP_US;  // [s], as all times here
constexpr double kStopWithin = 1e-6 * PHX_STOP_RAMP_US;

/// Judges the samples after the last step, whose sample had the time `step_us`.
ConformFinding judge_ageing(const ConformHost& host, std::uint64_t step_us, double sent) {
  std::int64_t fading = -1;
  std::int64_t latched = -1;
  double latched_at = 0.0;
  for (const HeardFrame& heard : host.samples()) {
    const phx_sample& sample = heard.message.as.sample;
    const std::int64_t age = conform_age(sample, step_us);
    const bool is_latched = sample.state == PHX_STATE_LATCHED;
    if (sample.state == PHX_STATE_FADING && fading < 0) fading = age;
    if (is_latched && latched < 0) latched = age, latched_at = heard.at;
    if (age >= PHX_LATCH_AGE_US && (!is_latched || sample.factor != 0.0F))
      return conform_if(false,
                        "at an age of {:.1f} ms: state {}, factor {:.2f}; it must be latched from 20 ms on",
                        in_ms(age), sample.state, sample.factor);
    if (is_latched && sample.fault != PHX_FAULT_STEP_TOO_OLD)
      return conform_if(false, "latched for fault {}, not STEP_TOO_OLD", sample.fault);
    if (is_latched && age < PHX_LATCH_AGE_US)
      return conform_if(false, "latched at an age of {:.1f} ms; steps act for 20 ms", in_ms(age));
  }
  if (latched < 0) return conform_if(false, "it did not latch");
  return conform_if(
      true, "{}latched at an age of {:.1f} ms, {:.1f} ms after the last command by this computer's clock",
      fading >= 0 ? fmt::format("fading at {:.1f} ms, ", in_ms(fading)) : std::string(), in_ms(latched),
      1e3 * (latched_at - sent));
}

/// Opens a session and lets its steps grow old.
void latch_by_age(ConformHost& host) {
  host.open();
  host.enable();
  host.pass(0.05);
  host.be_quiet();
  host.pass(0.03 + host.settling());
  if (host.newest().state != PHX_STATE_LATCHED)
    throw ConformTrouble(
        fmt::format("it did not latch when commands stopped: state {}", host.newest().state));
}

/// @returns the first sample in which no command acts, of those since forget(); null: none
const HeardFrame* first_at_rest(const ConformHost& host) {
  const auto found = std::find_if(host.samples().begin(), host.samples().end(), [](const HeardFrame& heard) {
    return heard.message.as.sample.state == PHX_STATE_READY;
  });
  return found == host.samples().end() ? nullptr : &*found;
}

/// Ends an enabled command with `flags`, and measures when the controller is READY.
ConformFinding judge_end(ConformHost& host, std::uint8_t flags) {
  host.open();
  host.enable(1.0);
  host.pass(0.2);
  host.be_quiet();
  host.forget();
  const std::uint64_t before_us = host.newest().time_us;
  for (int i = 0; i < 20; ++i) {
    host.send(host.command(flags));
    host.pass(host.command_period());
  }
  const HeardFrame* rest = first_at_rest(host);
  if (rest == nullptr)
    return conform_if(false, "still in state {}, fault {}", host.newest().state, host.newest().fault);
  const std::int64_t latency = conform_age(rest->message.as.sample, before_us);
  const double most = kStopWithin + 2.0 * host.period() + host.round_trip;
  return conform_if(1e-6 * static_cast<double>(latency) <= most && host.newest().fault == 0,
                    "READY at most {:.1f} ms of its clock after the message was sent; allowed {:.1f} ms",
                    in_ms(latency), 1e3 * most);
}

}  // namespace

ConformFinding check_unconfigured(ConformHost& host) {
  host.open();
  host.open_unconfigured();
  for (int i = 0; i < 30; ++i) {
    host.send(host.command(PHX_COMMAND_ENABLE));
    host.pass(host.command_period());
  }
  host.settle();
  const phx_sample& now = host.newest();
  return conform_if(
      now.state == PHX_STATE_READY && now.acted_tick == 0 && (now.flags & PHX_SAMPLE_CONFIGURED) == 0,
      "30 enabled commands: state {}, step acted on {}", now.state, now.acted_tick);
}

ConformFinding check_enable(ConformHost& host) {
  host.open();
  host.enable();
  host.pass(kRamp + 0.2);
  const HeardFrame* first = nullptr;
  double excess = 0.0;
  double full = -1.0;
  std::uint32_t oldest = 0;
  for (const HeardFrame& heard : host.samples()) {
    const phx_sample& sample = heard.message.as.sample;
    if (first == nullptr && sample.state != PHX_STATE_STARTING) continue;
    if (first == nullptr) first = &heard;
    const double since = 1e-6 * static_cast<double>(conform_age(sample, first->message.as.sample.time_us));
    if (!conform_acts(sample))
      return conform_if(false, "state {} {:.3f} s after the start, fault {}", sample.state, since,
                        sample.fault);
    oldest = std::max(oldest, sample.acted_age_us);
    excess = std::max(excess, static_cast<double>(sample.factor) - since / kRamp);
    if (sample.state == PHX_STATE_ACTIVE && full < 0.0) full = since;
  }
  if (first == nullptr) return conform_if(false, "no sample was in the state STARTING");
  const double allowed = 0.01 + 2.0 * host.period() + host.command_period();
  const bool fresh = host.last_tick() - host.newest().acted_tick <= 20;
  return conform_if(
      excess <= allowed && std::abs(full - kRamp) <= 0.05 && host.newest().factor > 0.99F && fresh,
      "ACTIVE {:.3f} s after STARTING; the factor was at most {:.3f} above the ramp; steps acted on were up "
      "to {:.1f} ms old",
      full, excess, in_ms(oldest));
}

ConformFinding check_disable(ConformHost& host) { return judge_end(host, 0); }

ConformFinding check_stop(ConformHost& host) {
  const ConformFinding alone = judge_end(host, PHX_COMMAND_FAULT);
  if (alone.outcome != ConformOutcome::kPass) return alone;
  host.open();
  host.enable();
  host.pass(0.1);
  host.be_quiet();
  for (int i = 0; i < 20; ++i) {
    host.send(host.command(PHX_COMMAND_FAULT | PHX_COMMAND_ENABLE));
    host.pass(host.command_period());
  }
  const phx_sample& now = host.newest();
  return conform_if(now.state == PHX_STATE_READY, "{}; with ENABLE, too: state {}", alone.observed,
                    now.state);
}

ConformFinding check_watchdog(ConformHost& host) {
  host.open();
  host.enable();
  host.pass(0.1);
  host.be_quiet();
  host.forget();
  const std::uint64_t step_us = host.newest().time_us;
  const double sent = host.now();
  host.send(host.command(PHX_COMMAND_ENABLE));
  host.pass(0.06 + host.settling());
  return judge_ageing(host, step_us, sent);
}

ConformFinding check_repetition(ConformHost& host) {
  host.open();
  host.enable();
  host.pass(0.1);
  host.be_quiet();
  host.forget();
  const std::uint64_t step_us = host.newest().time_us;
  const phx_message command = host.command(PHX_COMMAND_ENABLE);
  const double sent = host.now();
  while (host.now() < sent + 0.05) {
    host.send(command);
    host.pass(host.command_period());
  }
  host.settle();
  return judge_ageing(host, step_us, sent);
}

ConformFinding check_latch(ConformHost& host) {
  latch_by_age(host);
  host.forget();
  for (int i = 0; i < 50; ++i) {
    host.send(host.command(PHX_COMMAND_ENABLE));
    host.pass(host.command_period());
  }
  const auto free = [&host] {
    return std::count_if(host.samples().begin(), host.samples().end(), [](const HeardFrame& heard) {
      return heard.message.as.sample.state != PHX_STATE_LATCHED || heard.message.as.sample.factor != 0.0F;
    });
  };
  const auto by_commands = free();
  host.open_unconfigured();
  const auto by_session = free();
  return conform_if(by_commands == 0 && by_session == 0,
                    "50 enabled commands: {} samples not latched; a new session: {} samples not latched",
                    by_commands, by_session);
}

ConformFinding check_reset(ConformHost& host) {
  latch_by_age(host);
  phx_message old = host.command(PHX_COMMAND_ENABLE);
  const double begin = host.now();
  while (host.newest().state == PHX_STATE_LATCHED && host.now() < begin + 0.2) {
    // Before the newest sample: a device may take RESET within the tick of that sample.
    old.as.command.sample_time_us = host.newest().time_us - 1;
    host.send(host.message(PHX_RESET));
    host.pass(std::max(0.005, 2.0 * host.period()));
  }
  const double took = host.now() - begin;
  if (host.newest().state != PHX_STATE_READY || host.newest().fault != 0)
    return conform_if(false, "after RESET: state {}, fault {}", host.newest().state, host.newest().fault);
  const ConformCounts before = host.counts();
  old.as.command.tick = host.last_tick() + 1U;
  host.send(old);
  host.settle();
  const bool kept_off = host.newest().state == PHX_STATE_READY && (host.counts() - before).outdated == 1;
  host.forget();
  host.enable();
  host.pass(0.1);
  const double ramp = static_cast<double>(host.newest().factor);
  return conform_if(kept_off && ramp < 0.3,
                    "READY after {:.0f} ms; a step from before RESET {}; 0.1 s after the next start "
                    "the factor is {:.2f}",
                    1e3 * took, kept_off ? "was counted as outdated" : "acted or was not counted", ramp);
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
// Identity, and how it samples.
#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>
#include <vector>

#include "device/conform/conform_checks.h"
#include "device/conform/conform_host.h"
#include "phalanx/device/link/messages.h"

namespace phalanx {
namespace {

constexpr int kPings = 20;
constexpr double kPingPeriod = 0.01;  // [s], as all times here
constexpr double kAnswerWithin = 0.1;
constexpr double kRateFor = 1.0;
constexpr double kRateWithin = 0.02;  // a quartz has 1e-4; an RC oscillator of a microcontroller up to 0.02
constexpr double kRateByHostWithin = 0.05;
constexpr double kJitterWithin = 0.5;  // of a period, for 99 % of the intervals
constexpr double kLossWithin = 0.01;
constexpr std::int64_t kCountsOfAPosition = 50;  // phalanx device calibrate

/// Samples of kRateFor seconds in an idle session.
const std::vector<HeardFrame>& idle_samples(ConformHost& host) {
  host.open();
  host.pass(kRateFor);
  if (host.samples().size() < 3)
    throw ConformTrouble(fmt::format("{} samples came in {} s", host.samples().size(), kRateFor));
  return host.samples();
}

double seconds_between(const HeardFrame& a, const HeardFrame& b) {
  return 1e-6 * static_cast<double>(
                    static_cast<std::int64_t>(b.message.as.sample.time_us - a.message.as.sample.time_us));
}

std::uint32_t indices_of(std::uint8_t kind) {
  if (kind == PHX_CHANNEL_MOTOR) return PHX_CHANNELS;
  return kind == PHX_CHANNEL_ANGLE || kind == PHX_CHANNEL_TORQUE ? PHX_JOINTS : 5U;
}

}  // namespace

ConformFinding check_ping(ConformHost& host) {
  host.be_quiet();
  std::vector<double> trips;
  std::uint64_t last_us = 0;
  int wrong = 0;
  int backwards = 0;
  for (int i = 0; i < kPings; ++i) {
    phx_message ping = host.message(PHX_PING);
    ping.header.sequence = 700U + static_cast<std::uint32_t>(i);
    ping.as.ping.stamp = 0xC0F0000000000000U + static_cast<std::uint64_t>(i);
    host.forget();
    const double sent = host.now();
    host.send(ping);
    host.pass(kPingPeriod);
    const std::optional<HeardFrame> pong = host.answer(PHX_PONG);
    if (!pong) continue;
    const phx_message& m = pong->message;
    const bool right = m.as.ping.stamp == ping.as.ping.stamp && m.header.sequence == ping.header.sequence &&
                       m.header.epoch == 0;
    if (!right) ++wrong;
    if (m.as.ping.time_us <= last_us && !trips.empty()) ++backwards;
    last_us = m.as.ping.time_us;
    trips.push_back(pong->at - sent);
  }
  std::sort(trips.begin(), trips.end());
  host.round_trip = trips.empty() ? 0.0 : trips.back();
  const double median = trips.empty() ? 0.0 : trips[trips.size() / 2];
  return conform_if(
      trips.size() == kPings && wrong == 0 && backwards == 0,
      "{} of {} answered within 10 ms, {} of them wrong, {} with a clock that did not increase; round trip "
      "{:.2f} ms, at most {:.2f} ms",
      trips.size(), kPings, wrong, backwards, 1e3 * median, 1e3 * host.round_trip);
}

ConformFinding check_hello(ConformHost& host) {
  const double begin = host.now();
  if (!host.say_hello(2.5)) {
    const auto refused = host.answer(PHX_REFUSED);
    return conform_if(
        false, "no WELCOME within 2.5 s{}",
        refused ? fmt::format("; REFUSED with reason {}", refused->message.as.refused.reason) : "");
  }
  const double after = host.now() - begin;
  return conform_if(after <= kAnswerWithin && host.epoch() != 0, "WELCOME after {:.1f} ms, epoch {}",
                    1e3 * after, host.epoch());
}

ConformFinding check_descriptor(ConformHost& host) {
  const phx_welcome& welcome = *host.welcome();
  const std::string serial = read_serial(welcome.serial);
  const bool printable = !serial.empty() && std::all_of(serial.begin(), serial.end(),
                                                        [](char c) { return c > ' ' && c <= '~'; });
  return conform_if(printable && welcome.channel_count > 0, "serial number \"{}\", {} Hz, {} channels{}",
                    printable ? serial : "(not printable)", welcome.rate_hz, welcome.channel_count,
                    (welcome.flags & PHX_WELCOME_SIMULATED) != 0 ? ", simulated" : "");
}

ConformFinding check_channels(ConformHost& host) {
  const phx_welcome& welcome = *host.welcome();
  std::set<std::tuple<int, int>> seen;
  for (int c = 0; c < welcome.channel_count; ++c) {
    const phx_channel& channel = welcome.channel[c];
    if (channel.index >= indices_of(channel.kind))
      return conform_if(false, "channel {}: kind {} has no index {}", c, channel.kind, channel.index);
    if (!seen.emplace(channel.kind, channel.index).second)
      return conform_if(false, "channel {}: kind {} index {} is there twice", c, channel.kind, channel.index);
    const double low =
        static_cast<double>(channel.gain) * channel.raw_min + static_cast<double>(channel.offset);
    const double high =
        static_cast<double>(channel.gain) * channel.raw_max + static_cast<double>(channel.offset);
    const double width = std::abs(high - low);
    if (channel.kind == PHX_CHANNEL_ANGLE && (width < 0.1 || width > 12.6))
      return conform_if(
          false, "channel {}: its counts span {:.2f} rad, not 0.1 to 12.6: gain or range is wrong", c, width);
  }
  return conform_if(true, "{} channels, each quantity once, ranges of angles plausible", seen.size());
}

ConformFinding check_resolution(ConformHost& host) {
  const phx_welcome& welcome = *host.welcome();
  std::int64_t least = INT64_MAX;
  int worst = -1;
  for (int c = 0; c < welcome.channel_count; ++c) {
    if (welcome.channel[c].kind != PHX_CHANNEL_ANGLE) continue;
    const std::int64_t counts =
        static_cast<std::int64_t>(welcome.channel[c].raw_max) - welcome.channel[c].raw_min;
    if (counts < least) worst = c, least = counts;
  }
  if (worst < 0) return not_applicable("the device has no ANGLE channel");
  return conform_if(least >= 2 * kCountsOfAPosition, "channel {} has the fewest counts in its range: {}",
                    worst, least);
}

ConformFinding check_rate(ConformHost& host) {
  const auto& samples = idle_samples(host);
  const auto count = static_cast<double>(samples.size() - 1);
  const double promised = 1.0 / host.period();
  const double by_device = count / seconds_between(samples.front(), samples.back());
  const double by_host = count / (samples.back().at - samples.front().at);
  const bool good = std::abs(by_device / promised - 1.0) <= kRateWithin &&
                    std::abs(by_host / promised - 1.0) <= kRateByHostWithin;
  return conform_if(good, "promised {:.4g} Hz; {:.5g} Hz by its own clock, {:.5g} Hz by this computer's",
                    promised, by_device, by_host);
}

ConformFinding check_jitter(ConformHost& host) {
  const auto& samples = idle_samples(host);
  std::vector<double> off;
  for (std::size_t i = 1; i < samples.size(); ++i)
    off.push_back(std::abs(seconds_between(samples[i - 1], samples[i]) / host.period() - 1.0));
  std::sort(off.begin(), off.end());
  const double p99 = off[off.size() * 99 / 100];
  return conform_if(
      p99 <= kJitterWithin,
      "intervals differ from the period by {:.1f} % (median), {:.1f} % (p99), {:.1f} % (largest)",
      100.0 * off[off.size() / 2], 100.0 * p99, 100.0 * off.back());
}

ConformFinding check_sequence(ConformHost& host) {
  const auto& samples = idle_samples(host);
  int lost = 0;
  int wrong = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const auto step = static_cast<std::int32_t>(samples[i].message.header.sequence -
                                                samples[i - 1].message.header.sequence);
    if (step == 1) continue;
    // A lost sample leaves a gap in the times, too.
    const double periods = seconds_between(samples[i - 1], samples[i]) / host.period();
    if (step > 1 && periods > step - 0.5) {
      lost += step - 1;
    } else {
      ++wrong;
    }
  }
  const double loss = lost / static_cast<double>(samples.size());
  return conform_if(wrong == 0 && loss <= kLossWithin, "{} samples; {} wrong numbers, {} lost on the way",
                    samples.size(), wrong, lost);
}

ConformFinding check_clock(ConformHost& host) {
  const auto& samples = idle_samples(host);
  int still = 0;
  for (std::size_t i = 1; i < samples.size(); ++i)
    if (seconds_between(samples[i - 1], samples[i]) <= 0.0) ++still;
  const double speed =
      seconds_between(samples.front(), samples.back()) / (samples.back().at - samples.front().at);
  return conform_if(still == 0 && std::abs(speed - 1.0) <= kRateWithin,
                    "{} of {} times did not increase; its clock runs at {:.4f} times this computer's", still,
                    samples.size(), speed);
}

ConformFinding check_samples(ConformHost& host) {
  const auto& samples = idle_samples(host);
  const phx_welcome& welcome = *host.welcome();
  int beyond = 0;
  int not_ready = 0;
  int not_zero = 0;
  for (const HeardFrame& heard : samples) {
    const phx_sample& sample = heard.message.as.sample;
    if (sample.state != PHX_STATE_READY || sample.fault != 0 || sample.acted_tick != 0) ++not_ready;
    for (std::size_t c = 0; c < PHX_CHANNELS; ++c) {
      const bool own = c < welcome.channel_count;
      if (own && (sample.raw[c] < welcome.channel[c].raw_min || sample.raw[c] > welcome.channel[c].raw_max))
        ++beyond;
      if (!own && sample.raw[c] != 0) ++not_zero;
    }
  }
  return conform_if(
      beyond == 0 && not_ready == 0 && not_zero == 0 && host.undecodable() == 0,
      "{} samples; {} counts beyond their range, {} counts of channels that it does not have, {} samples not "
      "READY at rest; {} frames that could not be decoded",
      samples.size(), beyond, not_zero, not_ready, host.undecodable());
}

}  // namespace phalanx

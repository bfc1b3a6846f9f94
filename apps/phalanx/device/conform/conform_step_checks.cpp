// SPDX-License-Identifier: Apache-2.0
// Steps that must not act, local walls, torques, and a line that is busy.
#include <algorithm>
#include <cmath>
#include <vector>

#include "device/conform/conform_checks.h"
#include "device/conform/conform_host.h"
#include "phalanx/core/random.h"

namespace phalanx {
namespace {

constexpr double kWholeRamp = 1e-6 * PHX_START_RAMP_US;  // [s], as all times here
constexpr double kTorqueOffWithin = 0.02;                // of a measured torque: motor and sensor lag, too
constexpr int kTries = 5;

/// Sends commands that must not act, beside those that do. @returns what the controller has counted
struct Refused {
  ConformCounts more;
  bool disturbed = false;
};
template <typename Make>
Refused send_refused(ConformHost& host, Make&& make) {
  host.open();
  host.enable();
  host.pass(0.1);
  host.settle();
  const ConformCounts before = host.counts();
  host.forget();
  for (int i = 0; i < kTries; ++i) {
    host.send(make());
    host.pass(host.command_period());
  }
  host.settle();
  Refused out{.more = host.counts() - before};
  out.disturbed = std::any_of(host.samples().begin(), host.samples().end(),
                              [](const HeardFrame& heard) { return !conform_acts(heard.message.as.sample); });
  return out;
}

std::vector<double> torques(const ConformHost& host, double since) {
  std::vector<double> out;
  for (const HeardFrame& heard : host.samples())
    if (heard.at >= since) out.push_back(host.measured_torque(heard.message.as.sample));
  return out;
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

ConformFinding no_torque_channel() {
  return not_applicable("the device has no TORQUE channel: measure the torque with an instrument");
}

}  // namespace

ConformFinding check_stale(ConformHost& host) {
  const Refused refused = send_refused(host, [&host] {
    phx_message command = host.command(PHX_COMMAND_ENABLE);
    command.as.command.sample_time_us -= PHX_LATCH_AGE_US + 2000U;
    return command;
  });
  return conform_if(refused.more.outdated == kTries && refused.more.corrupt == 0 && !refused.disturbed,
                    "{} new steps from samples 22 ms old, {} counted as outdated; the others {}", kTries,
                    refused.more.outdated, refused.disturbed ? "were disturbed" : "act on");
}

ConformFinding check_future(ConformHost& host) {
  const Refused refused = send_refused(host, [&host] {
    phx_message command = host.command(PHX_COMMAND_ENABLE);
    command.as.command.sample_time_us += 1'000'000U;
    return command;
  });
  return conform_if(refused.more.corrupt == kTries && !refused.disturbed,
                    "{} steps from samples of the next second, {} counted as corrupt; the others {}", kTries,
                    refused.more.corrupt, refused.disturbed ? "were disturbed" : "act on");
}

ConformFinding check_older_tick(ConformHost& host) {
  const Refused refused = send_refused(host, [&host] {
    phx_message command = host.command(PHX_COMMAND_ENABLE);
    command.as.command.tick -= 50U;
    return command;
  });
  return conform_if(refused.more.outdated == kTries && !refused.disturbed,
                    "{} steps with a tick 50 below the newest, {} counted as outdated; the others {}", kTries,
                    refused.more.outdated, refused.disturbed ? "were disturbed" : "act on");
}

ConformFinding check_replay(ConformHost& host) {
  host.open();
  host.enable();
  host.pass(0.05);
  host.stop_driving();
  std::vector<std::vector<std::uint8_t>> frames;
  for (int i = 0; i < 10; ++i) {
    frames.push_back(host.encode(host.command(PHX_COMMAND_ENABLE)));
    host.send(frames.back());
    host.pass(0.5 * host.command_period());
  }
  host.enable();
  host.pass(2.0 * host.command_period());
  const ConformCounts before = host.counts();
  host.forget();
  for (const auto& frame : frames) {  // their steps are still younger than 20 ms
    host.send(frame);
    host.pass(0.5 * host.command_period());
  }
  host.settle();
  std::uint64_t newest = 0;
  int back = 0;
  for (const HeardFrame& heard : host.samples()) {
    if (heard.message.as.sample.acted_tick < newest) ++back;
    newest = std::max(newest, heard.message.as.sample.acted_tick);
  }
  const ConformCounts more = host.counts() - before;
  return conform_if(
      more.outdated == frames.size() && more.corrupt == 0 && back == 0 && conform_acts(host.newest()),
      "{} recorded commands sent again, {} counted as outdated; {} times it went back to an older step",
      frames.size(), more.outdated, back);
}

ConformFinding check_walls(ConformHost& host) {
  host.open();
  const std::uint64_t first = host.last_tick() + 1U;
  for (int i = 0; i < 30; ++i) {
    phx_message walls = host.message(PHX_COMMAND_WALLS);
    walls.as.walls.command = host.command(PHX_COMMAND_ENABLE).as.command;
    host.send(walls);
    host.pass(std::max(5e-3, host.command_period()));
  }
  const phx_sample& now = host.newest();
  return conform_if(conform_acts(now) && now.acted_tick >= first,
                    "30 steps with walls of no stiffness: state {}, {}", now.state,
                    now.acted_tick >= first ? "the newest acts" : "none acts");
}

ConformFinding check_torque_limit(ConformHost& host) {
  if (host.torque_channel() < 0) return no_torque_channel();
  host.open();
  host.pass(0.2);
  const double rest = mean(torques(host, 0.0));
  const double limit = 0.5 * host.settings().torque;
  host.configure(limit);
  host.settle();
  host.enable(1.0);
  host.pass(kWholeRamp + 0.2);
  double largest = 0.0;
  for (const double torque : torques(host, host.now() - 0.2))
    largest = std::max(largest, std::abs(torque - rest));
  host.stop_driving();
  host.configure(host.settings().torque);
  return conform_if(largest <= 1.25 * limit + host.settings().tolerance,
                    "{:.0f} mNm commanded with a limit of {:.0f} mNm: measured {:.0f} mNm",
                    1e3 * host.settings().torque, 1e3 * limit, 1e3 * largest);
}

ConformFinding check_torque_off(ConformHost& host) {
  if (host.torque_channel() < 0) return no_torque_channel();
  host.open();
  host.pass(0.2);
  const double rest = mean(torques(host, 0.0));
  host.enable(1.0);
  host.pass(kWholeRamp + 0.2);
  const double before = std::abs(mean(torques(host, host.now() - 0.1)) - rest);
  if (before < 0.5 * host.settings().torque)
    return conform_if(false, "{:.0f} mNm commanded, {:.0f} mNm measured: it gives no torque",
                      1e3 * host.settings().torque, 1e3 * before);
  host.be_quiet();
  const double stop = host.now();
  for (int i = 0; i < 60; ++i) {
    host.send(host.command(PHX_COMMAND_FAULT));
    host.pass(host.command_period());
  }
  double largest = 0.0;
  for (const double torque : torques(host, stop + kTorqueOffWithin + host.round_trip + 2.0 * host.period()))
    largest = std::max(largest, std::abs(torque - rest));
  return conform_if(largest <= host.settings().tolerance,
                    "from {:.0f} mNm; {:.0f} ms after the message at most {:.1f} mNm", 1e3 * before,
                    1e3 * kTorqueOffWithin, 1e3 * largest);
}

ConformFinding check_flood(ConformHost& host) {
  host.open();
  host.enable();
  host.pass(0.1);
  host.forget();
  Random random(host.settings().seed + 2U);
  const double carried = 0.5 * host.port().bytes_per_second() * host.command_period() - 119.0;
  const int others =
      host.port().bytes_per_second() > 0.0 ? std::clamp(static_cast<int>(carried / 40.0), 1, 5) : 5;
  int sent = 0;
  const double begin = host.now();
  while (host.now() < begin + 0.3) {
    for (int i = 0; i < others; ++i, ++sent) {
      std::vector<std::uint8_t> frame(38);
      for (std::uint8_t& byte : frame) byte = static_cast<std::uint8_t>(random.uniform() * 256.0);
      const bool ping = i % 2 == 0;
      if (ping) frame = host.encode(host.message(PHX_PING));
      host.send(frame, ConformSender::kOtherHost);
    }
    host.pass(host.command_period());
  }
  double longest = 0.0;
  std::uint32_t oldest = 0;
  std::size_t disturbed = 0;
  for (std::size_t i = 0; i < host.samples().size(); ++i) {
    const phx_sample& sample = host.samples()[i].message.as.sample;
    if (!conform_acts(sample)) ++disturbed;
    oldest = std::max(oldest, sample.acted_age_us);
    if (i > 0) {
      const auto before = host.samples()[i - 1].message.as.sample.time_us;
      longest = std::max(longest, 1e-6 * static_cast<double>(conform_age(sample, before)));
    }
  }
  return conform_if(
      disturbed == 0 && longest <= 5.0 * host.period() && !host.samples().empty(),
      "{} frames more in 0.3 s: longest interval of samples {:.1f} ms, oldest step {:.1f} ms, {} samples in "
      "which no command acts",
      sent, 1e3 * longest, in_ms(oldest), disturbed);
}

}  // namespace phalanx

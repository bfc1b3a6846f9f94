// SPDX-License-Identifier: Apache-2.0
// Frames that must be dropped, and the bytes of a serial line.
#include <array>
#include <limits>
#include <vector>

#include "device/conform/conform_checks.h"
#include "device/conform/conform_host.h"
#include "phalanx/core/random.h"

namespace phalanx {
namespace {

using Frames = std::vector<std::vector<std::uint8_t>>;

constexpr std::size_t kVersionAt = 2;
constexpr std::size_t kTypeAt = 3;
constexpr std::size_t kFlagsAt = 6;
constexpr std::uint8_t kOtherVersion = 2;

/// Sends frames beside enabled commands, one a period. All must be dropped, and `counted` of them counted as
/// corrupt.
ConformFinding expect_dropped(ConformHost& host, const Frames& frames, std::size_t counted) {
  host.settle();
  const ConformCounts before = host.counts();
  const std::uint32_t epoch = host.epoch();
  for (const auto& frame : frames) {
    host.send(frame);
    host.pass(host.command_period());
  }
  host.settle();
  const ConformCounts more = host.counts() - before;
  const phx_sample& now = host.newest();
  const bool goes_on = now.state == PHX_STATE_STARTING || now.state == PHX_STATE_ACTIVE;
  const bool newest_acts = now.acted_tick <= host.last_tick() && now.acted_tick + 1000 > host.last_tick();
  return conform_if(
      more.corrupt == counted && more.refused == 0 && goes_on && newest_acts && host.epoch() == epoch,
      "{} frames sent, {} counted as corrupt, {} as refused; {}", frames.size(), more.corrupt, more.refused,
      !goes_on       ? fmt::format("the session was disturbed: state {}, fault {}", now.state, now.fault)
      : !newest_acts ? fmt::format("it acts on step {}, which was in a bad frame", now.acted_tick)
                     : std::string("the commands act on"));
}

/// A command that would act if it were accepted: its tick is far beyond all others'.
phx_message command_that_must_not_act(ConformHost& host) {
  phx_message command = host.command(PHX_COMMAND_ENABLE);
  command.as.command.tick = host.last_tick() + 1'000'000'000U;
  return command;
}

/// Such a command as a frame with a valid CRC, one of whose bytes has the value.
std::vector<std::uint8_t> sealed_with(ConformHost& host, std::size_t at, unsigned value) {
  auto frame = host.encode(command_that_must_not_act(host));
  frame[at] = static_cast<std::uint8_t>(value);
  ConformHost::seal(frame);
  return frame;
}

void begin(ConformHost& host) {
  host.open();
  host.enable();
}

}  // namespace

// The flipped bits are in the sequence, the tick and the CRC: harmless in firmware that accepts them.
ConformFinding check_crc(ConformHost& host) {
  begin(host);
  Random random(host.settings().seed);
  Frames frames;
  for (int i = 0; i < 50; ++i) {
    auto frame = host.encode(command_that_must_not_act(host));
    static constexpr std::array<std::size_t, 3> kPlaces = {12, 16, PHX_HEADER_SIZE + 97U};
    const std::size_t place = kPlaces[static_cast<std::size_t>(i) % 3];
    frame[place + static_cast<std::size_t>(random.uniform() * 3.0)] ^=
        static_cast<std::uint8_t>(1U << static_cast<unsigned>(random.uniform() * 8.0));
    frames.push_back(std::move(frame));
  }
  return expect_dropped(host, frames, frames.size());
}

ConformFinding check_truncated(ConformHost& host) {
  begin(host);
  Frames frames;
  for (const std::size_t size : {1U, 2U, 3U, 8U, 15U, 16U, 20U, 28U, 60U, 100U, 112U, 116U}) {
    auto frame = host.encode(command_that_must_not_act(host));
    frame.resize(size);
    frames.push_back(frame);
    if (size < PHX_HEADER_SIZE + PHX_CRC_SIZE) continue;
    frame[4] = static_cast<std::uint8_t>(size);  // with the CRC of a short frame
    ConformHost::seal(frame);
    frames.push_back(std::move(frame));
  }
  return expect_dropped(host, frames, frames.size());
}

ConformFinding check_oversize(ConformHost& host) {
  begin(host);
  Frames frames;
  for (const std::size_t size : {118U, 200U, 681U, 1000U, 1024U}) {
    auto frame = host.encode(command_that_must_not_act(host));
    frame.resize(size, 0x55);
    ConformHost::seal(frame);
    frames.push_back(std::move(frame));
  }
  const ConformFinding counted = expect_dropped(host, frames, frames.size());
  if (counted.outcome != ConformOutcome::kPass) return counted;
  Frames larger;
  for (const std::size_t size : {1025U, 1400U}) larger.emplace_back(size, std::uint8_t{0x55});
  host.settle();
  const ConformCounts before = host.counts();
  for (const auto& frame : larger) host.send(frame), host.pass(host.command_period());
  host.settle();
  const bool goes_on = host.newest().state == PHX_STATE_STARTING || host.newest().state == PHX_STATE_ACTIVE;
  return conform_if(goes_on, "{}; 2 frames above 1024 bytes: {} counted, {}", counted.observed,
                    (host.counts() - before).corrupt,
                    goes_on ? "the commands act on" : "the session was disturbed");
}

ConformFinding check_unknown_type(ConformHost& host) {
  begin(host);
  Frames frames;
  for (const unsigned type : {0U, 12U, 13U, 99U, 255U}) {
    frames.push_back(sealed_with(host, kTypeAt, type));
  }
  return expect_dropped(host, frames, frames.size());
}

ConformFinding check_reserved_bits(ConformHost& host) {
  begin(host);
  Frames frames;
  for (unsigned bit = 0; bit < 16; ++bit) {
    frames.push_back(sealed_with(host, kFlagsAt + bit / 8U, 1U << (bit % 8U)));
  }
  return expect_dropped(host, frames, frames.size());
}

ConformFinding check_own_frames(ConformHost& host) {
  begin(host);
  Frames frames;
  phx_message welcome = host.message(PHX_WELCOME);
  welcome.as.welcome = *host.welcome();
  phx_message sample = host.message(PHX_SAMPLE);
  sample.as.sample = host.newest();
  phx_message refused = host.message(PHX_REFUSED);
  refused.as.refused.reason = PHX_REFUSED_BUSY;
  phx_message pong = host.message(PHX_PONG);
  for (phx_message* own : {&welcome, &sample, &refused, &pong}) frames.push_back(host.encode(*own));
  return expect_dropped(host, frames, frames.size());
}

ConformFinding check_not_finite(ConformHost& host) {
  begin(host);
  Frames frames;
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                          -std::numeric_limits<float>::infinity()}) {
    for (const std::size_t joint : {0U, 4U, 10U, 19U}) {
      phx_message command = command_that_must_not_act(host);
      command.as.command.torque[joint] = bad;
      frames.push_back(host.encode(command));
    }
    phx_message configure = host.message(PHX_CONFIGURE);
    configure.as.configure.torque_limit = bad;
    frames.push_back(host.encode(configure));
  }
  return expect_dropped(host, frames, frames.size());
}

ConformFinding check_invalid_values(ConformHost& host) {
  begin(host);
  Frames frames;
  phx_message configure = host.message(PHX_CONFIGURE);
  configure.as.configure.torque_limit = -0.01F;
  frames.push_back(host.encode(configure));
  configure.as.configure.torque_limit = 0.0F;
  configure.as.configure.torque_rate = -1.0F;
  frames.push_back(host.encode(configure));
  phx_message walls = host.message(PHX_COMMAND_WALLS);
  walls.as.walls.command = command_that_must_not_act(host).as.command;
  walls.as.walls.wall[0].stiffness = -1.0F;
  frames.push_back(host.encode(walls));
  walls.as.walls.wall[0] = {
      .g = {}, .d_ref = 0.0F, .stiffness = 0.0F, .force_max = -1.0F, .host_force = 0.0F};
  frames.push_back(host.encode(walls));
  return expect_dropped(host, frames, frames.size());
}

ConformFinding check_version_hello(ConformHost& host) {
  begin(host);
  const std::uint32_t epoch = host.newest().state == PHX_STATE_NO_SESSION ? 0 : host.epoch();
  phx_message hello = host.hello(host.settings().host_id + 1U, 4242);
  auto frame = host.encode(hello);
  frame[kVersionAt] = kOtherVersion;
  ConformHost::seal(frame);
  host.forget();
  host.send(frame, ConformSender::kOtherHost);
  host.settle();
  const auto refused = host.answer(PHX_REFUSED);
  const bool welcomed = host.answer(PHX_WELCOME).has_value();
  if (!refused || welcomed)
    return conform_if(false, "{}",
                      welcomed ? "WELCOME to a HELLO of version 2" : "no REFUSED to a HELLO of version 2");
  const phx_refused& r = refused->message.as.refused;
  const bool goes_on = host.epoch() == epoch &&
                       (host.newest().state == PHX_STATE_STARTING || host.newest().state == PHX_STATE_ACTIVE);
  return conform_if(r.reason == PHX_REFUSED_VERSION && r.version == PHX_VERSION && goes_on &&
                        r.host_id == host.settings().host_id + 1U,
                    "REFUSED with reason {}, version {}; the session {}", r.reason, r.version,
                    goes_on ? "goes on" : "was disturbed");
}

ConformFinding check_version_frames(ConformHost& host) {
  begin(host);
  Frames frames;
  for (const unsigned version : {0U, 2U, 255U}) {
    frames.push_back(sealed_with(host, kVersionAt, version));
  }
  return expect_dropped(host, frames, frames.size());
}

ConformFinding check_random(ConformHost& host) {
  begin(host);
  Random random(host.settings().seed + 1U);
  Frames frames;
  for (int i = 0; i < 100; ++i) {
    std::vector<std::uint8_t> frame(1U + static_cast<std::size_t>(random.uniform() * 300.0));
    for (std::uint8_t& byte : frame) byte = static_cast<std::uint8_t>(random.uniform() * 256.0);
    frames.push_back(std::move(frame));
  }
  return expect_dropped(host, frames, frames.size());
}

// ---- serial lines ----

namespace {

std::vector<std::uint8_t> stuffed(const std::vector<std::uint8_t>& frame) {
  std::vector<std::uint8_t> out(PHX_COBS_MAX);
  out.resize(phx_cobs_encode(frame.data(), frame.size(), out.data(), out.size()));
  return out;
}

std::vector<std::uint8_t> ping_frame(ConformHost& host, std::uint64_t stamp) {
  phx_message ping = host.message(PHX_PING);
  ping.as.ping.stamp = stamp;
  return host.encode(ping);
}

bool answered(const ConformHost& host, std::uint64_t stamp) {
  for (const HeardFrame& heard : host.answers())
    if (heard.message.header.type == PHX_PONG && heard.message.as.ping.stamp == stamp) return true;
  return false;
}

}  // namespace

ConformFinding check_bytewise(ConformHost& host) {
  if (!host.port().serial()) return not_applicable("a datagram is whole or not there");
  host.open();
  host.forget();
  for (const std::uint8_t byte : stuffed(ping_frame(host, 11))) {
    host.port().send_bytes(std::span(&byte, 1));
    host.pass(1e-3);
  }
  auto two = stuffed(ping_frame(host, 12));
  const auto second = stuffed(ping_frame(host, 13));
  two.insert(two.end(), second.begin(), second.end());
  host.port().send_bytes(two);
  host.settle();
  const int right =
      (answered(host, 11) ? 1 : 0) + (answered(host, 12) ? 1 : 0) + (answered(host, 13) ? 1 : 0);
  return conform_if(right == 3, "{} of 3 PINGs answered: one byte by byte, two in one piece", right);
}

ConformFinding check_resync(ConformHost& host) {
  if (!host.port().serial()) return not_applicable("a datagram is whole or not there");
  host.open();
  host.forget();
  const auto whole = stuffed(ping_frame(host, 21));
  const std::vector<std::uint8_t> zeros(5, 0);
  host.port().send_bytes(zeros);
  host.port().send_bytes(whole);
  host.settle();
  host.port().send_bytes(std::span(whole).first(whole.size() / 2));  // a program that was killed in mid-frame
  host.port().send_bytes(std::span(zeros).first(1));
  host.port().send_bytes(stuffed(ping_frame(host, 22)));
  host.settle();
  const std::vector<std::uint8_t> flood(1500, 0x55);  // longer than any frame
  host.port().send_bytes(flood);
  host.pass(0.01);
  host.port().send_bytes(std::span(zeros).first(1));
  host.port().send_bytes(stuffed(ping_frame(host, 23)));
  host.settle();
  const int right =
      (answered(host, 21) ? 1 : 0) + (answered(host, 22) ? 1 : 0) + (answered(host, 23) ? 1 : 0);
  return conform_if(
      right == 3, "{} of 3 PINGs answered: after zeros, after half a frame, after 1500 bytes without a zero",
      right);
}

}  // namespace phalanx

// SPDX-License-Identifier: Apache-2.0
#include "device/conform/conform_host.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace phalanx {
namespace {

constexpr double kHelloPeriod = 0.1;      // [s], as all times here
constexpr double kConfigurePeriod = 0.2;  // keeps a session open
constexpr double kAskFor = 2.5;           // another host that has left holds the session for 1 s
constexpr double kConfigureFor = 0.5;
constexpr double kResetFor = 0.2;
constexpr double kEnableFor = 0.3;
constexpr double kLeastSettling = 0.02;

/// CRC-32 of IEEE 802.3, bit by bit: written from docs/link.md, not from the reference.
std::uint32_t link_crc(std::span<const std::uint8_t> bytes) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) != 0 ? (crc >> 1U) ^ 0xEDB88320U : crc >> 1U;
  }
  return ~crc;
}

}  // namespace

double conform_command_period(double bytes_per_second) {
  if (bytes_per_second <= 0.0) return 0.0;
  return 3.0 * static_cast<double>(phx_frame_size(PHX_COMMAND)) / bytes_per_second;
}

ConformHost::ConformHost(ConformPort& port, const ConformSettings& settings)
    : port_(port), settings_(settings), sequence_(PHX_PONG + 1U, 0U), limit_(settings.torque) {}

// ---- time ----

double ConformHost::period() const {
  return welcome_ && welcome_->rate_hz > 0 ? 1.0 / welcome_->rate_hz : 1e-3;
}

double ConformHost::command_period() const {
  return std::max({1e-3, period(), conform_command_period(port_.bytes_per_second())});
}

double ConformHost::settling() const { return std::max(kLeastSettling, 5.0 * period()) + 2.0 * round_trip; }

void ConformHost::pass(double seconds) {
  const double end = now() + seconds;
  while (now() < end) {
    double due = end;
    if (driving_) {
      if (now() >= next_command_) {
        send(command(PHX_COMMAND_ENABLE, driven_torque_));
        next_command_ = std::max(next_command_ + command_period(), now());
      }
      due = std::min(due, next_command_);
    } else if (keeps_alive_) {
      if (now() >= next_configure_) configure(limit_);
      due = std::min(due, next_configure_);
    }
    take_until(due);
    longest_delay_ = std::max(longest_delay_, now() - due);
  }
}

bool ConformHost::take_until(double until) {
  std::array<std::uint8_t, PHX_FRAME_MAX> frame{};
  ConformSender to = ConformSender::kHost;
  const std::size_t size = port_.receive(until, frame, to);
  if (size == 0) return false;
  phx_message message{};
  if (phx_decode(frame.data(), size, &message) == PHX_OK) {
    take(message, to);
  } else {
    ++undecodable_;
  }
  return true;
}

void ConformHost::take(const phx_message& message, ConformSender to) {
  const HeardFrame heard{.message = message, .at = now(), .to = to};
  if (message.header.type != PHX_SAMPLE) return answers_.push_back(heard);
  if (message.header.epoch != epoch_ || to != ConformSender::kHost) return;
  newest_ = message.as.sample;
  samples_.push_back(heard);
}

std::optional<HeardFrame> ConformHost::answer(std::uint8_t type) const {
  const auto found = std::find_if(answers_.rbegin(), answers_.rend(), [type](const HeardFrame& heard) {
    return heard.message.header.type == type;
  });
  return found == answers_.rend() ? std::nullopt : std::optional(*found);
}

// ---- sessions ----

bool ConformHost::say_hello(double seconds) {
  be_quiet();
  const double end = now() + seconds;
  while (now() < end) {
    forget();
    const std::uint32_t sequence = ++sequence_[PHX_HELLO];
    send(hello(settings_.host_id, sequence));
    const double next = std::min(end, now() + kHelloPeriod);
    while (now() < next) {
      take_until(next);
      const std::optional<HeardFrame> heard = answer(PHX_WELCOME);
      if (!heard || heard->message.as.welcome.host_id != settings_.host_id ||
          heard->message.header.sequence != sequence)
        continue;
      welcome_ = heard->message.as.welcome;
      epoch_ = heard->message.header.epoch;
      hello_sequence_ = sequence;
      newest_ = {};
      samples_.clear();
      return true;
    }
  }
  return false;
}

void ConformHost::open_unconfigured() {
  if (!say_hello(kAskFor)) {
    const std::optional<HeardFrame> refused = answer(PHX_REFUSED);
    throw ConformTrouble(refused ? fmt::format("HELLO was refused for {} s, reason {}", kAskFor,
                                               refused->message.as.refused.reason)
                                 : fmt::format("HELLO was not answered for {} s", kAskFor));
  }
  pass(settling());
  if (samples_.empty()) throw ConformTrouble("no sample came after WELCOME");
}

void ConformHost::open() {
  open_unconfigured();
  const double end = now() + kConfigureFor;
  while (now() < end && (newest_.flags & PHX_SAMPLE_CONFIGURED) == 0) {
    configure(settings_.torque);
    pass(std::max(0.01, 2.0 * period()));
  }
  if ((newest_.flags & PHX_SAMPLE_CONFIGURED) == 0)
    throw ConformTrouble(
        fmt::format("no sample had the flag CONFIGURED in {} s of CONFIGURE", kConfigureFor));
  const double until = now() + kResetFor;
  while (now() < until && newest_.state == PHX_STATE_LATCHED) {
    send(message(PHX_RESET));
    pass(std::max(0.005, 2.0 * period()));
  }
  if (newest_.state == PHX_STATE_LATCHED)
    throw ConformTrouble(fmt::format(
        "it is latched for fault {}, and RESET does not clear it: remove the cause", newest_.fault));
  keeps_alive_ = true;
  next_configure_ = now() + kConfigurePeriod;
  forget();
}

void ConformHost::configure(double torque_limit) {
  limit_ = torque_limit;
  next_configure_ = now() + kConfigurePeriod;
  phx_message out = message(PHX_CONFIGURE);
  for (std::size_t i = 0; welcome_ && i < welcome_->channel_count; ++i) {
    out.as.configure.gain[i] = welcome_->channel[i].gain;
    out.as.configure.offset[i] = welcome_->channel[i].offset;
  }
  out.as.configure.torque_limit = static_cast<float>(torque_limit);
  out.as.configure.torque_rate = static_cast<float>(settings_.torque_rate);
  send(out);
}

void ConformHost::enable(double torque_share) {
  driven_torque_ = torque_share * settings_.torque;
  driving_ = true;
  next_command_ = now();
  const double end = now() + kEnableFor;
  const auto acts = [this] {
    return newest_.state == PHX_STATE_STARTING || newest_.state == PHX_STATE_ACTIVE;
  };
  while (now() < end && !acts()) pass(command_period());
  if (acts()) return;
  driving_ = false;
  throw ConformTrouble(fmt::format("it did not act on enabled commands in {} s: state {}, fault {}",
                                   kEnableFor, newest_.state, newest_.fault));
}

void ConformHost::leave() {
  if (epoch_ == 0) return;
  be_quiet();
  for (int i = 0; i < 10; ++i) {
    send(command(PHX_COMMAND_FAULT));
    pass(command_period());
  }
  for (int i = 0; i < 3; ++i) {
    send(message(PHX_GOODBYE));
    pass(command_period());
  }
  epoch_ = 0;
}

// ---- frames ----

phx_message ConformHost::message(std::uint8_t type) const {
  phx_message out{};
  out.header.type = type;
  const bool of_session = type != PHX_HELLO && type != PHX_PING;
  out.header.epoch = of_session ? epoch_ : 0;
  return out;
}

phx_message ConformHost::hello(std::uint64_t host_id, std::uint32_t sequence) const {
  phx_message out = message(PHX_HELLO);
  out.header.sequence = sequence;
  out.as.hello.host_id = host_id;
  return out;
}

phx_message ConformHost::command(std::uint8_t flags, double torque) {
  phx_message out = message(PHX_COMMAND);
  out.as.command.tick = ++tick_;
  out.as.command.sample_time_us = newest_.time_us;
  out.as.command.flags = flags;
  if (joint() >= 0) out.as.command.torque[joint()] = static_cast<float>(torque);
  return out;
}

std::vector<std::uint8_t> ConformHost::encode(phx_message message) {
  if (message.header.sequence == 0) message.header.sequence = ++sequence_[message.header.type];
  std::vector<std::uint8_t> frame(PHX_FRAME_MAX);
  frame.resize(phx_encode(&message, frame.data(), frame.size()));
  return frame;
}

void ConformHost::send(const phx_message& message, ConformSender sender) { send(encode(message), sender); }

void ConformHost::send(std::span<const std::uint8_t> frame, ConformSender sender) {
  port_.send(frame, sender);
}

void ConformHost::seal(std::vector<std::uint8_t>& frame) {
  const std::size_t body = frame.size() - PHX_CRC_SIZE;
  const std::uint32_t crc = link_crc(std::span(frame).first(body));
  for (std::size_t i = 0; i < PHX_CRC_SIZE; ++i) frame[body + i] = static_cast<std::uint8_t>(crc >> (8 * i));
}

// ---- the device ----

int ConformHost::torque_channel() const {
  for (int c = 0; welcome_ && c < welcome_->channel_count; ++c)
    if (welcome_->channel[c].kind == PHX_CHANNEL_TORQUE) return c;
  return -1;
}

int ConformHost::joint() const {
  if (!welcome_) return -1;
  if (const int c = torque_channel(); c >= 0) return welcome_->channel[c].index;
  for (int c = 0; c < welcome_->channel_count; ++c)
    if (welcome_->channel[c].kind == PHX_CHANNEL_ANGLE) return welcome_->channel[c].index;
  return -1;
}

double ConformHost::measured_torque(const phx_sample& sample) const {
  const phx_channel& channel = welcome_->channel[torque_channel()];
  return static_cast<double>(channel.gain) * sample.raw[torque_channel()] +
         static_cast<double>(channel.offset);
}

}  // namespace phalanx
